"""Where ranks come from: the policy's certificate as long as it holds, otherwise the runs themselves."""

from __future__ import annotations

from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import Residual, State
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.outcomes import objections_to
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.rank_terms import RankFunction, RankProof
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.claimed_ranks import UNNEEDED, ClaimedRanks
from tumato_symbolic.verify.decisions import Decisions, Ranks


class RankSource(ClaimedRanks):
    """The ranks of one policy; `use` tells what became of its certificate."""

    def __init__(self, problem: PolicyProblem, policy: Policy, ordering: Ordering, policy_is_safe: bool) -> None:
        super().__init__(problem.spec, policy, lambda: policy_is_safe)
        self._problem = problem
        self._ordering = ordering
        self._certificate = policy.certificate
        self.decisions = Decisions(problem.spec, policy)
        self.ranks = Ranks(problem.spec, self.decisions)
        self._recomputed: dict[Residual, RankFunction] = {}

    def claimed(self, goal: Residual) -> RankFunction | None:
        """The ranks that came with the policy, unless they were set aside."""
        if self._certificate is None or goal not in self.roots:
            return None
        return RankFunction(goal, self._certificate.ranks, self.roots[goal], claimed=True, of_unsafe=self.covers_unsafe)

    def has_pending_goal(self, state: State) -> bool:
        """Whether the decision for `state` leaves a goal to be met: those that are not allowed are refuted already."""
        return self._policy_is_safe() or not objections_to(
            self._problem.spec, state, self.decisions[state], self._ordering, self._problem.deadline()
        )

    def check_claimed(self) -> bool:
        """Whether there is a certificate all of whose ranks decrease; a false one is set aside.

        Raises `UndecidedError`.
        """
        if self.use != UNNEEDED and not (self.covers_unsafe and self.stands):
            return False
        for goal in self.roots:
            ranks = self.claimed(goal)
            if ranks is not None and not RankProof(self._problem, ranks).decreases():
                self.reject(f"the ranks of {self.described(goal)} do not decrease to it")
                return False
        return True

    def recomputed(self, goal: Residual) -> RankFunction:
        """The ranks that the runs have. Needs a policy small enough to be followed."""
        if goal not in self._recomputed:
            diagram, root = self.ranks.diagram(goal)
            self._recomputed[goal] = RankFunction(goal, diagram, root, claimed=False)
        return self._recomputed[goal]

    def lower_bound(self, goal: Residual) -> RankFunction:
        """Ranks proved to be nowhere larger than the run is long. Raises `UndecidedError`."""
        claimed = self.claimed(goal)
        if claimed is not None:
            if RankProof(self._problem, claimed).is_lower_bound():
                self.serve()
                return claimed
        elif self.roots:
            self.lacks(goal)
        return self.exact(goal)

    def exact(self, goal: Residual) -> RankFunction:
        """The lengths of the runs themselves, proved as a lower bound. Raises `UndecidedError`."""
        if goal in self.roots:
            self.inexact(goal)
        if self.decisions.rows is None:
            why = f"there are no exact ranks of {self.described(goal)}, and too many states to follow all runs"
            raise UndecidedError("no cheaper allowed set serves as well", why)
        ranks = self.recomputed(goal)
        if not RankProof(self._problem, ranks).is_lower_bound():
            raise RuntimeError(f"the lengths of runs are no ranks of {goal}")
        return ranks
