"""Lower bounds of how many allowed steps a goal is away (`docs/certificate.md`)."""

from __future__ import annotations

import math

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import State
from tumato_symbolic.verify.by_z3.encoding import Place, diagram_terms
from tumato_symbolic.verify.by_z3.step_counts import StepCounts
from tumato_symbolic.verify.by_z3.terms import Context, Number, Term
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError


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
        self._largest = max(finite, default=0) if bound is None else bound

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


class DistanceTerms(Distances):
    """The same as terms of Z3."""

    def __init__(self, diagram: Diagram[int | None], bound: int | None, context: Context) -> None:
        super().__init__(diagram, bound)
        self._counts = StepCounts(self._largest, context)

    def count(self, root: Reference, place: Place) -> Number:
        """`D` of a place; never where it is infinite."""

        def code(leaf: int | None) -> Number:
            far = self._cut_off(leaf)
            return self._counts.code(None if far == math.inf else int(far))

        (term,) = diagram_terms(self._diagram, [root], place, code)
        return term

    def drops(self, here: Number, after: Number) -> Term:
        """The distance gets smaller by more than one."""
        return self._counts.exceeds_by_two(here, after)
