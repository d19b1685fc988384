"""The sets of actions that come nearest to being allowed, and what speaks against them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from math import prod

from msgspec import Struct

from tumato_symbolic.semantics import NOTHING, ActionSet, Objection, State, duration, holds, objections
from tumato_symbolic.spec import Ordering, Spec

_PAIRS_TRIED = 12
"""Pairs are looked at where at most so many actions are applicable; single actions always."""

MOST_OUTCOMES = 50_000
"""So many outcomes are looked at in one state, over all sets."""


class NearMiss(Struct, frozen=True):
    """A set of actions that is not allowed in a state, and every objection to it, in the order of section 3."""

    chosen: ActionSet
    objections: tuple[Objection, ...]


class Nearest(Struct, frozen=True):
    """The sets that come nearest to being allowed in a state; `passed_over` sets have too many outcomes to look at."""

    misses: tuple[NearMiss, ...]
    passed_over: int


def near_misses(spec: Spec, state: State, ordering: Ordering, limit: int = 3) -> Nearest:
    """The nearest sets in a state where none is allowed: at most `limit`, of those that are looked at.

    Nearest: the nominal effects at least would do; then the fewest objections, the fewest actions, the smallest
    duration.
    """
    tried, passed_over, left = [], 0, MOST_OUTCOMES
    for chosen in candidates(spec, state):
        outcomes = _most_outcomes(spec, chosen, ordering)
        if outcomes > left:
            passed_over += 1
            continue
        left -= outcomes
        found = tuple(objections(spec, state, chosen, ordering))
        wrong_end = any(each.kind == "nominal-unsafe" for each in found)
        tried.append((wrong_end, len(found), len(chosen), duration(spec, chosen), sorted(chosen), found))
    tried.sort(key=lambda entry: entry[:5])
    return Nearest(tuple(NearMiss(frozenset(chosen), found) for *_, chosen, found in tried[:limit]), passed_over)


def _most_outcomes(spec: Spec, chosen: ActionSet, ordering: Ordering) -> int:
    """A bound on how many outcomes a set has: under `any` each action may have had any of its effects, or none yet."""
    effects = [len(spec.actions[action].effects) for action in chosen]
    return prod(1 + number for number in effects) if ordering == "any" else sum(effects)


def candidates(spec: Spec, state: State) -> Iterator[ActionSet]:
    """Doing nothing, every applicable action, and every pair of them that can run together."""
    yield NOTHING
    able = applicable(spec, state)
    for number in able:
        yield frozenset((number,))
    if len(able) <= _PAIRS_TRIED:
        for first, second in combinations(able, 2):
            if not spec.actions[first].resources & spec.actions[second].resources:
                yield frozenset((first, second))


def applicable(spec: Spec, state: State) -> list[int]:
    """The actions that may start in a state."""
    return [
        number
        for number, action in enumerate(spec.actions)
        if all(holds(rule.formula, state) for rule in action.conditions)
    ]
