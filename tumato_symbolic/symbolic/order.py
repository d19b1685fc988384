"""The order of variables in BDDs: hubs on top, and what depends on each other close together.

Measured on the families of `benchmarks/` (`docs/performance.md`, "The order of the variables"). The order changes what
sets cost and how diagrams are written, never a decision.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from tumato_symbolic.spec import ConditionalGoal, Goal, SimpleGoal, Spec, executing_atoms, variables_of

Scope: TypeAlias = frozenset[int]
"""State variables that something relates."""

SHARE_OF_HUBS = 0.5
"""A variable that more than this share of the actions reads or writes is a hub."""

MOST_ROUNDS = 100
"""So often variables are moved towards those that they are read and written with."""


def variable_order(spec: Spec) -> tuple[int, ...]:
    """All state variables: hubs as they are declared, then the others so that related ones are near each other.

    A hub, such as where the robot is, would be in the middle of everything; on top, it leaves independent rests.
    """
    of_actions = list(_action_scopes(spec))
    hubs = [
        variable
        for variable in range(len(spec.variables))
        if sum(variable in scope for scope in of_actions) > SHARE_OF_HUBS * len(of_actions)
    ]
    others = [variable for variable in range(len(spec.variables)) if variable not in hubs]
    scopes = (scope.difference(hubs) for scope in (*of_actions, *_rule_scopes(spec), *_goal_scopes(spec)))
    return (*hubs, *_near_each_other(others, [scope for scope in scopes if len(scope) > 1]))


def _action_scopes(spec: Spec) -> Iterator[Scope]:
    """What each action reads or writes."""
    read: dict[int, Scope] = {}  # by formula, many of which cases share
    for action, written in zip(spec.actions, _written(spec), strict=True):
        formulas = [rule.formula for rule in action.conditions]
        for formula in formulas:
            if id(formula) not in read:
                read[id(formula)] = variables_of(formula)
        yield written.union(*(read[id(formula)] for formula in formulas))


def _rule_scopes(spec: Spec) -> Iterator[Scope]:
    """The variables that each rule and assumption mentions; an action stands for what it writes."""
    written = _written(spec)
    for rule in (*spec.state_rules, *spec.assumptions, *spec.reaction_rules):
        yield variables_of(rule.formula).union(*(written[action] for action in executing_atoms(rule.formula)))


def _written(spec: Spec) -> list[Scope]:
    return [frozenset(v for effect in action.effects for v, _ in effect) for action in spec.actions]


def _goal_scopes(spec: Spec) -> Iterator[Scope]:
    """The variables that each goal mentions, its condition included."""
    pending: list[tuple[Goal, Scope]] = [] if spec.goals is None else [(spec.goals, frozenset())]
    while pending:
        goal, conditions = pending.pop()
        if isinstance(goal, SimpleGoal):
            yield conditions | variables_of(spec.bodies[goal.body].formula)
        elif isinstance(goal, ConditionalGoal):
            pending.append((goal.goal, conditions | variables_of(goal.condition.formula)))
        else:
            pending += [(member, conditions) for member in reversed(goal.members)]


def _near_each_other(variables: Sequence[int], scopes: Sequence[Scope]) -> Sequence[int]:
    """The method of Aloul, Markov and Sakallah (*FORCE*, 2003): every scope pulls its variables to its middle.

    Small scopes pull harder. The best order met counts, by the sum of the distances that scopes span.
    """
    best, least = variables, _spanned(variables, scopes)
    order = variables
    for _ in range(MOST_ROUNDS):
        order, earlier = _pulled(order, scopes), order
        if order == earlier:
            break
        spanned = _spanned(order, scopes)
        if spanned < least:
            best, least = order, spanned
    return best


def _pulled(order: Sequence[int], scopes: Sequence[Scope]) -> Sequence[int]:
    """One round: every variable goes to the mean of the middles of its scopes."""
    place = {variable: float(number) for number, variable in enumerate(order)}
    pull, strength = dict.fromkeys(order, 0.0), dict.fromkeys(order, 0.0)
    for scope in scopes:
        weight = 1 / (len(scope) - 1)
        middle = sum(sorted(place[variable] for variable in scope)) / len(scope)
        for variable in scope:
            pull[variable] += weight * middle
            strength[variable] += weight
    return sorted(order, key=lambda each: (pull[each] / strength[each] if strength[each] else place[each], place[each]))


def _spanned(order: Sequence[int], scopes: Sequence[Scope]) -> int:
    place = {variable: number for number, variable in enumerate(order)}
    return sum(max(map(place.__getitem__, scope)) - min(map(place.__getitem__, scope)) for scope in scopes)
