"""From where runs reach a residual goal soon enough: by claimed ranks as far as they hold, otherwise layer by layer."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from functools import cached_property

from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import Residual
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.by_diagrams.goals import Aim, WalkGoals
from tumato_symbolic.verify.by_diagrams.walk import UNASKED
from tumato_symbolic.verify.claimed_ranks import UNNEEDED, ClaimedRanks


def one_less_at_least(after: int, here: int) -> bool:
    """`after ≥ here - 1`."""
    return after >= here - 1


class WalkRanks(ClaimedRanks):
    """What a step must lead to: states that the policy leads to a residual goal in at most `L - 1` steps.

    Claimed ranks speak of safe states, and of all valid ones where efforts came with them; those computed here of all.
    """

    def __init__(self, model: ClosedLoop, goals: WalkGoals, policy: Policy, policy_is_safe: Callable[[], bool]) -> None:
        super().__init__(model.spec, policy, policy_is_safe)
        self._model = model
        self._goals = goals
        self._certificate = policy.certificate
        self._near: dict[Aim, Function] = {}
        self._lower_bounds: dict[Residual, bool] = {}

    def aims(self, region: Function, executed: Sequence[Function]) -> Sequence[tuple[Aim, Function]]:
        """`region` by what its states are to come near to when `executed` is the first set.

        Where there may be many residual goals, and no ranks that tell of each, it is one thing for all.
        """
        if self._goals.are_many and not self.roots:
            return [(None, region)] if region != FALSE else []
        return self._goals.residuals(region, executed)

    def near(self, goal: Aim) -> Function:
        """Exactly these states, computed backwards from the goal."""
        if goal not in self._near:
            self._near[goal] = self._goals.within(goal)
        return self._near[goal]

    def claimed_near(self, goal: Residual) -> Function:
        """These states, by the ranks that came with the policy."""
        bound = self._model.spec.max_plan_length
        largest = self._never if bound is None else min(bound, self._never)
        walk = self._model.walk
        near = walk.apply(operator.lt, self._claimed(goal), walk.constant(largest))
        return walk.all_of((near, self._covered)) if self._model.spec.restores_stepwise else near

    def claimed_far(self, goal: Residual) -> Function:
        """The states with a claimed rank that is a number, and too large."""
        walk = self._model.walk
        ranked = walk.apply(operator.lt, self._claimed(goal), walk.constant(self._never))
        if self._model.spec.restores_stepwise:
            ranked = walk.all_of((ranked, self._covered))
        return walk.without(ranked, self.claimed_near(goal))

    def prepare(self) -> None:
        """Compute what claimed ranks have in common, whatever their goals."""
        if self.roots:
            self._imported, self._covered_after, self._model.cases  # noqa: B018 - cached

    def check_claimed(self, decreases: Callable[[Residual], bool]) -> bool:
        """Whether there is a certificate all of whose ranks decrease; a false one is set aside."""
        if not self.stands or (self.use != UNNEEDED and not self._model.spec.restores_stepwise):
            return False
        for goal in self.roots:
            if not decreases(goal):
                self.reject(f"the ranks of {self.described(goal)} do not decrease to it")
                return False
        return True

    def near_at_least(self, goal: Aim) -> Function:
        """These states and perhaps more, by claimed ranks that are nowhere too large, else exactly these."""
        if goal is None:
            return self.near(goal)
        if goal not in self.roots:
            if self.roots:
                self.lacks(goal)
            return self.near(goal)
        if self._model.spec.restores_stepwise and not self.covers_unsafe:
            return self.near(goal)
        if goal not in self._lower_bounds:
            self._lower_bounds[goal] = self._is_lower_bound(goal)
        if not self._lower_bounds[goal]:
            self.inexact(goal)
            return self.near(goal)
        self.serve()
        return self.claimed_near(goal)

    # Claimed ranks `N`: a number for every state, `never` where there is none

    @cached_property
    def _never(self) -> int:
        """More than one above every rank."""
        leaves = self._certificate.ranks.leaves if self._certificate is not None else ()
        return max((leaf for leaf in leaves if leaf is not None), default=0) + 2

    @cached_property
    def _imported(self) -> list[Function]:
        """The functions of the certificate, by reference."""
        if self._certificate is None:
            return []
        return self._model.walk.import_diagram(
            self._certificate.ranks, lambda rank: self._never if rank is None else rank
        )

    def _claimed(self, goal: Residual) -> Function:
        return self._imported[self.roots[goal]]

    def decreases(self, goal: Residual) -> bool:
        """`N = 0` only where the goal is met, and from `N = j > 0` a step to a state with a smaller rank."""
        model, walk = self._model, self._model.walk
        here, never = self._claimed(goal), walk.constant(self._never)
        known = walk.all_of((self._covered, walk.apply(operator.lt, here, never)))
        moves = walk.all_of((known, walk.apply(operator.ne, here, walk.constant(0))))
        if walk.without(known, walk.any_of((moves, self._goals.reached(goal)))) != FALSE:
            return False
        if walk.without(moves, walk.all_of((model.acting, self._covered_after))) != FALSE:
            return False
        return model.steps_hold(operator.lt, here, walk.select(moves, (walk.constant(UNASKED), here)))

    def _is_lower_bound(self, goal: Residual) -> bool:
        """`N = 0` where the goal is met, and nowhere more than one above the next state's, which has a rank."""
        model, walk = self._model, self._model.walk
        here, reached = self._claimed(goal), self._goals.reached(goal)
        at_goal = walk.apply(operator.eq, here, walk.constant(0))
        moves = walk.without(self._covered, reached)
        if walk.without(self._covered, walk.any_of((moves, at_goal))) != FALSE:
            return False
        if walk.without(walk.all_of((moves, model.acting)), self._covered_after) != FALSE:
            return False
        return model.steps_hold(one_less_at_least, here, walk.select(moves, (walk.constant(UNASKED), here)))

    @property
    def _covered(self) -> Function:
        """Where a number claims something: in `S`; where efforts came with the ranks, in `V`."""
        return self._model.valid if self.covers_unsafe else self._model.safe

    @property
    def _covered_after(self) -> Function:
        """`δ(s, π(s))` is such a state, where the policy acts."""
        return self._model.next(self._covered)
