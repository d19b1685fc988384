"""Efforts, and infinite ones, as bit vectors (`docs/semantics.md`, section 9)."""

from __future__ import annotations

from collections.abc import Sequence

import z3
from msgspec import Struct

from tumato_symbolic.semantics import Effort
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_z3.terms import Context, Number, Term


class EffortCodes(Struct, frozen=True):
    """Durations above steps, so that codes add and compare as efforts do; an infinite effort has a bit of its own.

    One step more than `largest`, by component, does not overflow.
    """

    spec: Spec
    largest: Effort
    context: Context

    @property
    def _step_bits(self) -> int:
        return (self.largest[1] + 1).bit_length()

    @property
    def _finite_bits(self) -> int:
        longest = sum(action.duration for action in self.spec.actions)
        return (self.largest[0] + longest).bit_length() + self._step_bits

    @property
    def width(self) -> int:
        """How many bits a code has."""
        return self._finite_bits + 1

    def code(self, effort: Effort | None) -> Number:
        """An effort; None is infinite."""
        if effort is None:
            return self._number(1 << self._finite_bits)
        return self._number((effort[0] << self._step_bits) + effort[1])

    def step(self, executed: Sequence[Term]) -> Number:
        """The duration of a set of actions, and one step."""
        total, zero = self.code((0, 1)), self._number(0)
        for term, action in zip(executed, self.spec.actions, strict=True):
            if action.duration and term is not False:
                amount = self.code((action.duration, 0))
                total = total + (amount if term is True else z3.If(term, amount, zero))
        return total

    def is_finite(self, code: Number) -> Term:
        """The effort is not infinite."""
        return z3.Extract(self.width - 1, self.width - 1, code) == 0

    def is_one_step(self, code: Number) -> Term:
        """A finite effort is one of one step."""
        return z3.Extract(self._step_bits - 1, 0, code) == 1

    def _number(self, value: int) -> Number:
        return z3.BitVecVal(value, self.width, self.context)
