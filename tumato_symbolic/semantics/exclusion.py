"""Which actions are never executed together, whatever the state (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from tumato_symbolic.spec import Spec

Contest: TypeAlias = Sequence[Sequence[int]]
"""What only one side may have: actions of different sides are never executed together."""


def contested_resources(spec: Spec) -> Iterator[Contest]:
    """Each resource that several actions control."""
    for resource in range(len(spec.resources)):
        users = [(number,) for number, action in enumerate(spec.actions) if resource in action.resources]
        if len(users) > 1:
            yield users


def contested_values(spec: Spec) -> Iterator[Contest]:
    """Each variable to which nominal effects give different values: the actions by the value."""
    writers: list[dict[int, list[int]]] = [{} for _ in spec.variables]
    for number, action in enumerate(spec.actions):
        for variable, value in action.nominal:
            writers[variable].setdefault(value, []).append(number)
    return (list(by_value.values()) for by_value in writers if len(by_value) > 1)


def excluded(spec: Spec) -> list[int]:
    """For each action, a bit for every one that excludes it or that it is a case with; its own among them, perhaps."""
    found: list[int] = []
    for cases in spec.cases:
        found += [sum(1 << case for case in cases) if len(cases) > 1 else 0] * len(cases)
    for contest in (*contested_resources(spec), *contested_values(spec)):
        sides = [sum(1 << number for number in side) for side in contest]
        everyone = sum(sides)
        for side, own in zip(contest, sides, strict=True):
            for number in side:
                found[number] |= everyone ^ own
    return found


def exclusive_groups(spec: Spec) -> list[tuple[int, ...]]:
    """Every action in one group whose members exclude each other: greedily, in the order of declaration."""
    groups: list[list[int]] = []
    members: list[int] = []
    for action, others in enumerate(excluded(spec)):
        home = next((number for number, group in enumerate(members) if not group & ~others), None)
        if home is None:
            groups.append([action])
            members.append(1 << action)
        else:
            groups[home].append(action)
            members[home] |= 1 << action
    return [tuple(group) for group in groups]
