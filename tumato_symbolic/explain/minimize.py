"""Inclusion-minimal parts of a set for which a monotone question is answered yes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

Item = TypeVar("Item")


def minimal(items: Sequence[Item], enough: Callable[[frozenset[Item]], bool]) -> frozenset[Item]:
    """An inclusion-minimal subset of `items` that is enough; all of them must be.

    `enough` must be monotone. Earlier items are preferred. Divide and conquer (QuickXplain): about
    `k log(n / k)` questions for `k` items out of `n`.
    """
    return frozenset() if enough(frozenset()) else _minimal(frozenset(), False, list(items), enough)


def _minimal(
    base: frozenset[Item], grown: bool, items: list[Item], enough: Callable[[frozenset[Item]], bool]
) -> frozenset[Item]:
    """What `base` needs of `items`; together they are enough. `grown`: whether `base` alone may be."""
    if grown and enough(base):
        return frozenset()
    if len(items) == 1:
        return frozenset(items)
    half = len(items) // 2
    first, second = items[:half], items[half:]
    later = _minimal(base | frozenset(first), bool(first), second, enough)
    sooner = _minimal(base | later, bool(later), first, enough)
    return sooner | later
