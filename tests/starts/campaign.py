"""Specifications with starts through synthesis and every judge: `python -m tests.starts --count N --seed S`."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from pathlib import Path
from random import Random

from msgspec import Struct, field
from msgspec.structs import replace

from tests.checker.agreement import failing
from tests.checker.standalone import ask
from tests.generate import NOWHERE, random_spec
from tests.mutants import cubes_and_layers
from tests.printing import formula_text, print_spec
from tests.profiles import INTERACTING, MIXED, Profile
from tests.restoration.truth import World
from tests.starts.truth import greatest, parts, starts, within
from tests.unrealizability import CONFLICTS
from tumato_symbolic import Realizable, Undecided, Unrealizable, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Policy, as_diagram, as_table, dumps, loads, policy_from_rows, unrealizability
from tumato_symbolic.policy.unrealizability import Conflict, NoPart, StartRemoved, Unrealizability
from tumato_symbolic.semantics import (
    ActionSet,
    Judgement,
    State,
    all_states,
    allowed_sets,
    count_states,
    holds,
    is_valid,
    judge,
    next_states,
)
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.spec import (
    Action,
    Alternative,
    And,
    Assignment,
    ConditionalGoal,
    Formula,
    GoalList,
    Is,
    Not,
    Or,
    Ordering,
    Restoration,
    Rule,
    SimpleGoal,
    Spec,
    Variable,
)
from tumato_symbolic.verify import ProverName, verify, verify_unrealizable
from tumato_symbolic.verify.result import PropertyName

RESTORATIONS: tuple[Restoration, ...] = ("one_step", "bounded", "fair")
PROVERS: tuple[ProverName, ...] = ("z3", "walk", "explicit")

SMALL: dict[str, Profile] = {
    "tiny": replace(
        MIXED, variables=(2, 3), values=(2, 3), states=(4, 9), actions=(3, 5), helpers=0.2, alternatives=0.6, wide=0.2
    ),
    "interacting": replace(INTERACTING, states=(4, 9), values=(2, 3), actions=(3, 5), helpers=0.2),
    "unsafe": replace(
        INTERACTING, states=(4, 9), values=(2, 4), actions=(3, 5), state_rules=(1, 3), helpers=0.1, alternatives=0.3
    ),
    "branching": replace(
        INTERACTING,
        variables=(1, 1),
        values=(5, 8),
        states=(5, 8),
        actions=(6, 8),
        preconditions=(1, 1),
        resources=(0, 0),
        helpers=0.0,
        alternatives=0.35,
        wide=0.0,
        goals=(3, 5),
        conditional=1.0,
    ),
}

LARGER: dict[str, Profile] = {
    "larger": replace(MIXED, states=(12, 48), values=(2, 4), actions=(3, 6), helpers=0.4),
    "larger, interacting": replace(INTERACTING, states=(12, 48), alternatives=0.2, helpers=0.2),
}
"""Too many states for trying every closed set; the greatest part is found state by state."""

CHANGED = 4
"""So many changes of every certificate are judged."""

Decisions = Mapping[State, ActionSet]


class Tally(Struct):
    """What was found; `tried` where every closed set and every policy was tried."""

    answers: Counter[str] = field(default_factory=Counter)
    tried: int = 0
    parts: int = 0
    judged: int = 0
    certificates: Counter[str] = field(default_factory=Counter)
    changed: Counter[bool] = field(default_factory=Counter)
    rejected: Counter[str] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


def with_starts(spec: Spec, random: Random) -> Spec:
    """The specification with one start condition or two, which some valid states satisfy."""
    names = _names(spec)
    while True:
        formulas = [_condition(spec, random) for _ in range(random.choice((1, 1, 2)))]
        rules = tuple(Rule(each, formula_text(each, names), NOWHERE) for each in formulas)
        found = replace(spec, starts=rules)
        if any(is_valid(found, state) and one_holds(found, state) for state in all_states(found)):
            return found


def one_holds(spec: Spec, state: State) -> bool:
    """Whether a state satisfies a start condition."""
    return holds(spec.start, state)


def _condition(spec: Spec, random: Random) -> Formula:
    places = random.sample(range(len(spec.variables)), random.randint(1, len(spec.variables)))
    atoms = [Is(place, random.randrange(len(spec.variables[place].values))) for place in places]
    literals: tuple[Formula, ...] = tuple(Not(atom) if random.random() < 0.15 else atom for atom in atoms)
    if len(literals) == 1:
        return literals[0]
    return And(literals) if random.random() < 0.85 else Or(literals)


def specifications(seed: int) -> Iterator[tuple[str, Spec]]:
    """The specifications of a seed: every profile, every way to restore safety."""
    for name, profile in {**SMALL, **LARGER}.items():
        random = Random(f"{name} {seed}")
        spec = with_starts(random_spec(seed, profile), random)
        restoration = random.choice(RESTORATIONS)
        if random.random() < 0.2:
            rules = (replace(rule, severity=random.choice((1, 2))) for rule in spec.state_rules)
            spec = replace(spec, state_rules=tuple(rules))
        spec = replace(spec, restoration=restoration)
        if name == "branching":
            spec = begun_late(spec, random)
        yield f"{name} {seed} {restoration}", spec
    if seed % 4 == 0:
        yield f"tied {seed}", tied(seed // 4)


def begun_late(spec: Spec, random: Random) -> Spec:
    """With a start that fails only because of what it leads to, or one that does not fail, where there is one."""
    world = World(spec, "any")
    part, failing = frozenset(world.valid), frozenset[State]()
    stages = list[frozenset[State]]()
    while part and (not stages or failing):
        here = within(world, part)
        failing = frozenset(state for state in here.valid if here.kind(state) is not None)
        stages.append(failing)
        part -= failing
    late = sorted(frozenset[State]().union(*stages[1:]) or part)
    return begun_in(spec, random.choice(late)) if late else spec


def begun_in(spec: Spec, state: State) -> Spec:
    """The specification with this one start."""
    formula = one_of([state])
    return replace(spec, starts=(Rule(formula, formula_text(formula, _names(spec)), NOWHERE),))


def _together(effect: Assignment) -> Formula:
    return And(tuple(Is(variable, value) for variable, value in effect))


def tied(seed: int) -> Spec:
    """States whose goals conflict, all of which may follow the one start."""
    number, bound = CONFLICTS[seed % len(CONFLICTS)], (None, 9, 7, 5)[seed // len(CONFLICTS) % 4]
    spec = replace(random_spec(number, INTERACTING), max_plan_length=bound)
    outcome = synthesize(spec, "any")
    assert isinstance(outcome, Unrealizable)
    states, phase = outcome.failures[0].states[:3], len(spec.variables)
    outside, inside = (Rule(Is(phase, value), f"S_Phase is v{value}", NOWHERE) for value in (0, 1))
    led = [tuple(enumerate((*state, 1))) for state in states]
    phases = Variable("S_Phase", ("v0", "v1"), NOWHERE)
    spec = replace(spec, variables=(*spec.variables, phases))
    names = _names(spec)
    others = tuple(Alternative((effect,), formula_text(_together(effect), names), NOWHERE) for effect in led[1:])
    begin = Action("begin", 0, frozenset(), (outside,), led[0], others, NOWHERE)
    actions = (replace(each, preconditions=(*each.preconditions, inside)) for each in spec.actions)
    assert spec.goals is not None
    free = ConditionalGoal(outside, SimpleGoal(len(spec.bodies), inside.text, NOWHERE), NOWHERE)
    goals = GoalList("priority", (free, spec.goals), NOWHERE)
    bodies = (*spec.bodies, inside)
    spec = replace(spec, actions=(*actions, begin), goals=goals, bodies=bodies)
    return begun_in(spec, (*states[0], 0))


def examine(
    spec: Spec, ordering: Ordering, tally: Tally, folder: Path, *, seed: int = 0, most_policies: int = 20_000
) -> Iterator[str]:
    """Complaints about one specification."""
    world, outcome = World(spec, ordering), synthesize(spec, ordering)
    part, counts, lost = greatest(world)
    first = starts(world)
    tried = parts(world, most_policies)
    served = None if tried is None else {each for each, has_policy in tried if has_policy}
    tally.tried += served is not None
    match outcome:
        case Undecided():
            answer = "undecided"
            yield f"undecided: {outcome.limit}"
        case Unrealizable():
            answer = outcome.failures[0].kind
            if served:
                yield f"{answer}, but these parts have policies: {served}"
            yield from _wrong_failures(outcome, lost)
            if outcome.certificate is not None:
                asked = Asked(spec, ordering, folder)
                yield from _wrong_certificate(outcome.certificate, asked, tally, Random(seed))
            else:
                yield "there is no certificate"
        case Realizable():
            answer = "realizable"
            table = as_table(outcome.policy, count_states(spec))
            assert table is not None
            decided = frozenset(table.rows)
            answer += "" if decided == part else ", a smaller part"
            tally.parts += len(decided) < len(world.valid)
            if not first <= decided <= part:
                yield f"decides {sorted(decided)}, of the starts {sorted(first)} in {sorted(part)}"
            if served is not None and (decided not in served or any(len(each) > len(decided) for each in served)):
                yield f"decides {sorted(decided)}, but these parts have policies: {served}"
            yield from _wrong_counts(outcome, world, counts, decided == part)
            yield from _differs_from_assumed(spec, outcome, table.rows, ordering)
            asked = Asked(spec, ordering, folder)
            yield from _wrong_verdicts(asked, outcome.policy, table.rows, tally, Random(seed))
    tally.answers[answer] += 1


def _wrong_certificate(certificate: Unrealizability, asked: Asked, tally: Tally, random: Random) -> Iterator[str]:
    """It is believed; not where nothing that it is about has to be decided; and changed, as the truth is."""
    spec = asked.spec
    tally.certificates[certificate_kind(certificate)] += 1
    yield from _wrong_belief(certificate, asked, wanted=True)
    concerned = set(begun(certificate))
    others = [state for state in all_states(spec) if is_valid(spec, state) and state not in concerned]
    if others:
        elsewhere = one_of([random.choice(others)])
        moved = replace(spec, starts=(Rule(elsewhere, formula_text(elsewhere, _names(spec)), NOWHERE),))
        yield from _wrong_belief(certificate, replace(asked, spec=moved), wanted=False)
    document = json.loads(unrealizability.dumps(certificate))
    for _ in range(CHANGED):
        other = deepcopy(document)
        kind, change = random.choice([*cubes_and_layers.BY_KIND[document["Reason"]["Kind"]].items()])
        change(other, random)
        if other == document:
            continue
        try:
            mutant = unrealizability.loads(json.dumps(other))
        except UserError:
            continue
        yield from (f"{kind}: {each}" for each in _wrong_belief(mutant, asked, tally=tally))


def certificate_kind(certificate: Unrealizability) -> str:
    """The kind of a certificate; of one that removes states, also whether goals conflict in the end."""
    match certificate.reason:
        case NoPart(parts):
            return "no-part" + ("" if isinstance(parts[0], StartRemoved) else f", conflict with {len(parts) - 1} cases")
        case reason:
            return type(reason).__name__


def begun(certificate: Unrealizability) -> Iterator[State]:
    """The states that have to be decided for a certificate to be a proof."""
    match certificate.reason:
        case Conflict() as conflict:
            yield from _begun(conflict)
        case NoPart(parts):
            for part in parts:
                yield from (part.state,) if isinstance(part, StartRemoved) else _begun(part.conflict)
        case reason:
            yield reason.state


def _begun(conflict: Conflict) -> Iterator[State]:
    return (conflict.choices[start].state for start in conflict.starts)


def _wrong_belief(
    certificate: Unrealizability, asked: Asked, *, wanted: bool | None = None, tally: Tally | None = None
) -> Iterator[str]:
    """Where `verify` and the stand-alone checker do not say what is wanted, or do not agree (None)."""
    spec = asked.spec
    try:
        found = verify_unrealizable(certificate, spec, ordering=asked.ordering)
    except UserError as error:
        if wanted is not None:
            yield f"of the certificate, verify says {error}"
        return
    options = ("--effect-ordering", asked.ordering, "--restoration", spec.restoration)
    answer = ask(asked.folder, unrealizability.dumps(certificate), print_spec(spec, Random(0)), *options)
    proved = found.verdict == "proved"
    if tally is not None:
        tally.changed[proved] += 1
    if found.verdict == "undecided" or (wanted is not None and proved != wanted):
        yield f"of the certificate, verify says {found}"
    if answer.code != (0 if proved else 1):
        yield f"of the certificate, verify says {found} and the checker {answer}"


def _names(spec: Spec) -> list[tuple[str, tuple[str, ...]]]:
    return [(variable.name, variable.values) for variable in spec.variables]


def _wrong_failures(outcome: Unrealizable, lost: Mapping[State, str]) -> Iterator[str]:
    found = {(state, failure.kind) for failure in outcome.failures for state in failure.states}
    if outcome.failures[0].kind == "conflict":
        if lost:
            yield f"a conflict, but these starts fail: {lost}"
    elif found != set(lost.items()):
        yield f"failing starts differ: {found} instead of {lost}"


def _wrong_counts(outcome: Realizable, world: World, counts: Mapping[str, int], largest: bool) -> Iterator[str]:
    found, part = outcome.statistics, outcome.statistics.part
    assert part is not None
    if (found.valid, found.safe, part.starts) != (len(world.valid), len(world.safe), len(starts(world))):
        yield f"states are miscounted: {found}"
    if part.decided + sum(each.count for each in part.left_out) != found.valid:
        yield f"what is left out does not add up: {part}"
    if largest and {each.kind: each.count for each in part.left_out} != counts:
        yield f"what is left out differs: {part} instead of {counts}"


def _differs_from_assumed(spec: Spec, outcome: Realizable, rows: Decisions, ordering: Ordering) -> Iterator[str]:
    """The policy is that of the specification which assumes the part."""
    rule = Rule(one_of(rows), "the part", NOWHERE)
    assumed = synthesize(replace(spec, starts=(), assumptions=(*spec.assumptions, rule)), ordering)
    if not isinstance(assumed, Realizable):
        yield f"with the part assumed: {assumed}"
    elif as_table(assumed.policy, len(rows)) != as_table(outcome.policy, len(rows)):
        yield "with the part assumed, decisions differ"


class Asked(Struct, frozen=True):
    """What policies are judged by, and where files for the stand-alone checker go."""

    spec: Spec
    ordering: Ordering
    folder: Path


def _wrong_verdicts(asked: Asked, policy: Policy, rows: Decisions, tally: Tally, random: Random) -> Iterator[str]:
    spec, ordering = asked.spec, asked.ordering
    yield from disagreements(asked, loads(dumps(policy)), rows, "its own", wanted=True)
    tally.judged += 1
    for name, mutant in mutants(spec, rows, ordering, random):
        made = policy_from_rows(spec, mutant, ordering)
        made = replace(made, restoration=spec.restoration, certificate=policy.certificate, digest=policy.digest)
        form = made if random.random() < 0.5 else replace(made, decisions=as_diagram(made))
        wanted = None if name.startswith("any") else False
        yield from disagreements(asked, form, mutant, name, wanted=wanted)
        judgement = judge(spec, mutant, ordering)
        tally.rejected[name] += not (judgement.sound_and_complete and judgement.minimal)
        tally.judged += 1


def disagreements(asked: Asked, policy: Policy, rows: Decisions, name: str, *, wanted: bool | None) -> Iterator[str]:
    """Where provers and the stand-alone checker judge a policy otherwise than the explicit meaning does."""
    spec, ordering = asked.spec, asked.ordering
    judgement = judge(spec, rows, ordering)
    truth = judgement.sound_and_complete and judgement.minimal
    if wanted is not None and truth != wanted:
        yield f"{name}: is {'right' if truth else 'wrong'}: {judgement}"
    for prover in PROVERS:
        found = verify(policy, spec, ordering=ordering, restoration=spec.restoration, prover=prover)
        verdicts = {each.name: each.verdict == "proved" for each in found.properties}
        sure: Iterable[PropertyName] = (
            ("total", "safe") if judgement.not_allowed else verdicts
        )  # what is not allowed need not be told twice
        if any(verdicts[each] != properties(judgement)[each] for each in sure):
            yield f"{name}: {prover} says {verdicts}, the judge {judgement}"
        if name == "its own" and found.certificate.status not in ("used", "unneeded"):
            yield f"{name}: {prover} says of the certificate {found.certificate}"
    answer = ask(
        asked.folder,
        dumps(policy),
        print_spec(spec, Random(0)),
        "--effect-ordering",
        ordering,
        "--restoration",
        spec.restoration,
    )
    given = answer.code, answer.failing
    counts = failing(judgement)
    if judgement.invalid:
        counts["total"] = counts.get("total", 0) + len(judgement.invalid)
    if given != (0 if truth else 1, counts):
        yield f"{name}: the checker says {given}, the judge {judgement}\n{answer.out}{answer.err}"
    if name == "its own" and "certificate: right" not in answer.out:
        yield f"{name}: the checker says\n{answer.out}"


def properties(judgement: Judgement) -> dict[PropertyName, bool]:
    """Which properties hold."""
    return {
        "total": not (judgement.missing or judgement.invalid),
        "safe": not judgement.not_allowed,
        "restoring": not judgement.not_restored,
        "goals": not judgement.goal_missed,
        "minimal": not judgement.not_minimal,
    }


def mutants(spec: Spec, rows: Decisions, ordering: Ordering, random: Random) -> Iterator[tuple[str, Decisions]]:
    """Wrong policies made from a right one, and such as may be right (`any …`)."""
    states = sorted(rows)
    first = [state for state in states if one_holds(spec, state)]
    dropped = random.choice(first)
    yield "a start dropped", {state: chosen for state, chosen in rows.items() if state != dropped}
    outcomes = [(s, t) for s in states for t in sorted(next_states(spec, s, rows[s], ordering)) if t != s]
    if outcomes:
        _, outcome = random.choice(outcomes)
        yield "an outcome undecided", {state: chosen for state, chosen in rows.items() if state != outcome}
    undecided = [state for state in all_states(spec) if state not in rows]
    invalid = [state for state in undecided if not is_valid(spec, state)]
    if invalid:
        yield "an invalid state decided", {**rows, random.choice(invalid): frozenset()}
    leaving = [
        (state, chosen)
        for state in states
        for chosen in allowed_sets(spec, state, ordering)
        if not next_states(spec, state, chosen, ordering) <= rows.keys()
    ]
    if leaving:
        state, chosen = random.choice(leaving)
        yield "a rival that leaves", {**rows, state: chosen}
    valid = [state for state in undecided if is_valid(spec, state)]
    actions = range(len(spec.actions))
    if valid:
        chosen = frozenset(random.sample(actions, random.randint(0, min(2, len(actions)))))
        yield "any state decided as well", {**rows, random.choice(valid): chosen}
    chosen = frozenset(random.sample(actions, random.randint(0, min(2, len(actions)))))
    yield "any decision", {**rows, random.choice(states): chosen}
