"""Generated specifications that restore safety in several steps, policies for them, and certificates of these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from random import Random

from msgspec import Struct
from msgspec.structs import replace

from tests.generate import random_spec
from tests.oracle import World, decide_world
from tests.profiles import RESTORING
from tests.verify.policies import any_set, certified, changed, exact_ranks
from tumato_symbolic import parse
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Deviation, Policy, Restoring
from tumato_symbolic.semantics import (
    ActionSet,
    Effort,
    Residual,
    Restorations,
    State,
    follow,
    is_safe,
    judge,
    nominal_agrees,
    restored,
)
from tumato_symbolic.semantics.step import allowed_sets, next_states
from tumato_symbolic.spec import Ordering, Restoration, Spec

Rows = Mapping[State, ActionSet]

PROFILE = replace(
    RESTORING,
    states=(4, 30),
    state_rules=(2, 3),
    reaction_rules=(0, 1),
    actions=(4, 6),
    helpers=0.75,
    preconditions=(0, 1),
    no_goals=0.3,
    conditional=0.9,
    bounded=0.2,
    alternatives=0.3,
)

MODES: list[tuple[Restoration, int]] = [
    ("one_step", 2),
    ("one_step", 3),
    ("bounded", 1),
    ("bounded", 2),
    ("bounded", 3),
    ("fair", 1),
    ("fair", 2),
    ("fair", 3),
]
"""Ways to restore safety and numbers of severities, but for the plain one."""


def stepwise_spec(seed: int, restoration: Restoration, tiers: int) -> Spec:
    """The specification of a seed with that many severities at most, so that they are needed."""
    random, spec = Random(seed), random_spec(seed, PROFILE)
    numbers = [random.choice((1, 2, 5)[:tiers]) for _ in spec.state_rules]
    rules = tuple(replace(rule, severity=number) for rule, number in zip(spec.state_rules, numbers, strict=True))
    return replace(spec, restoration=restoration, state_rules=rules)


def ways(seed: int, restoration: Restoration, tiers: int) -> Spec:
    """Places with ways between them, some of which may lead elsewhere or nowhere; the last ones are safe.

    Goals of unsafe states want particular safe places, so decisions serve and hinder each other.
    """
    random = Random(seed)
    count = random.randint(4, 7)
    places = [f"p{number}" for number in range(count)]
    ends = sorted(random.sample(range(1, count - 1), min(tiers, count - 2)))
    worst, safe = places[: ends[-1]], places[ends[-1] :]

    def move(number: int, origin: str) -> str:
        near = [place for place in places if place != origin] if origin in worst else safe
        others = f"alternative effects: {random.choice((f'P is {random.choice(near)}', 'none'))}"
        return (
            f"action m{number} duration: {random.randint(0, 4)} "
            f"{'controlled resources: LEGS' if random.random() < 0.8 else ''} "
            f"preconditions: P is {origin} nominal effects: P is {random.choice(near)} "
            f"{others if random.random() < 0.3 else ''}"
        )

    origins = [*worst, *worst, *random.choices(places, k=2)]
    moves = [move(number, origin) for number, origin in enumerate(origins)]
    rules = [f"severity: {number} rule: {in_any(places[end:])}" for number, end in enumerate(ends, 1)]
    wishes = [f"when P is {random.choice(worst)} then goal: P is {random.choice(safe)}" for _ in range(2)]
    bound = f"max_plan_length: {random.randint(2, 4)}" if random.random() < 0.3 else ""
    return parse(
        f"BEGIN STATE VECTOR state P can be {', '.join(places)} END STATE VECTOR "
        f"BEGIN RESOURCES resource LEGS END RESOURCES BEGIN ACTIONS {' '.join(moves)} END ACTIONS "
        f"BEGIN STATE RULES {' '.join(rules)} END STATE RULES "
        f"BEGIN GOALS goal type: priority {' '.join(wishes)} END GOALS "
        f"BEGIN CONFIG restoration: {restoration} {bound} END CONFIG"
    )


def in_any(places: Sequence[str]) -> str:
    """The predicate that the place is one of these."""
    return " OR ".join(f"P is {place}" for place in places)


def policies(
    spec: Spec, ordering: Ordering, random: Random, mutants: int, samples: int = 0
) -> Iterator[dict[State, ActionSet]]:
    """One that serves, if one is found; the same as good as the judge can make it; and some made from both."""
    world = World(spec, ordering)
    found = decide_world(world).policy
    start = dict(found) if found is not None else {state: _any_allowed(world, random, state) for state in world.valid}
    plain = _restoring(world, start)
    better = improved(spec, ordering, plain)
    yield from (better, plain, start)
    sampled = ({state: _any_allowed(world, random, state) for state in world.valid} for _ in range(samples))
    right = next((rows for rows in sampled if judge(spec, rows, ordering).sound_and_complete), None)
    if right is not None:
        better = improved(spec, ordering, right)
        yield from (right, better)
    for _ in range(mutants):
        rows = random.choice((plain, better, better))
        try:
            yield changed(spec, ordering, random, rows, world.valid)
        except IndexError:  # no set is allowed there
            yield {**rows, random.choice(world.valid): any_set(spec, random)}
        unsafe = random.sample(world.unsafe, min(2, len(world.unsafe)))
        yield {**rows, **{state: _any_allowed(world, random, state) for state in unsafe}}


def _any_allowed(world: World, random: Random, state: State) -> ActionSet:
    return random.choice(world.options[state]).chosen if world.options[state] else frozenset()


def _restoring(world: World, start: Rows) -> dict[State, ActionSet]:
    """`start`, restoring unsafe states layer by layer as far as that goes, with sets that serve where there are any."""
    spec, rows = world.spec, dict(start)
    open_ = set(world.unsafe)
    for by_nominal_effects in (False, True):
        while found := [
            pair for state in sorted(open_) for pair in _layer(world, rows, open_, state, by_nominal_effects)
        ]:
            if by_nominal_effects and spec.restoration != "fair":
                break
            for state, chosen in found:
                rows[state] = chosen
                open_.discard(state)
    return rows


def _layer(
    world: World, rows: Rows, open_: set[State], state: State, by_nominal_effects: bool
) -> list[tuple[State, ActionSet]]:
    spec, fits = world.spec, []
    for option in world.options[state]:
        after = {option.after} if by_nominal_effects else next_states(spec, state, option.chosen, world.ordering)
        if not any(each in open_ and not restored(spec, state, each) for each in after):
            fits.append(option.chosen)
    serving = (chosen for chosen in fits if follow(spec, {**rows, state: chosen}, state, chosen).end == "goal")
    return [(state, chosen) for chosen in islice((*serving, *fits), 1)]


def improved(spec: Spec, ordering: Ordering, rows: Rows, times: int = 12) -> dict[State, ActionSet]:
    """`rows` with a better set wherever the judge finds one, so many times at most."""
    better = dict(rows)
    for _ in range(times):
        found = judge(spec, better, ordering).not_minimal
        if not found:
            break
        better.update([found[0]])
    return better


class Claims(Struct):
    """What a certificate says of a policy: ranks, efforts, and deviations with the runs that would miss their goals."""

    ranks: dict[Residual, dict[State, int]]
    worst: dict[State, Effort]
    nominal: dict[State, Effort]
    deviations: list[tuple[State, ActionSet, State]]


def true_claims(spec: Spec, rows: Rows, ordering: Ordering) -> Claims:
    """All that is so."""
    decided = {state: chosen for state, chosen in rows.items() if nominal_agrees(spec, chosen)}
    restorations = Restorations(spec, decided, ordering)
    unsafe = [state for state in decided if not is_safe(spec, state)]
    nominal = {state: restorations.nominal(state, decided[state]) for state in unsafe}
    return Claims(
        exact_ranks(spec, decided, ordering),
        dict(restorations.worst),
        {state: effort for state, effort in nominal.items() if effort is not None and state not in restorations.worst},
        [(state, chosen, missed[0]) for (state, chosen), missed in rivals(spec, decided, ordering).items() if missed],
    )


def rivals(spec: Spec, rows: Rows, ordering: Ordering) -> dict[tuple[State, ActionSet], list[State]]:
    """The better sets with which the run of a state serves the state itself, and whose runs then miss their goals."""
    restorations, found = Restorations(spec, rows, ordering), dict[tuple[State, ActionSet], list[State]]()
    for state, today in rows.items():
        now = None if is_safe(spec, state) else restorations.quality(state, today)
        for chosen in () if is_safe(spec, state) else allowed_sets(spec, state, ordering):
            quality = restorations.quality(state, chosen)
            better = quality is not None and (now is None or quality < now)
            if better and follow(spec, {**rows, state: chosen}, state, chosen).end == "goal":
                found[state, chosen] = losers(spec, rows, state, chosen)
    return found


def losers(spec: Spec, rows: Rows, state: State, chosen: ActionSet) -> list[State]:
    """The other states whose runs reach their goals by the policy, and not with this set in a state."""
    changed_rows = {**rows, state: chosen}
    return [
        other
        for other, first in rows.items()
        if other != state
        and follow(spec, rows, other, first).end == "goal"
        and follow(spec, changed_rows, other, first).end != "goal"
    ]


def claiming(spec: Spec, rows: Rows, claims: Claims, ordering: Ordering) -> Policy:
    """The policy of `rows` with a certificate that says so."""
    policy = certified(spec, rows, claims.ranks)
    assert policy.certificate is not None
    leaves = sorted({*claims.worst.values(), *claims.nominal.values()})
    builder = DiagramBuilder[Effort | None](range(len(spec.variables)), [None, *leaves])
    sizes = [len(variable.values) for variable in spec.variables]
    worst, nominal = (builder.from_table(sizes, table, None) for table in (claims.worst, claims.nominal))
    deviations = tuple(Deviation(*each) for each in claims.deviations)
    restoring = Restoring(builder.finish(), worst, nominal, deviations)
    certificate = replace(policy.certificate, restoring=restoring)
    return replace(policy, certificate=certificate, ordering=ordering, restoration=spec.restoration)
