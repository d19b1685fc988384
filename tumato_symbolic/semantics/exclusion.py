"""Which actions are never executed together, whatever the state (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from tumato_symbolic.semantics.step import nominal_agrees
from tumato_symbolic.spec import Spec


def disagree(spec: Spec, first: int, second: int) -> bool:
    """Whether the nominal effects of two actions give a variable two different values."""
    return not nominal_agrees(spec, frozenset((first, second)))


def exclude_each_other(spec: Spec, first: int, second: int) -> bool:
    """Whether two actions are never in one allowed set: a common resource, or nominal effects that disagree."""
    return bool(spec.actions[first].resources & spec.actions[second].resources) or disagree(spec, first, second)


def disagreeing_pairs(spec: Spec) -> list[tuple[int, int]]:
    """Pairs of actions whose nominal effects disagree."""
    return [pair for pair in _pairs(spec) if disagree(spec, *pair)]


def exclusive_pairs(spec: Spec) -> list[tuple[int, int]]:
    """Pairs of actions that exclude each other."""
    return [pair for pair in _pairs(spec) if exclude_each_other(spec, *pair)]


def _pairs(spec: Spec) -> Iterator[tuple[int, int]]:
    return combinations(range(len(spec.actions)), 2)


def exclusive_groups(spec: Spec) -> list[tuple[int, ...]]:
    """Every action in one group whose members exclude each other: greedily, in the order of declaration."""
    groups: list[list[int]] = []
    for action in range(len(spec.actions)):
        fitting = (group for group in groups if all(exclude_each_other(spec, action, other) for other in group))
        home = next(fitting, None)
        if home is None:
            groups.append([action])
        else:
            home.append(action)
    return [tuple(group) for group in groups]
