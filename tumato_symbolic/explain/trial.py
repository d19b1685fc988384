"""Whether there is a policy for a changed specification: synthesis, within what is left of the time."""

from __future__ import annotations

from tumato_symbolic.explain.conditions import Conditions
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Outcome, Realizable, synthesize


def trial(conditions: Conditions, spec: Spec) -> Outcome:
    """The outcome of synthesis. Raises `LimitReachedError` when the time of the stage that asks is up."""
    context = conditions.manager.context
    left = Context(Limits(context.seconds_left(), context.limits.megabytes))
    outcome = synthesize(
        spec, conditions.ordering, backend=conditions.manager.backend, context=left, certify=False, diagnose=False
    )
    context.check()
    return outcome


def is_realizable(conditions: Conditions, spec: Spec) -> bool:
    """Whether synthesis finds a policy."""
    return isinstance(trial(conditions, spec), Realizable)
