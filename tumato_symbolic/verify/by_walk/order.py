"""Which actions are never together, and in which order the walk tests its variables."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from tumato_symbolic.semantics import nominal_agrees
from tumato_symbolic.spec import Spec


def conflicting(spec: Spec) -> list[tuple[int, int]]:
    """Pairs of actions that are never in one allowed set: a common resource, or nominal effects that disagree."""
    apart = set(disagreeing(spec))
    return [
        pair
        for pair in combinations(range(len(spec.actions)), 2)
        if pair in apart or spec.actions[pair[0]].resources & spec.actions[pair[1]].resources
    ]


def disagreeing(spec: Spec) -> list[tuple[int, int]]:
    """Pairs of actions whose nominal effects disagree."""
    pairs = combinations(range(len(spec.actions)), 2)
    return [pair for pair in pairs if not nominal_agrees(spec, frozenset(pair))]


def exclusive_groups(spec: Spec) -> list[list[int]]:
    """All actions, in groups of which no two are ever in one allowed set."""
    apart = {frozenset(pair) for pair in conflicting(spec)}
    groups: list[list[int]] = []
    for action in range(len(spec.actions)):
        fitting = (group for group in groups if all(frozenset((action, other)) in apart for other in group))
        group = next(fitting, None)
        if group is None:
            groups.append([action])
        else:
            group.append(action)
    return groups


def walk_order(spec: Spec, tested: Sequence[int], groups: Sequence[Sequence[int]]) -> list[int]:
    """The variables as the policy tests them, every group just above the first one that it writes.

    Groups are numbered after the variables; those that write nothing come first.
    """
    states = [*tested, *(variable for variable in range(len(spec.variables)) if variable not in tested)]
    above: dict[int | None, list[int]] = {}
    for number, group in enumerate(groups):
        written = {variable for action in group for effect in spec.actions[action].effects for variable, _ in effect}
        first = next((variable for variable in states if variable in written), None)
        above.setdefault(first, []).append(len(spec.variables) + number)
    return [*above.get(None, ()), *(each for variable in states for each in (*above.get(variable, ()), variable))]
