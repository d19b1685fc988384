"""The synthesis problem of one specification, and how well a policy solves it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import (
    NO_LIMITS,
    Backend,
    Bdd,
    Encoding,
    Limits,
    Regions,
    Steps,
    Target,
    build_steps,
    encode,
    regions,
    targets,
)


@dataclass(frozen=True)
class Problem:
    """Steps, regions and targets.

    Policies are relations between *safe* states and sets of actions, functional where they are defined: no nominal
    run enters an unsafe state after its start, so decisions in unsafe states serve nobody else and come last.
    """

    spec: Spec
    steps: Steps
    regions: Regions
    targets: tuple[Target, ...]

    @property
    def encoding(self) -> Encoding:
        """The bits of the specification."""
        return self.steps.encoding

    @property
    def false(self) -> Bdd:
        """The empty set."""
        return self.encoding.manager.false

    @property
    def last_layer(self) -> int | None:
        """The largest rank that a first successor may have; None without a plan bound."""
        return None if self.spec.max_plan_length is None else self.spec.max_plan_length - 1


def pose(spec: Spec, ordering: Ordering, backend: Backend, limits: Limits = NO_LIMITS) -> Problem:
    """Encode a specification and compute its steps, regions and targets."""
    encoding = encode(spec, backend, limits)
    with encoding.manager.within_memory():
        steps = build_steps(encoding, ordering)
        active = regions(encoding, steps.valid)
        return Problem(spec, steps, active, tuple(targets(steps, active)))


Layers = list[Bdd]
"""Disjoint sets of safe states: in layer `j` are those that reach the target in `j` steps and not earlier."""


Predecessor: TypeAlias = Callable[[Bdd, Bdd], Bdd]
"""Those states of the first set from where one step leads into the second."""


def by_any_step(problem: Problem, relation: Bdd) -> Predecessor:
    """The predecessor when any pair of a relation may be taken."""
    return lambda states, target: states & problem.steps.predecessor(relation & states, target)


MOST_MOVES = 100
"""A relation whose sets do more different things is taken as a whole."""


def leading(problem: Problem, relation: Bdd) -> Callable[[Bdd], Bdd]:
    """Those pairs of a relation that lead into a set of states.

    Where the pairs do few different things they are taken move by move: the predecessor under one is a cofactor.
    """
    steps, manager = problem.steps, problem.encoding.manager
    exclusive = max(map(len, problem.encoding.nominal_moves), default=0)
    moves = steps.moves(relation, max(MOST_MOVES, exclusive), keep_sets=True)
    if moves is None:
        return lambda target: relation & steps.before(target)
    cofactors = [(problem.encoding.assignment_bits(effect), pairs) for effect, pairs in moves.items()]
    return lambda target: manager.union(pairs & manager.cofactor(target, effect) for effect, pairs in cofactors)


def by_policy(problem: Problem, policy: Bdd) -> Predecessor:
    """The predecessor under a policy.

    A policy that does few different things is taken move by move: the predecessor under each is a cofactor. Otherwise
    it is a composition with the policy, which is a function.
    """
    steps, manager = problem.steps, problem.encoding.manager
    moves = steps.moves(policy, MOST_MOVES)
    if moves is not None:
        cofactors = [(problem.encoding.assignment_bits(effect), acting) for effect, acting in moves.items()]
        return lambda states, target: (
            states & manager.union(acting & manager.cofactor(target, effect) for effect, acting in cofactors)
        )
    following, decided = steps.next_state(policy), steps.states_of(policy)
    return lambda states, target: states & decided & manager.compose(target, following)


def attractor(problem: Problem, target: Bdd, predecessor: Predecessor, within: Bdd, limit: int | None) -> Layers:
    """Backward layers of `target`: `μ Z. target ∪ (within ∩ pre(Z))`, at most `limit` steps deep.

    With a policy's predecessor these are the exact ranks of its runs; with that of all allowed pairs, the distances.
    """
    layers = [target]
    left = within & ~target
    while layers[-1] != problem.false and (limit is None or len(layers) <= limit):
        layer = predecessor(left, layers[-1])
        layers.append(layer)
        left = left & ~layer
    return layers


@dataclass(frozen=True)
class Evaluation:
    """What a policy achieves.

    `ranks[k]` are the exact layers of target `k` under the policy; `failing` the valid states that have no good
    decision: safe ones whose run misses what they owe, and unsafe ones where no allowed set serves.
    """

    ranks: tuple[Layers, ...]
    failing: Bdd


def evaluate(problem: Problem, policy: Bdd) -> Evaluation:
    """Judge a policy that is defined in every safe state; unsafe states may take any allowed set."""
    steps, step = problem.steps, by_policy(problem, policy)
    ranks = tuple(attractor(problem, target.states, step, steps.safe, None) for target in problem.targets)
    return Evaluation(ranks, steps.valid & ~served(problem, ranks, policy | (steps.allowed & steps.unsafe)))


def in_time(problem: Problem, ranks: Sequence[Layers]) -> list[Layers]:
    """The layers that a first successor may be in, where the plan bound leaves room for the rest of the run."""
    return [layers[: problem.spec.max_plan_length] for layers in ranks]


def served(problem: Problem, ranks: Sequence[Layers], relation: Bdd) -> Bdd:
    """The states where some pair of `relation` leads, in time, to a state with a rank for the target that it owes."""
    manager = problem.encoding.manager
    return manager.union(
        problem.steps.predecessor(relation & target.owed, manager.union(layers))
        for target, layers in zip(problem.targets, in_time(problem, ranks), strict=True)
        if (relation & target.owed) != problem.false
    )


def serves_all(problem: Problem, policy: Bdd, suspects: list[int]) -> bool:
    """Whether no state fails under a policy that is defined in every safe state.

    Targets are tried in the order of `suspects`, a permutation of their numbers; one that fails moves to the front.
    """
    steps, manager = problem.steps, problem.encoding.manager
    restored, step = problem.false, by_policy(problem, policy)
    for place, number in enumerate(suspects):
        target = problem.targets[number]
        layers = attractor(problem, target.states, step, steps.safe, problem.last_layer)
        reached = steps.before(manager.union(layers)) & target.owed
        if (policy & target.owed & ~reached) != problem.false:
            suspects.insert(0, suspects.pop(place))
            return False
        restored = restored | steps.states_of(reached & steps.unsafe)
    return (steps.unsafe & ~restored) == problem.false
