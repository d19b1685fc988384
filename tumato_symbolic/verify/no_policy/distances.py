"""Lower bounds of how many allowed steps a goal is away (`docs/certificate.md`)."""

from __future__ import annotations

import math

import z3

from tumato_symbolic.policy.diagram import Diagram, Reference
from tumato_symbolic.semantics import State
from tumato_symbolic.verify.by_z3.encoding import Place, diagram_terms
from tumato_symbolic.verify.by_z3.terms import Number, Term, conjunction
from tumato_symbolic.verify.no_policy.allowed_step import FalseClaimError


class Distances:
    """`D` of every goal. None is infinite; with a plan bound `L`, None and everything from `L` on is `L`.

    Raises `FalseClaimError` where a distance is negative.
    """

    def __init__(self, diagram: Diagram[int | None], bound: int | None) -> None:
        self._diagram = diagram
        self._bound = bound
        finite = [leaf for leaf in diagram.leaves if leaf is not None]
        if any(leaf < 0 for leaf in finite):
            raise FalseClaimError("a distance is negative")
        most = max((self._cut_off(leaf) for leaf in finite), default=0)
        self._never = int(most) + 2 if bound is None else bound
        self._width = (self._never + 1).bit_length()

    def _cut_off(self, leaf: int | None) -> float:
        limit = math.inf if self._bound is None else self._bound
        return limit if leaf is None else min(leaf, limit)

    def of(self, root: Reference, state: State) -> float:
        """`D` of a safe state."""
        return self._cut_off(self._diagram.evaluate(root, state))

    def near(self, root: Reference, state: State, steps: int) -> bool:
        """Whether the goal may still be reached in time from a state that is met after so many steps."""
        far = self.of(root, state)
        return far < math.inf if self._bound is None else steps + far <= self._bound

    def number(self, root: Reference, place: Place) -> Number:
        """`D` of a place; infinite is larger by more than one than every finite distance."""
        codes = {
            leaf: z3.BitVecVal(int(min(self._cut_off(leaf), self._never)), self._width) for leaf in self._diagram.leaves
        }
        (term,) = diagram_terms(self._diagram, [root], place, codes.__getitem__)
        return term

    def drops(self, here: Number, after: Number) -> Term:
        """The distance gets smaller by more than one."""
        return conjunction((after != self._never, z3.UGT(here, after + 1)))
