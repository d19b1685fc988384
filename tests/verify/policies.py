"""Policies right and wrong, with certificates right and wrong, made from the explicit meaning alone."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from random import Random

from msgspec.structs import replace

from tests.oracle import decide, world_of
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Certificate, Policy, RankedGoal, as_diagram, policy_from_rows
from tumato_symbolic.semantics import (
    ActionSet,
    Residual,
    State,
    action_names,
    all_states,
    allowed_sets,
    is_safe,
    is_valid,
    judge,
    next_states,
    nominal_agrees,
    outcomes,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec, canonical_text, digest

Rows = Mapping[State, ActionSet]
Ranks = dict[Residual, dict[State, int]]


def near_policies(spec: Spec, ordering: Ordering, random: Random, count: int = 3) -> Iterator[dict[State, ActionSet]]:
    """A sound and complete policy if there is one, the same made minimal, `count` changed ones, and two at random."""
    found, options = decide(spec, ordering).policy, _options(spec, ordering)
    valid = list(options)
    if found is not None:
        plain, minimal = dict(found), made_minimal(spec, ordering, found)
        yield plain
        yield minimal
        for _ in range(count):
            yield changed(spec, ordering, random, random.choice((plain, minimal)), valid)
    yield {state: random.choice(sets) if sets else any_set(spec, random) for state, sets in options.items()}
    yield {
        state: random.choice(sets) if sets and random.random() < 0.8 else any_set(spec, random)
        for state, sets in options.items()
        if random.random() < 0.95
    }


def _options(spec: Spec, ordering: Ordering) -> dict[State, list[ActionSet]]:
    """The allowed sets of every valid state."""
    return {state: [each.chosen for each in some] for state, some in world_of(spec, ordering).options.items()}


def leaving(spec: Spec, rows: Rows, ordering: Ordering) -> set[tuple[State, State]]:
    """Decided states from where the policy may lead to one that is valid and undecided, each with that one."""
    decided = {state: chosen for state, chosen in rows.items() if is_valid(spec, state)}
    return {
        (state, after)
        for state, chosen in decided.items()
        for after in _next(spec, state, chosen, ordering)
        if after not in decided and is_valid(spec, after)
    }


def _next(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> set[State]:
    if nominal_agrees(spec, chosen):
        return next_states(spec, state, chosen, ordering)
    return set(outcomes(spec, state, chosen, ordering))


def made_minimal(spec: Spec, ordering: Ordering, rows: Rows) -> dict[State, ActionSet]:
    """`rows` with a cheaper set wherever the judge finds one."""
    better = dict(rows)
    while cheaper := judge(spec, better, ordering).not_minimal:
        better.update([cheaper[0]])
    return better


def changed(spec: Spec, ordering: Ordering, random: Random, rows: Rows, states: list[State]) -> dict[State, ActionSet]:
    """`rows` with one decision changed, two swapped, or one dropped."""
    result, state, other = dict(rows), random.choice(states), random.choice(states)
    match random.randrange(4):
        case 0:
            result[state] = any_set(spec, random)
        case 1:
            result[state] = random.choice(list(allowed_sets(spec, state, ordering)))
        case 2:
            result[state], result[other] = result[other], result[state]
        case _:
            del result[state]
    return result


def any_set(spec: Spec, random: Random) -> ActionSet:
    """Any actions, allowed or not."""
    return frozenset(number for number in range(len(spec.actions)) if random.random() < 0.3)


def dressed(spec: Spec, rows: Rows, random: Random) -> Policy:
    """The policy of `rows` as a stranger might write it: with rows for invalid states, as a table or as a diagram."""
    extended = dict(rows)
    if random.random() < 0.3:
        for state in all_states(spec):
            if not is_valid(spec, state) and random.random() < 0.5:
                extended[state] = any_set(spec, random)
    policy = policy_from_rows(spec, extended)
    return policy if random.random() < 0.7 else replace(policy, decisions=as_diagram(policy))


def exact_ranks(spec: Spec, rows: Rows, ordering: Ordering) -> Ranks:
    """The ranks of the safe states, for every residual goal of the policy and of the allowed sets of unsafe states.

    Where safety may take several steps to restore, those of all valid states.
    """
    options = _options(spec, ordering)
    goals = {residual_goal(spec, state, rows[state]): None for state in options if state in rows}
    for state, sets in options.items():
        if not is_safe(spec, state):
            goals.update((residual_goal(spec, state, chosen), None) for chosen in sets)
    ranked = [state for state in options if spec.restores_stepwise or is_safe(spec, state)]
    return {
        goal: {state: rank for state in ranked if (rank := _rank(spec, rows, goal, state)) is not None}
        for goal in goals
    }


def _rank(spec: Spec, rows: Rows, goal: Residual, state: State) -> int | None:
    """How many steps the policy needs from `state`."""
    if reached(spec, goal, state):
        return 0
    if state not in rows:
        return None
    met: list[State] = []
    while state in rows and state not in met:
        met.append(state)
        state = successor(spec, state, rows[state])
        if reached(spec, goal, state):
            return len(met)
    return None


def certified(spec: Spec, rows: Rows, ranks: Ranks) -> Policy:
    """The policy of `rows` with a certificate of these ranks."""
    leaves = {rank for table in ranks.values() for rank in table.values()}
    builder = DiagramBuilder[int | None](range(len(spec.variables)), [None, *sorted(leaves)])
    sizes = [len(variable.values) for variable in spec.variables]
    goals = [
        RankedGoal(
            tuple(sorted(canonical_text(spec, spec.bodies[body].formula) for body in goal.bodies)),
            tuple(sorted(action_names(spec, goal.executed))),
            builder.from_table(sizes, table, None),
        )
        for goal, table in ranks.items()
    ]
    return policy_from_rows(spec, rows, None, digest(spec), Certificate(builder.finish(), tuple(goals)))


def wrong_ranks(ranks: Ranks, random: Random) -> Ranks:
    """One rank changed, dropped or added, or all ranks of one goal dropped."""
    result = {goal: dict(table) for goal, table in ranks.items()}
    goal = random.choice(list(result))
    table = result[goal]
    match random.randrange(4) if table else 0:
        case 0:
            del result[goal]
        case 1:
            del table[random.choice(list(table))]
        case 2:
            state = random.choice(list(table))
            table[state] = max(0, table[state] + random.choice((-1, 1, 2)))
        case _:
            first, second = random.choice(list(table)), random.choice(list(table))
            table[first], table[second] = table[second], table[first]
    return result
