"""One generated specification through the whole tool, held against the oracle and the judge."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from random import Random

from msgspec import Struct, field

from tests.generate import random_spec
from tests.oracle import OracleVerdict, Together, World, decide_world
from tests.profiles import ALL_PROFILES
from tests.reference_policy import reference_policy
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, Table, as_table, dumps, loads, policy_from_rows, unrealizability
from tumato_symbolic.semantics import ActionSet, Judgement, State, better_sets, count_states, duration, judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Undecided, Unrealizable, synthesize
from tumato_symbolic.verify import Refutation, Verification, verify, verify_unrealizable

Decisions = Mapping[State, ActionSet]

FORMS_EVERY = 5
"""Every so many seeds the other backend and the other policy format are tried as well."""


class Case(Struct, frozen=True):
    """A specification under one ordering."""

    profile: str
    seed: int
    ordering: Ordering

    @property
    def spec(self) -> Spec:
        """The specification itself."""
        return random_spec(self.seed, ALL_PROFILES[self.profile])


class Report(Struct):
    """What was found: `complaints` is empty when everything agrees."""

    case: Case
    kind: str = ""
    interacting: bool = False
    referenced: bool = False
    right_policies: int = 0
    wrong_policies: int = 0
    complaints: list[str] = field(default_factory=list)


def examine(case: Case, mutants: int = 3) -> Report:
    """Synthesize, compare with the oracle, then verify the policy and `mutants` changed ones."""
    spec, report = case.spec, Report(case)
    world = World(spec, case.ordering)
    verdict = decide_world(world)
    report.kind = verdict.kind
    report.interacting = verdict.kind == "realizable" and not verdict.own_region
    outcome = synthesize(spec, case.ordering)
    report.complaints += _compare(world, verdict, outcome, report)
    if case.seed % FORMS_EVERY == 0:
        report.complaints += _compare_forms(world, outcome)
    decisions = _decisions(outcome) or verdict.policy
    if decisions is not None:
        if isinstance(outcome, Realizable):
            report.complaints += _verify_own(world, outcome.policy)
        report.complaints += _verify_all(world, decisions, Random(case.seed), mutants, report)
    return report


def _decisions(outcome: SynthesisResult) -> Decisions | None:
    if isinstance(outcome, Realizable) and isinstance(outcome.policy.decisions, Table):
        return outcome.policy.decisions.rows
    return None


def _compare(world: World, verdict: OracleVerdict, outcome: SynthesisResult, report: Report) -> Iterator[str]:
    """Complaints about the synthesizer."""
    match outcome:
        case Undecided():
            yield f"undecided: {outcome.limit}"
        case Unrealizable():
            if verdict.kind == "realizable":
                yield "unrealizable, but there is a policy"
            else:
                yield from _compare_failures(world, verdict, outcome)
            yield from _verify_certificate(world, outcome)
        case Realizable():
            if verdict.kind != "realizable":
                yield f"realizable, but {verdict.kind}"
            yield from _compare_policy(world, outcome, report)
    counted = outcome.statistics
    assert counted is not None
    exact = (count_states(world.spec), len(world.valid), len(world.safe), len(world.unsafe))
    if (counted.total, counted.valid, counted.safe, counted.unsafe) != exact:
        yield f"states are miscounted: {counted}"


def _compare_failures(world: World, verdict: OracleVerdict, outcome: Unrealizable) -> Iterator[str]:
    found = {failure.kind: frozenset(failure.states) for failure in outcome.failures}
    for failure in outcome.failures:
        if failure.count != len(found[failure.kind]) or failure.example not in found[failure.kind]:
            yield f"{failure.kind}: the count or the example does not fit the states"
    if len(found) != len(outcome.failures) or not all(found.values()):
        yield "a kind of failure is empty or told twice"
    if verdict.kind == "conflict":
        if set(found) != {"conflict"}:
            yield f"a conflict was reported as {sorted(found)}"
        elif not is_minimal_conflict(world, found["conflict"]):
            yield f"the conflict is none, or is not minimal: {sorted(found['conflict'])}"
        return
    truth = {"no-allowed-set": verdict.no_allowed_set, "no-plan": verdict.no_plan}
    if found != {kind: states for kind, states in truth.items() if states}:
        yield f"failing states differ: {found} instead of {truth}"


def _verify_certificate(world: World, outcome: Unrealizable) -> Iterator[str]:
    """Complaints about the verification of unrealizability, through its file."""
    assert outcome.certificate is not None
    certificate = unrealizability.loads(unrealizability.dumps(outcome.certificate))
    answer = verify_unrealizable(certificate, world.spec, ordering=world.ordering)
    if (answer.verdict, answer.stale) != ("proved", False):
        yield f"the certificate that there is no policy is not proved: {answer}"


def is_minimal_conflict(world: World, states: frozenset[State]) -> bool:
    """`conflict_is_minimal`, where the world is already known."""
    together = Together(world)
    return together.serve(states) is None and all(together.serve(states - {state}) is not None for state in states)


def _compare_policy(world: World, outcome: Realizable, report: Report) -> Iterator[str]:
    decisions = _decisions(outcome)
    if decisions is None:
        yield "the policy of a small specification is not a table"
        return
    if set(decisions) != set(world.valid):
        yield "the rows are not the valid states"
    judgement = judge(world.spec, decisions, world.ordering)
    if not judgement.sound_and_complete:
        yield f"the policy is wrong: {judgement}"
    if not judgement.minimal:
        yield f"the policy is not minimal: {judgement.not_minimal}"
    if outcome.statistics.longest_run != judgement.longest_run:
        yield f"longest run {outcome.statistics.longest_run}, judged {judgement.longest_run}"
    preferred = reference_policy(world)
    if preferred is not None:
        report.referenced = True
        if dict(decisions) != preferred:
            other = {s: (set(decisions[s]), set(preferred[s])) for s in preferred if decisions.get(s) != preferred[s]}
            yield f"not the preferred policy (state: found, preferred): {other}"


def _compare_forms(world: World, outcome: SynthesisResult) -> Iterator[str]:
    """Complaints where the pure Python backend answers differently, or the diagram decides differently."""
    other = synthesize(world.spec, world.ordering, backend="autoref")
    diagram = synthesize(world.spec, world.ordering, policy_format="diagram")
    if type(other) is not type(outcome) or type(diagram) is not type(outcome):
        yield "the verdict depends on the backend or on the policy format"
    elif isinstance(outcome, Unrealizable) and isinstance(other, Unrealizable):
        if outcome.failures != other.failures:
            yield "the failures depend on the backend"
    elif isinstance(outcome, Realizable) and isinstance(other, Realizable) and isinstance(diagram, Realizable):
        if dumps(outcome.policy) != dumps(other.policy):
            yield "the policy depends on the backend"
        if as_table(loads(dumps(diagram.policy)), len(world.valid)) != outcome.policy.decisions:
            yield "the diagram decides otherwise than the table"


def _verify_own(world: World, policy: Policy) -> Iterator[str]:
    """Complaints about the verification of what was synthesized, with its certificate, through its file."""
    answer = verify(loads(dumps(policy)), world.spec, ordering=world.ordering, prover="both")
    if answer.verdict != "proved":
        yield f"the synthesized policy is not proved: {answer}"
    if answer.certificate.status not in ("used", "unneeded"):
        yield f"the certificate was not used: {answer.certificate}"


def _verify_all(world: World, decisions: Decisions, random: Random, mutants: int, report: Report) -> Iterator[str]:
    """Complaints about the verification of a stranger's policies, right and wrong."""
    for name, rows in (("unchanged", decisions), *changed_policies(world, decisions, random, mutants)):
        judgement = judge(world.spec, rows, world.ordering)
        right = judgement.sound_and_complete and judgement.minimal
        report.right_policies += right
        report.wrong_policies += not right
        answer = verify(policy_from_rows(world.spec, rows), world.spec, ordering=world.ordering, prover="both")
        for complaint in _compare_verification(world, rows, judgement, answer):
            yield f"{name}: {complaint}"
    yield from _doubled_rows(world, decisions, random)


def changed_policies(
    world: World, decisions: Decisions, random: Random, count: int
) -> Iterator[tuple[str, dict[State, ActionSet]]]:
    """Policies near `decisions`: one changed to another allowed set, or to any set; two swapped; one dropped."""
    states = sorted(decisions)
    everything = range(len(world.spec.actions))
    for number in range(count):
        changed = dict(decisions)
        state, other = random.choice(states), random.choice(states)
        if world.unsafe and random.random() < 0.5:
            state = random.choice(world.unsafe)
        name = ("changed", "set", "swapped", "dropped", "changed")[(number + random.randrange(5)) % 5]
        if name == "changed":
            changed[state] = random.choice(world.options[state]).chosen
        elif name == "set":
            changed[state] = frozenset(action for action in everything if random.random() < 0.3)
        elif name == "swapped":
            changed[state], changed[other] = changed[other], changed[state]
        else:
            del changed[state]
        yield f"{name} in {state}", changed


def _compare_verification(world: World, rows: Decisions, judgement: Judgement, answer: Verification) -> Iterator[str]:
    right = judgement.sound_and_complete and judgement.minimal
    if answer.verdict != ("proved" if right else "refuted"):
        yield f"verdict {answer.verdict}, judged {judgement}"
    verdicts: dict[str, str] = {result.name: result.verdict for result in answer.properties}
    truth = {"total": not judgement.missing, "safe": not judgement.not_allowed}
    if truth["safe"]:
        truth["goals"] = not judgement.goal_missed
    if judgement.sound_and_complete:
        truth["minimal"] = judgement.minimal
    for name, holds in truth.items():
        if verdicts.get(name) != ("proved" if holds else "refuted"):
            yield f"{name} {verdicts.get(name)}, judged {judgement}"
    for result in answer.properties:
        if result.refutation is not None and not _is_witness(world, rows, judgement, result.refutation):
            yield f"{result.name}: the witness does not show it: {result.refutation}"


def _is_witness(world: World, rows: Decisions, judgement: Judgement, refutation: Refutation) -> bool:
    """Whether a refutation names a state where the judge finds the same fault, and the fault itself."""
    state = refutation.state
    match refutation.kind:
        case "missing":
            return state in judgement.missing
        case "not-allowed":
            return state in dict(judgement.not_allowed) and refutation.objection is not None
        case "goal-missed":
            missed = dict(judgement.goal_missed)
            return state in missed and refutation.run is not None and refutation.run.end == missed[state].end
        case "not-minimal":
            if state is None or state not in rows or refutation.cheaper is None:
                return False
            better = list(better_sets(world.spec, rows, state, world.ordering))
            cheapest = min((duration(world.spec, chosen) for chosen in better), default=None)
            return refutation.cheaper in better and duration(world.spec, refutation.cheaper) == cheapest
        case _:
            return False


def _doubled_rows(world: World, decisions: Decisions, random: Random) -> Iterator[str]:
    """A row told twice says nothing new; told twice differently it is a contradiction."""
    document = json.loads(dumps(policy_from_rows(world.spec, decisions)))
    row = random.choice(document["Policy"])
    document["Policy"].insert(random.randrange(len(document["Policy"])), row)
    again = loads(json.dumps(document)).decisions
    if not isinstance(again, Table) or dict(again.rows) != dict(decisions):
        yield "a row told twice changes the policy"
    other = [action.name for action in world.spec.actions if action.name not in row["Actions"]]
    document["Policy"].append({**row, "Actions": other})
    try:
        loads(json.dumps(document))
    except UserError:
        return
    yield "contradictory rows are accepted"
