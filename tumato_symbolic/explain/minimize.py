"""Inclusion-minimal parts of a set for which a monotone question is answered yes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

Item = TypeVar("Item")


def minimal(items: Sequence[Item], enough: Callable[[frozenset[Item]], bool]) -> frozenset[Item]:
    """An inclusion-minimal subset of `items` that is enough; all of them must be.

    `enough` must be monotone. Earlier items are preferred. The items are given up from the last one on, as many at once
    as can be: for `k` items out of `n`, about `k log(n / k)` questions, and about `n` where nearly all are needed.
    """
    needed: frozenset[Item] = frozenset()
    left, guess = list(items), len(items)
    while left:
        spare = _spare(needed, left, guess, enough)
        left = left[: len(left) - spare]
        if left:
            needed |= {left.pop()}
        guess = max(1, 2 * spare)
    return needed


def _spare(needed: frozenset[Item], left: Sequence[Item], guess: int, enough: Callable[[frozenset[Item]], bool]) -> int:
    """How many can go from the end of `left` so that the others are enough together with `needed`.

    Doubles what is tried from `guess` on, then halves what is open.
    """
    low, high, tried = 0, len(left) + 1, guess
    while high - low > 1:
        tried = min(max(tried, low + 1), high - 1)
        if enough(needed.union(left[: len(left) - tried])):
            low, tried = tried, 2 * tried if high > len(left) else (tried + high) // 2
        else:
            high, tried = tried, (low + tried) // 2
    return low
