"""The synthesis problem of one specification."""

from __future__ import annotations

from dataclasses import dataclass

from tumato_symbolic.limits import Context
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
    def last_layer(self) -> int | None:
        """The largest rank that a first successor may have; None without a plan bound."""
        return None if self.spec.max_plan_length is None else self.spec.max_plan_length - 1


def build_problem(spec: Spec, ordering: Ordering, backend: Backend, context: Context | None = None) -> Problem:
    """Encode a specification and compute its steps, regions and targets."""
    context = context or Context()
    context.tell("encoding states and actions")
    encoding = encode(spec, backend, context)
    with encoding.manager.within_memory():
        context.tell("finding the allowed steps")
        steps = build_steps(encoding, ordering)
        active = regions(encoding, steps.valid)
        return Problem(spec, steps, active, tuple(targets(steps, active)))
