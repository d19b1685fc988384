"""Claims about all allowed steps, for which Z3 is asked (`docs/certificate.md`)."""

from __future__ import annotations

from tumato_symbolic.limits import Budget
from tumato_symbolic.policy.unrealizability import Conflict, NoAllowedSet, NoPlan
from tumato_symbolic.semantics import is_safe
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep
from tumato_symbolic.verify.unrealizability.conflict import check_conflict
from tumato_symbolic.verify.unrealizability.no_allowed_set import check_no_allowed_set
from tumato_symbolic.verify.unrealizability.no_plan import check_no_plan
from tumato_symbolic.verify.unrealizability.obligations import Obligations
from tumato_symbolic.verify.unrealizability.stepwise_conflict import check_stepwise_conflict


def check_allowed_steps(
    reason: NoAllowedSet | NoPlan | Conflict, spec: Spec, ordering: Ordering, budget: Budget
) -> Obligations:
    """What was proved for the claim to hold.

    Raises `FalseClaimError` where it does not hold, and `UndecidedError` where that is not known.
    """
    if isinstance(reason, Conflict) and spec.restores_stepwise and not _is_of_safe_states(reason, spec):
        return check_stepwise_conflict(reason, spec, ordering, budget)
    step = AllowedStep(spec.in_one_step, ordering, budget)
    match reason:
        case NoAllowedSet():
            checked = check_no_allowed_set(reason, step, ordering)
        case NoPlan():
            checked = check_no_plan(reason, step)
        case Conflict():
            checked = check_conflict(reason, step)
    return Obligations(checked, step.proved, step.walked)


def _is_of_safe_states(reason: Conflict, spec: Spec) -> bool:
    """Whether all that runs meet is safe: then it does not matter how safety is restored."""
    return all(is_safe(spec, choice.state) for choice in reason.choices)
