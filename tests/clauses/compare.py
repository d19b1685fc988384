"""A specification with clauses and the same written out: the same decisions, and the same verdicts of every judge."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import TypeAlias

from msgspec import Struct, field
from msgspec.structs import replace

from tests.checker.agreement import failing
from tests.checker.standalone import ask, checker
from tests.clauses.generate import Pair, random_pair
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import (
    Policy,
    Table,
    UndecidedState,
    Vocabulary,
    as_diagram,
    dumps,
    loads,
    unrealizability,
)
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    actions_of,
    all_states,
    allowed_sets,
    cases_in,
    is_valid,
    judge,
    named,
)
from tumato_symbolic.spec import Ordering, Spec, digest, load
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Unrealizable, synthesize
from tumato_symbolic.verify import PROPERTIES, ProverName, verify, verify_unrealizable

Names: TypeAlias = frozenset[str]
ORDERINGS: tuple[Ordering, ...] = ("any", "first")
PROVERS: tuple[ProverName, ...] = ("explicit", "walk", "z3")
REFUSALS = ("TUM305", "TUM306")


class Report(Struct):
    """What was found: `kind` of outcome, how many policies were judged, and every difference."""

    kind: str = ""
    judged: int = 0
    differences: list[str] = field(default_factory=list)


def examine(seed: int, folder: Path, mutants: int = 2) -> Report:
    """Everything about the pair of a seed, under one ordering."""
    pair, report, random = random_pair(seed), Report(), Random(seed)
    loaded = load(Source("clauses", pair.text))
    with_clauses = loaded.spec
    refused = _refused_by_checker(pair.text)
    if pair.written_out is None:
        codes = {each.code.name for each in loaded.diagnostics if each.code.severity == "error"}
        right = with_clauses is None and codes <= set(REFUSALS) and refused
        return Report("refused", 0, [] if right else [f"{seed}: not refused by both: {codes}"])
    written_out = load(Source("written out", pair.written_out)).spec
    if with_clauses is None or written_out is None or refused:
        return Report("", 0, [f"{seed}: refused: {[each.message for each in loaded.diagnostics]}, {refused}"])
    own = checker.digest(checker.read_specification(pair.text.encode()))
    if own != digest(with_clauses):
        report.differences.append(f"{seed}: the digests differ")
    ordering = random.choice(ORDERINGS)
    both = _Both(pair, with_clauses, written_out, ordering)
    report.differences += [f"{seed}: {each}" for each in both.sets_differ(random)]
    outcomes = synthesize(with_clauses, ordering), synthesize(written_out, ordering)
    report.kind = type(outcomes[0]).__name__
    report.differences += [f"{seed}: {each}" for each in both.outcomes_differ(*outcomes, folder)]
    if isinstance(outcomes[0], Realizable):
        decisions = both.decisions(outcomes[0].policy)
    else:
        decisions = {state: both.any_allowed(random, state) for state in both.valid}
    for number in range(1 + mutants):
        changed = both.changed(decisions, random) if number else decisions
        report.judged += 1
        diagram = random.random() < 0.5
        report.differences += [f"{seed}: {each}" for each in both.verdicts_differ(changed, folder, diagram=diagram)]
    return report


def _refused_by_checker(text: str) -> bool:
    try:
        checker.read_specification(text.encode())
    except checker.Unreadable:
        return True
    return False


class _Both:
    """Two specifications that mean the same; decisions are sets of names of the first."""

    def __init__(self, pair: Pair, with_clauses: Spec, written_out: Spec, ordering: Ordering) -> None:
        self.pair, self.spec, self.plain, self.ordering = pair, with_clauses, written_out, ordering
        self.valid = [state for state in all_states(written_out) if is_valid(written_out, state)]

        self._places = {
            name: action.places for name, action in checker.read_specification(pair.text.encode()).actions.items()
        }

    def names(self, state: State, chosen: Names) -> ActionSet:
        """The actions of the text that is written out that stand for a set in a state."""
        return frozenset((self._meant(state, name) or self._written_out(name))[0] for name in chosen)

    def _written_out(self, name: str) -> list[int]:
        return [n for n, each in enumerate(self.plain.actions) if self.pair.action_of[each.name] == name]

    def _meant(self, state: State, name: str) -> list[int]:
        """Empty where the effects disagree, outside the preconditions."""
        return [n for n in self._written_out(name) if self._is_meant(self.plain.actions[n].name, name, state)]

    def is_defined(self, state: State, chosen: Names) -> bool:
        """Whether it is known what happens: a set with an effect that disagrees is not allowed, and no more is said."""
        return all(self._meant(state, name) for name in chosen)

    def _is_meant(self, written_out: str, name: str, state: State) -> bool:
        if written_out == name:
            return True
        values = written_out.split("__")[1].split("_")
        return [str(state[place]) for place in self._places[name]] == [value for value in values if value]

    def of_plain(self, chosen: ActionSet) -> Names:
        """The names that a set of the text that is written out stands for."""
        return frozenset(self.pair.action_of[self.plain.actions[number].name] for number in chosen)

    def of_cases(self, chosen: ActionSet) -> Names:
        """The names of the actions of which a set has cases."""
        return frozenset(self.spec.action_names[number] for number in actions_of(self.spec, chosen))

    def any_allowed(self, random: Random, state: State) -> Names:
        """Some allowed set, nothing where there is none."""
        sets = list(allowed_sets(self.plain, state, self.ordering))
        return self.of_plain(random.choice(sets)) if sets else frozenset()

    def sets_differ(self, random: Random) -> Iterator[str]:
        """The allowed sets of some states."""
        for state in random.sample(self.valid, min(3, len(self.valid))):
            mine = [self.of_cases(each) for each in allowed_sets(self.spec, state, self.ordering)]
            plain = [self.of_plain(each) for each in allowed_sets(self.plain, state, self.ordering)]
            if mine != plain:
                yield f"other sets are allowed in {state}: {mine}, not {plain}"

    def outcomes_differ(self, one: SynthesisResult, other: SynthesisResult, folder: Path) -> Iterator[str]:
        """What synthesis comes to, and its certificate where there is no policy."""
        if type(one) is not type(other):
            yield f"{type(one).__name__}, not {type(other).__name__}"
        elif isinstance(one, Realizable) and isinstance(other, Realizable):
            mine, plain = self.decisions(one.policy), self.decisions(other.policy)
            plain = {state: frozenset(self.pair.action_of[name] for name in chosen) for state, chosen in plain.items()}
            different = next((state for state in mine if mine[state] != plain[state]), None)
            if different is not None:
                yield f"in {different} {sorted(mine[different])}, not {sorted(plain[different])}"
            if one.statistics.longest_run != other.statistics.longest_run:
                yield "other runs"
            for prover in PROVERS:
                found = verify(loads(dumps(one.policy)), self.spec, ordering=self.ordering, prover=prover)
                if found.verdict != "proved" or found.certificate.status not in ("used", "unneeded"):
                    yield f"{prover}: {found.verdict}, certificate {found.certificate}"
            answer = ask(folder, dumps(one.policy), self.pair.text, "--strict", "--effect-ordering", self.ordering)
            if answer.code != 0:
                yield f"the checker: {answer.code} {answer.out} {answer.err}"
        elif isinstance(one, Unrealizable) and isinstance(other, Unrealizable):
            yield from self._failures_differ(one, other, folder)

    def _failures_differ(self, one: Unrealizable, other: Unrealizable, folder: Path) -> Iterator[str]:
        mine, plain = ([(each.kind, each.count, each.example) for each in found.failures] for found in (one, other))
        if mine != plain:
            yield f"{mine}, not {plain}"
        if (one.certificate is None) != (other.certificate is None):
            yield "only one has a certificate"
        elif one.certificate is not None:
            text = unrealizability.dumps(one.certificate)
            found = verify_unrealizable(unrealizability.loads(text), self.spec, ordering=self.ordering)
            if found.verdict != "proved":
                yield f"the certificate: {found}"
            answer = ask(folder, text, self.pair.text, "--effect-ordering", self.ordering)
            if answer.code != 0:
                yield f"the checker, of the certificate: {answer.code} {answer.out} {answer.err}"

    def decisions(self, policy: Policy) -> dict[State, Names]:
        """What a policy decides in the valid states; with starts, not in all of them."""
        found = {}
        for state in self.valid:
            with suppress(UndecidedState):
                found[state] = frozenset(policy.decide(named(self.plain, state)))
        return found

    def changed(self, decisions: Mapping[State, Names], random: Random) -> dict[State, Names]:
        """Some decisions changed."""
        found = dict(decisions)
        for state in random.sample(sorted(found), min(len(found), random.choice((1, 1, 2)))):
            others = random.sample(self.spec.action_names, random.randint(0, min(2, len(self.spec.cases))))
            found[state] = self.any_allowed(random, state) if random.random() < 0.5 else frozenset(others)
        if random.random() < 0.1:
            del found[random.choice(sorted(found))]
        return found

    def verdicts_differ(self, decisions: Mapping[State, Names], folder: Path, *, diagram: bool) -> Iterator[str]:
        """What the judges say of a policy, in either form, against the explicit judgement of the other text."""
        rows = {state: self.names(state, chosen) for state, chosen in decisions.items()}
        known = PROPERTIES if all(self.is_defined(*row) for row in decisions.items()) else ("total", "safe")

        def told(failed: Mapping[str, int]) -> dict[str, int]:
            return {name: failed[name] for name in known if name in failed}

        truth = told(failing(judge(self.plain, rows, self.ordering)))
        numbers = {name: number for number, name in enumerate(self.spec.action_names)}
        by_action = {state: frozenset(numbers[name] for name in chosen) for state, chosen in decisions.items()}
        by_case = {state: cases_in(self.spec, chosen, state) for state, chosen in by_action.items()}
        if (mine := told(failing(judge(self.spec, by_case, self.ordering)))) != truth:
            yield f"the explicit meaning: {mine}, not {truth}"
        policy = Policy(Vocabulary.of(self.spec), Table(by_action), self.ordering)
        policy = replace(policy, decisions=as_diagram(policy)) if diagram else policy
        for prover in PROVERS:
            found = verify(policy, self.spec, ordering=self.ordering, prover=prover)
            refuted = {each.name for each in found.properties if each.name in known and each.verdict == "refuted"}
            undecided = {each.name for each in found.properties if each.verdict == "undecided"}
            if refuted != set(truth) - undecided or (undecided and prover != "walk"):
                yield f"{prover}: {refuted}, not {truth}; undecided {undecided}"
        answer = ask(folder, dumps(policy), self.pair.text, "--effect-ordering", self.ordering)
        if told(answer.failing or {}) != truth or answer.code != (1 if truth else 0):
            yield f"the checker: {answer.code} {answer.failing}, not {truth} {answer.err}"
