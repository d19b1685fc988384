"""A sample of the repeated calls; `python -m tests.repeats` makes many."""

from __future__ import annotations

from itertools import count, islice

from tests.repeats.__main__ import differing
from tests.repeats.answers import is_repaired


def test_the_same_specification_has_the_same_answer() -> None:
    """Byte for byte: in one process, whatever it was asked before, in a fresh one, and on both backends."""
    seeds = list(islice(filter(is_repaired, count()), 4))
    assert differing(seeds, calls=2, processes=1) == set()
