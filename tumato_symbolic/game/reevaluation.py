"""Which states fail under policies that differ little from each other."""

from __future__ import annotations

from tumato_symbolic.game.evaluation import Evaluator
from tumato_symbolic.game.fixpoints import ClosedLoop
from tumato_symbolic.symbolic import Bdd


class Reevaluator:
    """Judges one policy after the other: a target anew only where runs to it meet a state whose decision has changed.

    The policies are defined in every safe state.
    """

    def __init__(self, evaluator: Evaluator) -> None:
        self._evaluator = evaluator
        self._problem = evaluator.problem
        self._before: ClosedLoop | None = None
        self._served: dict[int, Bdd] = {}
        self._met: dict[int, Bdd] = {}

    def failing(self, found: ClosedLoop) -> Bdd:
        """The valid states that fail under a policy."""
        problem, union = self._problem, self._problem.encoding.manager.union
        if problem.spec.restores_stepwise:
            return self._evaluator.evaluate(found.policy).failing
        before, self._before = self._before, found
        for number in range(len(problem.targets)):
            if before is None or not self._stays(number, before, found):
                self._served[number] = self._evaluator.served(found, number)
        return problem.steps.valid & ~union(self._served.values())

    def _stays(self, number: int, before: ClosedLoop, after: ClosedLoop) -> bool:
        """Whether a target serves the same states under two policies."""
        if number not in self._met:
            self._met[number] = self._met_by_runs(number, before)
        met = self._met[number]
        if after.pending[number] == before.pending[number] and before.policy & met == after.policy & met:
            return True
        self._met[number] = self._problem.steps.safe
        return False

    def _met_by_runs(self, number: int, found: ClosedLoop) -> Bdd:
        """The states that decide for runs to a target; all of them, where some of its states fail.

        Failing runs are what changes are for, and a target that was met once is met again: these runs are not followed.
        """
        problem, steps, target = self._problem, self._problem.steps, self._problem.targets[number]
        if target.meaning or found.pending[number] & ~self._served[number] != problem.false:
            return steps.safe
        restored = steps.successors(steps.allowed & steps.unsafe & target.pending)
        met = front = found.pending[number] | (restored & ~target.states)
        while front != problem.false:
            problem.context.check()
            front = steps.successors(found.policy & front) & ~target.states & ~met
            met = met | front
        return met
