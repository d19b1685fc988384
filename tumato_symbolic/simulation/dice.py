"""Chance from a seed: the same on every machine and under every version of Python."""

from __future__ import annotations

from collections.abc import Sequence
from random import Random
from typing import TypeVar

_BITS = 53
"""What one number between 0 and 1 holds; Python promises that these numbers depend on the seed alone."""

Item = TypeVar("Item")


class Dice:
    """Draws that the seed determines."""

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)

    def below(self, number: int) -> int:
        """A whole number from 0 on, less than `number`."""
        bits = 0
        drawn = 0
        while bits < number.bit_length() + _BITS:
            drawn = drawn << _BITS | int(self._random.random() * 2**_BITS)
            bits += _BITS
        return drawn * number >> bits

    def one_of(self, items: Sequence[Item]) -> Item:
        """One of some items, each as likely as the others."""
        return items[self.below(len(items))]

    def shuffled(self, items: Sequence[Item]) -> list[Item]:
        """The same items, in an order that is as likely as any other."""
        rest = list(items)
        return [rest.pop(self.below(len(rest))) for _ in items]

    def happens(self, probability: float) -> bool:
        """True with this probability."""
        return self._random.random() < probability
