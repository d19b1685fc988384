"""The synthesis problem of one specification, and how well a policy solves it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import (
    Backend,
    Bdd,
    Encoding,
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


def pose(spec: Spec, ordering: Ordering, backend: Backend) -> Problem:
    """Encode a specification and compute its steps, regions and targets."""
    steps = build_steps(encode(spec, backend), ordering)
    active = regions(steps.encoding, steps.valid)
    return Problem(spec, steps, active, tuple(targets(steps, active)))


Layers = list[Bdd]
"""Disjoint sets of safe states: in layer `j` are those that reach the target in `j` steps and not earlier."""


def attractor(problem: Problem, target: Bdd, relation: Bdd, within: Bdd, limit: int | None) -> Layers:
    """Backward layers of `target`: `μ Z. target ∪ (within ∩ pre(relation, Z))`, at most `limit` steps deep.

    With a policy for `relation` these are the exact ranks of its runs; with all allowed pairs, the distances.
    """
    layers = [target]
    left = within & ~target
    while layers[-1] != problem.false and (limit is None or len(layers) <= limit):
        layer = left & problem.steps.predecessor(relation & left, layers[-1])
        layers.append(layer)
        left = left & ~layer
    return layers


@dataclass(frozen=True)
class Evaluation:
    """What a policy achieves.

    `ranks[k]` are the layers of target `k` under the policy, within the plan bound; `failing` the valid states that
    have no good decision: safe ones whose run misses what they owe, and unsafe ones where no allowed set serves.
    """

    ranks: tuple[Layers, ...]
    failing: Bdd


def evaluate(problem: Problem, policy: Bdd) -> Evaluation:
    """Judge a policy that is defined in every safe state; unsafe states may take any allowed set."""
    steps = problem.steps
    ranks = tuple(
        attractor(problem, target.states, policy, steps.safe, problem.last_layer) for target in problem.targets
    )
    return Evaluation(ranks, steps.valid & ~served(problem, ranks, policy | (steps.allowed & steps.unsafe)))


def served(problem: Problem, ranks: Sequence[Layers], relation: Bdd) -> Bdd:
    """The states where some pair of `relation` leads to a state that has a rank for the target which the pair owes."""
    manager = problem.encoding.manager
    return manager.union(
        problem.steps.predecessor(relation & target.owed, manager.union(layers))
        for target, layers in zip(problem.targets, ranks, strict=True)
        if (relation & target.owed) != problem.false
    )
