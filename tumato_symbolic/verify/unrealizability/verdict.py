"""The verdict on a certificate that a specification has no policy (`docs/certificate.md`)."""

from __future__ import annotations

from msgspec.structs import replace

from tumato_symbolic.limits import Budget, Context, LimitReachedError, need_z3
from tumato_symbolic.policy.unrealizability import (
    Conflict,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Reason,
    Unrealizability,
    bind,
)
from tumato_symbolic.semantics import is_safe, is_start, is_valid, state_text
from tumato_symbolic.spec import Ordering, Spec, digest
from tumato_symbolic.spec.support import require_one_step
from tumato_symbolic.verify.result import UnrealizabilityKind, UnrealizabilityVerdict
from tumato_symbolic.verify.undecided import OBLIGATION_BUDGET, UndecidedError
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.no_part import check_no_part, conflicts_of
from tumato_symbolic.verify.unrealizability.no_restoration import check_no_restoration
from tumato_symbolic.verify.unrealizability.obligations import Obligations

_WRITES_FIRST = (
    "it is for the effect ordering any, but the specification writes first, under which more sets are allowed"
)


def verify_unrealizable(
    certificate: Unrealizability,
    spec: Spec,
    *,
    ordering: Ordering | None = None,
    timeout: float | None = OBLIGATION_BUDGET,
    context: Context | None = None,
) -> UnrealizabilityVerdict:
    """Prove by `certificate` that `spec` has no policy, or refute the certificate with the check that it fails.

    Nothing in the certificate is trusted. `ordering` overrules the effect ordering that it records. `timeout` limits
    the time, in seconds, of each obligation (None: no limit); what is not proved in time is undecided. `context`
    limits the whole, and is told what is done.

    *Refuted* says that the certificate is no proof, not that there is a policy. Raises `UserError` when the names of
    the certificate do not fit the specification.
    """
    context = context or Context()
    reason = bind(certificate, spec).reason
    if isinstance(reason, NoAllowedSet | NoPlan) and not is_safe(spec, reason.state):
        require_one_step(spec, "verify")
    used: Ordering = ordering or certificate.ordering
    found = UnrealizabilityVerdict(
        "proved",
        _kind(certificate),
        used,
        "command line" if ordering is not None else "certificate",
        certificate.digest != digest(spec),
    )
    if ordering is None and (used, spec.effect_ordering) == ("any", "first"):
        return replace(found, verdict="refuted", reason=_WRITES_FIRST)
    context.learn(replace(found, verdict="undecided"))
    try:
        context.tell("checking the certificate of unrealizability")
        _check_starts(reason, spec)
        proved = _checked(reason, spec, used, Budget(timeout, context))
    except FalseClaimError as false:
        return replace(found, verdict="refuted", reason=false.reason, state=false.state, chosen=false.chosen)
    except UndecidedError as undecided:
        why = context.described() if context.is_over else str(undecided)
        return replace(found, verdict="undecided", reason=why)
    except LimitReachedError as limit:
        return replace(found, verdict="undecided", reason=str(limit))
    return replace(found, obligations=sum(proved), by_solver=proved.by_solver > 0, by_diagrams=proved.by_diagrams > 0)


def _checked(reason: Reason, spec: Spec, ordering: Ordering, budget: Budget) -> Obligations:
    """What was proved. Raises `FalseClaimError`, and `UndecidedError` where a claim is left open."""
    if isinstance(reason, NoRestoration):
        check_no_restoration(reason, spec, ordering, budget.until())
        return Obligations(0, 0, 2)
    if not isinstance(reason, NoPart) or any(True for _ in conflicts_of(reason)):
        need_z3("check this certificate")
    if isinstance(reason, NoPart):
        return check_no_part(reason, spec, ordering, budget)
    from tumato_symbolic.verify.unrealizability.by_solver import check_allowed_steps

    return check_allowed_steps(reason, spec, ordering, budget)


def _check_starts(reason: Reason, spec: Spec) -> None:
    """With starts, the states that fail have to be starts: then no part of the states that has all of them will do."""
    if isinstance(reason, NoPart):
        return
    states = [reason.state] if not isinstance(reason, Conflict) else [reason.choices[n].state for n in reason.starts]
    for state in states:
        if is_valid(spec, state) and not is_start(spec, state):
            raise FalseClaimError(f"the state {state_text(spec, state)} is no start, so it need not be decided")


def _kind(certificate: Unrealizability) -> UnrealizabilityKind:
    match certificate.reason:
        case NoAllowedSet():
            return "no-allowed-set"
        case NoRestoration():
            return "no-restoration"
        case NoPlan():
            return "no-plan"
        case NoPart():
            return "no-part"
        case _:
            return "conflict"
