"""Numbers of steps, and *never*, as bit vectors."""

from __future__ import annotations

import z3
from msgspec import Struct

from tumato_symbolic.verify.by_z3.terms import Context, Number, Term, conjunction, negation


class StepCounts(Struct, frozen=True):
    """The numbers from 0 to `largest`, and never, which has a bit of its own.

    So never equals no number, not even one more than the largest, and one more than any of them does not overflow.
    """

    largest: int
    context: Context

    @property
    def width(self) -> int:
        """How many bits a count has."""
        return (self.largest + 1).bit_length() + 1

    @property
    def _never(self) -> int:
        return 1 << (self.width - 1)

    def code(self, steps: int | None) -> Number:
        """A number, or never (None)."""
        return z3.BitVecVal(self._never if steps is None else steps, self.width, self.context)

    def is_number(self, count: Number) -> Term:
        """The count is not never."""
        return count != self._never

    def exceeds_by_two(self, one: Number, other: Number) -> Term:
        """`one > other + 1`, with never as infinity."""
        return conjunction((self.is_number(other), negation(z3.ULE(one, other + 1))))
