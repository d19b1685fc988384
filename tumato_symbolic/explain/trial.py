"""Whether there is a policy for a changed specification: synthesis, within what is left of the time."""

from __future__ import annotations

from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Realizable, SynthesisResult, synthesize


def trial(requirements: Requirements, spec: Spec) -> SynthesisResult:
    """The outcome of synthesis. Raises `LimitReachedError` when the time of the stage that asks is up."""
    context = requirements.manager.context
    left = Context(Limits(context.seconds_left(), context.limits.megabytes))
    outcome = synthesize(
        spec, requirements.ordering, backend=requirements.manager.backend, context=left, certify=False, diagnose=False
    )
    context.check()
    return outcome


def is_realizable(requirements: Requirements, spec: Spec) -> bool:
    """Whether synthesis finds a policy."""
    return isinstance(trial(requirements, spec), Realizable)
