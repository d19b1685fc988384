"""How well a policy solves a problem: which states it serves, and in how many steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

from msgspec import Struct

from tumato_symbolic.game.fixpoints import ClosedLoop, Layers, attractor, closed_loop, preimage
from tumato_symbolic.game.problem import Problem
from tumato_symbolic.game.restoration import Restoration, Restorer
from tumato_symbolic.symbolic import Bdd, Target


class Evaluation(Struct, frozen=True):
    """What a policy achieves.

    `ranks[k]` are the exact layers of target `k` under the policy; `failing` the valid states that have no good
    decision: safe ones whose run misses its goal, and unsafe ones where no allowed set leads to it. `restoration` is
    what is decided in unsafe states, where safety may take several steps to restore.
    """

    closed_loop: ClosedLoop
    ranks: tuple[Layers, ...]
    failing: Bdd
    restoration: Restoration | None = None


def in_time(problem: Problem, ranks: Sequence[Layers]) -> list[Layers]:
    """The layers that a first successor may be in, where the plan bound leaves room for the rest of the run."""
    return [layers[: problem.spec.max_plan_length] for layers in ranks]


def winning(problem: Problem, ranks: Sequence[Layers], relation: Bdd) -> Bdd:
    """The states where some pair of `relation` leads, in time, to a state with a rank for its target."""
    manager = problem.encoding.manager
    return manager.union(
        _leading(problem, target, relation, manager.union(layers))
        for target, layers in zip(problem.targets, in_time(problem, ranks), strict=True)
        if (relation & target.pending) != problem.false
    )


def _leading(problem: Problem, target: Target, relation: Bdd, near: Bdd) -> Bdd:
    """The states where some pair of a relation that has a target leads to where it is near."""
    if not target.meaning:
        return problem.steps.predecessor(relation & target.pending, near)
    leading = relation & target.pending & problem.own(target, problem.steps.before(near))
    return problem.steps.states_of(leading)


class Evaluator:
    """Evaluates policies that are defined in every safe state; unsafe states may take any allowed set.

    Where safety may take several steps to restore, `forced` has the only pairs that its states may take, and states
    outside `required` need not reach their goals.
    """

    def __init__(self, problem: Problem, forced: Bdd | None = None, required: Bdd | None = None) -> None:
        self.problem = problem
        self._forced = problem.false if forced is None else forced
        self._required = problem.steps.valid if required is None else required
        self._restoration: ClosedLoop | None = None

    def where(self, forced: Bdd, required: Bdd | None = None) -> Evaluator:
        """The same evaluator with other pairs that are forced, and other states that are required."""
        other = Evaluator(self.problem, forced, required)
        if self.problem.spec.restores_stepwise:
            other.restorer = self.restorer
        else:
            other._restoring = self._restoring
        return other

    @cached_property
    def restorer(self) -> Restorer:
        """What restores safety where that may take several steps."""
        return Restorer(self.problem)

    @cached_property
    def _restoring(self) -> list[Callable[[Bdd], Bdd]]:
        """For every target, its pending pairs in unsafe states that lead into a set."""
        pairs = self.problem.steps.allowed & self.problem.steps.unsafe
        return [preimage(self.problem, pairs & target.pending) for target in self.problem.targets]

    def evaluate(self, policy: Bdd, ranks: tuple[Layers, ...] | None = None) -> Evaluation:
        """All that a policy achieves; `ranks` are its own, where they are known."""
        problem, union = self.problem, self.problem.encoding.manager.union
        found, steps = closed_loop(problem, policy), problem.steps
        ranks = ranks or tuple(
            attractor(problem, t.states, found.predecessor, steps.safe, None) for t in problem.targets
        )
        near = [union(layers) for layers in in_time(problem, ranks)]
        safe = union(found.first_steps(number, each) for number, each in enumerate(near))
        if problem.spec.restores_stepwise:
            restoration = self.restorer.restore(ranks, self._forced, self._required)
            return Evaluation(found, ranks, (steps.safe & ~safe) | restoration.failing, restoration)
        return Evaluation(found, ranks, steps.valid & ~(safe | union(map(self._restored, range(len(near)), near))))

    def served(self, found: ClosedLoop, number: int) -> Bdd:
        """The states that have a target, by number, and reach it under a policy, where safety is restored in one step.

        Of unsafe states those where some allowed set does.
        """
        problem, target = self.problem, self.problem.targets[number]
        layers = attractor(problem, target.states, found.predecessor, problem.steps.safe, problem.last_layer)
        near = problem.encoding.manager.union(layers)
        return found.first_steps(number, near) | self._restored(number, near)

    def serves_all(self, found: ClosedLoop, suspects: list[int]) -> bool:
        """Whether no state fails under a policy.

        Targets are tried in the order of `suspects`, a permutation of their numbers; one that fails moves to the front.
        """
        problem, steps = self.problem, self.problem.steps
        ranks: dict[int, Layers] = {}
        for place, number in enumerate(suspects):
            target, pending = problem.targets[number], found.pending[number]
            layers = attractor(problem, target.states, found.predecessor, steps.safe, problem.last_layer)
            if found.first_steps(number, problem.encoding.manager.union(layers)) != pending:
                suspects.insert(0, suspects.pop(place))
                return False
            ranks[number] = layers
        if problem.spec.restores_stepwise:
            ordered = [ranks[number] for number in range(len(problem.targets))]
            return self._still_restores(found) or self._restores(ordered)
        restored = problem.encoding.manager.union(
            self._restored(number, problem.encoding.manager.union(layers)) for number, layers in ranks.items()
        )
        return (steps.unsafe & ~restored) == problem.false

    def _restores(self, ranks: Sequence[Layers]) -> bool:
        """Whether unsafe states can be restored, given ranks of the safe ones."""
        restoration = self.restorer.restore(ranks, self._forced, self._required)
        if restoration.failing != self.problem.false:
            return False
        self._restoration = closed_loop(self.problem, restoration.policy)
        return True

    def _still_restores(self, found: ClosedLoop) -> bool:
        """Whether the decisions in unsafe states that did before do with a policy in safe states."""
        problem, before = self.problem, self._restoration
        if before is None:
            return False

        def predecessor(states: Bdd, target: Bdd) -> Bdd:
            return found.predecessor(states, target) | before.predecessor(states, target)

        for number, (target, pending) in enumerate(zip(problem.targets, before.pending, strict=True)):
            if pending == problem.false:
                continue
            layers = attractor(problem, target.states, predecessor, problem.steps.valid, problem.last_layer)
            if before.first_steps(number, problem.encoding.manager.union(layers)) != pending:
                return False
        return True

    def _restored(self, number: int, near: Bdd) -> Bdd:
        """The unsafe states where some allowed set has a target and leads into the set given for it."""
        into = self._restoring[number](near)
        return self.problem.steps.states_of(self.problem.own(self.problem.targets[number], into))
