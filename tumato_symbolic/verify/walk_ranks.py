"""From where runs reach a residual goal soon enough: by given ranks as far as they hold, otherwise layer by layer."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import cached_property

from tumato_symbolic.policy.model import Policy
from tumato_symbolic.semantics import Residual
from tumato_symbolic.verify.given import UNNEEDED, GivenRanks
from tumato_symbolic.verify.result import CertificateUse
from tumato_symbolic.verify.walk import FALSE, Function
from tumato_symbolic.verify.walk_model import Model


def at_most_one_more(one: int, other: int) -> int:
    """`one ≤ other + 1`."""
    return int(one <= other + 1)


class WalkRanks:
    """What a step must lead to: states that the policy leads to a residual goal in at most `L - 1` steps.

    Given ranks speak of safe states; those computed here of all.
    """

    def __init__(self, model: Model, policy: Policy, policy_is_safe: bool) -> None:
        self._model = model
        self._certificate = policy.certificate
        self._near: dict[Residual, Function] = {}
        self._lower_bounds: dict[Residual, bool] = {}
        self.given = GivenRanks(model.spec, policy, policy_is_safe)

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""
        return self.given.use

    def near(self, goal: Residual) -> Function:
        """Exactly these states, computed backwards from the goal."""
        if goal not in self._near:
            self._near[goal] = self._model.within(goal)
        return self._near[goal]

    def given_near(self, goal: Residual) -> Function:
        """These states, by the ranks that came with the policy."""
        bound = self._model.spec.max_plan_length
        largest = self._never if bound is None else min(bound, self._never)
        return self._model.walk.combine(operator.lt, self._given(goal), self._model.walk.constant(largest))

    def check_given(self, goals: Sequence[Residual]) -> bool:
        """Whether the certificate ranks all of `goals`, and all its ranks decrease; otherwise it is set aside."""
        given = self.given
        if given.use != UNNEEDED:
            return False
        for goal in given.roots:
            if not self._decreases(goal):
                given.reject(f"the ranks of {given.described(goal)} do not go down to it")
                return False
        missing = next((goal for goal in goals if goal not in given.roots), None)
        if missing is not None:
            given.fall_short(f"it has no ranks of {given.described(missing)}")
            return False
        given.serve()
        return True

    def near_at_least(self, goal: Residual) -> Function:
        """These states and perhaps more, by given ranks that are nowhere too large, else exactly these."""
        given = self.given
        if goal not in given.roots:
            if given.roots:
                given.fall_short(f"it has no ranks of {given.described(goal)}")
            return self.near(goal)
        if goal not in self._lower_bounds:
            self._lower_bounds[goal] = self._is_lower_bound(goal)
        if not self._lower_bounds[goal]:
            self.not_exact(goal)
            return self.near(goal)
        given.serve()
        return self.given_near(goal)

    def not_exact(self, goal: Residual) -> None:
        """Given ranks did not serve, for they are too small or too large."""
        self.given.fall_short(f"its ranks of {self.given.described(goal)} are not the lengths of the runs")

    # Given ranks `N`: a number for every state, `never` where there is none

    @cached_property
    def _never(self) -> int:
        """More than one above every rank."""
        leaves = self._certificate.ranks.leaves if self._certificate is not None else ()
        return max((leaf for leaf in leaves if leaf is not None), default=0) + 2

    @cached_property
    def _taken(self) -> list[Function]:
        """The functions of the certificate, by reference."""
        if self._certificate is None:
            return []
        return self._model.walk.taken(self._certificate.ranks, lambda rank: self._never if rank is None else rank)

    def _given(self, goal: Residual) -> Function:
        return self._taken[self.given.roots[goal]]

    def _decreases(self, goal: Residual) -> bool:
        """`N = 0` only where the goal holds, and from `N = j > 0` a step to a safe state with a smaller rank."""
        model, walk = self._model, self._model.walk
        here = self._given(goal)
        after = model.next(here)
        known = walk.combine(operator.lt, here, walk.constant(self._never))
        at_goal = walk.combine(operator.eq, here, walk.constant(0))
        goes_down = walk.all_of((model.acting, self._safe_after, walk.combine(operator.lt, after, here)))
        right = walk.select(at_goal, (goes_down, model.reached(goal)))
        return walk.without(walk.all_of((model.safe, known)), right) == FALSE

    def _is_lower_bound(self, goal: Residual) -> bool:
        """`N = 0` where the goal holds, and nowhere more than one above the next state's, which is safe."""
        model, walk = self._model, self._model.walk
        here = self._given(goal)
        after = model.next(here)
        follows = walk.all_of((self._safe_after, walk.combine(at_most_one_more, here, after)))
        at_goal = walk.combine(operator.eq, here, walk.constant(0))
        wrong = walk.select(model.reached(goal), (walk.without(model.acting, follows), walk.negation(at_goal)))
        return walk.all_of((model.safe, wrong)) == FALSE

    @cached_property
    def _safe_after(self) -> Function:
        """`δ(s, π(s)) ∈ S`, where the policy acts."""
        return self._model.next(self._model.safe)
