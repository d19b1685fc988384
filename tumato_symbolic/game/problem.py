"""The synthesis problem of one specification: steps, regions and targets."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.limits import Context
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import (
    Backend,
    Bdd,
    Encoding,
    Regions,
    Steps,
    Target,
    TooManyNodesError,
    build_steps,
    encode,
    few_steps,
    regions_apart,
    targets,
    together,
)


class Problem(Struct, frozen=True):
    """Steps, regions and targets; no regions, and a single target, where there are many residual goals.

    Policies are relations between *safe* states and sets of actions, functional where they are defined: no nominal
    run enters an unsafe state after its start, so decisions in unsafe states matter to no other state and come last.
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
    def context(self) -> Context:
        """The limits of the work, and whom it tells what it does."""
        return self.encoding.manager.context

    @property
    def false(self) -> Bdd:
        """The empty set."""
        return self.encoding.manager.false

    @property
    def goals_are_many(self) -> bool:
        """Whether one target stands for all residual goals."""
        return any(target.meaning for target in self.targets)

    def own(self, target: Target, pairs: Bdd) -> Bdd:
        """The pairs that are in a set with the goal bits of their own residual goal, where a target speaks of these."""
        return self.encoding.manager.compose(pairs, target.meaning)

    @property
    def last_layer(self) -> int | None:
        """The largest rank that a first successor may have; None without a plan bound."""
        return None if self.spec.max_plan_length is None else self.spec.max_plan_length - 1


def build_problem(
    spec: Spec, ordering: Ordering, backend: Backend, context: Context | None = None, *, most: int | None = None
) -> Problem:
    """Encode a specification and compute its steps, regions and targets.

    Where the allowed sets make a diagram of more nodes than `most`, it is the problem with one action at a time.
    """
    context = context or Context()
    context.tell("encoding states and actions")
    encoding = encode(spec, backend, context)
    with encoding.manager.within_memory():
        context.tell("finding the allowed steps")
        return with_goals(_steps(encoding, ordering, most))


def _steps(encoding: Encoding, ordering: Ordering, most: int | None) -> Steps:
    if most is None or encoding.spec.restores_stepwise:
        return build_steps(encoding, encoding.spec, ordering)
    for build in (build_steps, few_steps):
        try:
            with encoding.manager.at_most(most):
                return build(encoding, encoding.spec, ordering)
        except TooManyNodesError:
            continue
    return build_steps(encoding, encoding.spec, ordering)


def with_all_sets(problem: Problem) -> Problem:
    """The problem with all allowed sets of actions, however many nodes they take."""
    problem.context.tell("finding the allowed steps of several actions")
    return with_goals(build_steps(problem.encoding, problem.spec, problem.steps.ordering))


def with_goals(steps: Steps) -> Problem:
    """The problem with these steps."""
    spec, active = steps.encoding.spec, regions_apart(steps.encoding, steps.valid)
    if active is None:
        return Problem(spec, steps, {}, (together(steps),))
    return Problem(spec, steps, active, tuple(targets(steps, active)))
