"""How deep Python may recurse for a diagram, however many variables there are."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

_FRAMES = 8
"""Calls that are open at the same time for one level, at most."""


@contextmanager
def room_for(levels: int) -> Iterator[None]:
    """Raise the recursion limit for so many nested calls.

    Plain calls of Python functions use no stack of the machine; those through `map`, `sum`, `all` or `f(*x)` do.
    """
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(before + _FRAMES * levels)
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
