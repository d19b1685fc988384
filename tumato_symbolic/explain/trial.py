"""Whether there is a policy for a changed specification: synthesis, within what is left of the time."""

from __future__ import annotations

from tumato_symbolic.explain.demands import Demands
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Realizable, SynthesisResult, synthesize


def trial(demands: Demands, spec: Spec) -> SynthesisResult:
    """The outcome of synthesis. Raises `LimitReachedError` when the time of the stage that asks is up."""
    context = demands.manager.context
    left = Context(Limits(context.seconds_left(), context.limits.megabytes))
    outcome = synthesize(
        spec, demands.ordering, backend=demands.manager.backend, context=left, certify=False, diagnose=False
    )
    context.check()
    return outcome


def is_realizable(demands: Demands, spec: Spec) -> bool:
    """Whether synthesis finds a policy."""
    return isinstance(trial(demands, spec), Realizable)
