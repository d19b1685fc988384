"""Specifications whose safety may take several steps to restore, and policies for them, right and wrong."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from random import Random

from msgspec.structs import replace

from tests.generate import NOWHERE, random_spec
from tests.oracle import World, decide_world
from tests.profiles import RESTORING
from tests.semantics.build import Build, priority, when
from tests.verify.policies import any_set
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Certificate, Deviation, Policy, RankedGoal, Restoring, policy_from_rows
from tumato_symbolic.semantics import (
    ActionSet,
    Effort,
    Quality,
    Residual,
    Restorations,
    State,
    action_names,
    all_states,
    allowed_sets,
    follow,
    is_safe,
    is_valid,
    nominal_agrees,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import (
    Action,
    Alternative,
    Is,
    Not,
    Or,
    Ordering,
    Restoration,
    Rule,
    Spec,
    canonical_text,
    digest,
)

Rows = Mapping[State, ActionSet]
RESTORATIONS: tuple[Restoration, ...] = ("one_step", "bounded", "fair")

PROFILE = replace(RESTORING, state_rules=(2, 3), actions=(3, 5), states=(4, 24), helpers=0.5)
REPAIRS = replace(
    PROFILE, variables=(3, 4), state_rules=(0, 1), helpers=0.6, goals=(1, 2), owns=0.4, reaction_rules=(0, 0)
)


def stepwise_spec(seed: int, restoration: Restoration, tiers: int) -> Spec:
    """A specification of a seed, its state rules of at most so many severities.

    Every second one has a rule and an action that mends it for each of several variables.
    """
    random = Random(seed)
    spec = random_spec(seed, PROFILE) if seed % 2 else with_repairs(random_spec(seed, REPAIRS), random)
    rules = tuple(replace(rule, severity=random.randint(1, tiers)) for rule in spec.state_rules)
    spec = replace(spec, state_rules=rules, restoration=restoration)
    return replace(spec, preconditions="throughout") if seed % 4 > 1 else spec


def with_repairs(spec: Spec, random: Random) -> Spec:
    """With a rule against one value of each of some variables, and an action against it that may do something else.

    One action has no effects.
    """
    rules, actions = list(spec.state_rules), list(spec.actions)
    sizes = [len(variable.values) for variable in spec.variables]
    for variable in [number for number, size in enumerate(sizes) if size > 1][: random.choice((2, 3))]:
        rules.append(Rule(Not(Is(variable, 0)), f"{spec.variables[variable].name} is not v0", NOWHERE))
        effect = {variable: 1}
        if random.random() < 0.3:
            other = random.randrange(len(sizes))
            effect.setdefault(other, random.randrange(sizes[other]))
        fails = (Alternative(((),), "none", NOWHERE),) if random.random() < 0.2 else ()
        nominal = tuple(sorted(effect.items()))
        held = frozenset(range(len(spec.resources))) if random.random() < 0.5 else frozenset[int]()
        actions.append(Action(f"mend{variable}", random.randint(0, 4), held, (), nominal, fails, NOWHERE))
    actions.append(Action("tell", random.randint(0, 1), frozenset[int](), (), (), (), NOWHERE))
    return replace(spec, state_rules=tuple(rules), actions=tuple(actions))


def near(spec: Spec, ordering: Ordering, random: Random, count: int = 3) -> Iterator[dict[State, ActionSet]]:
    """A policy that is as good as a greedy search makes it, `count` changed ones, and one at random."""
    world = World(spec, ordering)
    valid = world.valid
    options = {state: [option.chosen for option in some] for state, some in world.options.items()}
    found = greedy(world, options)
    yield found
    for _ in range(count):
        rows = dict(found)
        for _ in range(random.choice((1, 1, 2))):
            state, other = random.choice(valid), random.choice(valid)
            draw = random.random()
            if draw < 0.6 and options[state]:
                rows[state] = random.choice(options[state])
            elif draw < 0.75:
                rows[state] = any_set(spec, random)
            elif draw < 0.9 and {state, other} <= set(rows):
                rows[state], rows[other] = rows[other], rows[state]
            else:
                rows.pop(state, None)
        yield rows
    yield {
        state: random.choice(sets) if sets and random.random() < 0.9 else any_set(spec, random)
        for state, sets in options.items()
    }


def greedy(world: World, options: Mapping[State, list[ActionSet]]) -> dict[State, ActionSet]:
    """Safe states as the oracle serves them, then unsafe ones by increasing quality; some may stay undecided."""
    spec, unsafe = world.spec, world.unsafe
    world.valid, world.unsafe = world.safe, []
    policy = dict(decide_world(world).policy or {state: options[state][0] for state in world.safe if options[state]})
    while True:
        restorations = Restorations(spec, policy, world.ordering)
        found: list[tuple[Quality, State, ActionSet]] = []
        for state in unsafe:
            for chosen in options[state] if state not in policy else ():
                quality = restorations.quality(state, chosen)
                if quality is not None and follow(spec, {**policy, state: chosen}, state, chosen).end == "goal":
                    found.append((quality, state, chosen))
        if not found:
            return policy
        best = min(quality for quality, _, _ in found)
        for quality, state, chosen in found:
            if quality == best:
                policy.setdefault(state, chosen)


Ranks = dict[Residual, dict[State, int]]
Efforts = dict[State, Effort]
Said = tuple[Ranks, Efforts, Efforts, list[Deviation]]


def exact(spec: Spec, rows: Rows, ordering: Ordering) -> Said:
    """All that a certificate says of a policy: ranks, efforts in the worst case, along nominal runs, deviations."""
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    goals = {residual_goal(spec, state, rows[state]): None for state in valid if state in rows}
    for state in valid:
        if not is_safe(spec, state):
            goals.update((residual_goal(spec, state, chosen), None) for chosen in allowed_sets(spec, state, ordering))
    ranks = {
        goal: {state: rank for state in valid if (rank := _rank(spec, rows, goal, state)) is not None} for goal in goals
    }
    decided = {state: rows[state] for state in valid if state in rows}
    restorations = Restorations(spec, decided, ordering)
    unsafe = [s for s in decided if not is_safe(spec, s) and nominal_agrees(spec, decided[s])]
    nominal = {
        state: effort
        for state in unsafe
        if state not in restorations.worst and (effort := restorations.nominal(state, decided[state])) is not None
    }
    deviations = [each for state in unsafe for each in _deviations(spec, decided, state, restorations, ordering)]
    return ranks, dict(restorations.worst), nominal if spec.restoration == "fair" else {}, deviations


def _rank(spec: Spec, rows: Rows, goal: Residual, state: State) -> int | None:
    met: list[State] = []
    while not reached(spec, goal, state):
        if state in met or state not in rows or not nominal_agrees(spec, rows[state]):
            return None
        met.append(state)
        state = successor(spec, state, rows[state])
    return len(met)


def _deviations(
    spec: Spec, rows: dict[State, ActionSet], state: State, restorations: Restorations, ordering: Ordering
) -> Iterator[Deviation]:
    now = restorations.quality(state, rows[state])
    for chosen in allowed_sets(spec, state, ordering):
        quality, changed = restorations.quality(state, chosen), {**rows, state: chosen}
        if quality is None or (now is not None and quality >= now):
            continue
        if follow(spec, changed, state, chosen).end != "goal":
            continue
        for other, first in rows.items():
            serves = other != state and nominal_agrees(spec, first) and follow(spec, rows, other, first).end == "goal"
            if serves and follow(spec, changed, other, first).end != "goal":
                yield Deviation(state, chosen, other)
                break


def certified(spec: Spec, rows: Rows, said: Said) -> Policy:
    """The policy of `rows` with a certificate that says this."""
    ranks, worst, nominal, deviations = said
    sizes = [len(variable.values) for variable in spec.variables]
    order = range(len(spec.variables))
    numbers = {rank for table in ranks.values() for rank in table.values()}
    builder = DiagramBuilder[int | None](order, [None, *sorted(numbers)])
    goals = [
        RankedGoal(
            tuple(sorted(canonical_text(spec, spec.bodies[body].formula) for body in goal.bodies)),
            tuple(sorted(action_names(spec, goal.executed))),
            builder.from_table(sizes, table, None),
        )
        for goal, table in ranks.items()
    ]
    efforts = DiagramBuilder[Effort | None](order, [None, *sorted({*worst.values(), *nominal.values()})])
    roots = [efforts.from_table(sizes, table, None) for table in (worst, nominal)]
    restoring = Restoring(efforts.finish(), roots[0], roots[1], tuple(deviations))
    certificate = Certificate(builder.finish(), tuple(goals), restoring)
    policy = policy_from_rows(spec, rows, None, digest(spec), certificate)
    return replace(policy, restoration=spec.restoration)


def detours(seed: int, restoration: Restoration) -> Spec:
    """Unsafe places, some with ways to others, some to safe ones; and runs that have to end in certain ones."""
    random = Random(seed)
    unsafe, safe = random.randint(2, 4), random.randint(2, 3)
    places = "abcdefg"[: unsafe + safe]
    build = Build({"P": places}, ["R"])
    for here in places[:unsafe]:
        ways = [(there, takes) for takes, there in enumerate(random.sample(places[unsafe:], 2), 1)]
        if places.index(here) < unsafe // 2:
            ways = [(random.choice(places[unsafe // 2 : unsafe]), 1), (random.choice(places[:unsafe]), 2)]
        for there, takes in ways:
            fails = ["", f"P={random.choice(places)}"][: random.choice((0,) * 12 + (1, 2))]
            build.action(f"P={there}", fails, [build.atom(f"P={here}")], ["R"], takes)
    ends = [(here, random.choice(places[unsafe:])) for here in places[: unsafe // 2]]
    goals = [when(build.atom(f"P={here}"), build.goal(build.atom(f"P={end}"))) for here, end in ends]
    rules = [Or(tuple(build.atom(f"P={here}") for here in places[unsafe:]))]
    bound = random.choice((None, None, 2, 3))
    spec = build.spec(priority(*goals) if goals else None, rules, bound=bound)
    return replace(spec, restoration=restoration)
