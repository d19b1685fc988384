"""Specifications without a plan behind them: the generator of the property tests, with larger profiles."""

from __future__ import annotations

from msgspec.structs import replace

from tests.generate import random_text
from tests.profiles import INTERACTING

LARGE = replace(
    INTERACTING,
    variables=(6, 8),
    values=(2, 4),
    states=(1500, 10000),
    actions=(10, 16),
    resources=(1, 3),
    owns=0.7,
    helpers=0.6,
    goals=(2, 5),
)


def arbitrary(seed: int, realizable: bool) -> str:
    """The specification of a seed; the numbers of seeds with a policy, and of those without, are found by search."""
    return random_text(SEEDS[seed][0 if realizable else 1], LARGE)


SEEDS: dict[int, tuple[int, int]] = {1: (64, 0)}
"""By size: a seed whose specification is realizable, and one whose specification is not."""
