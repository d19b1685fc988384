"""The verdict on a certificate that a specification has no policy (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tumato_symbolic.limits import Budget, Context, LimitReachedError, need_z3
from tumato_symbolic.policy.unrealizability import Conflict, NoAllowedSet, NoPlan, NoRestoration, Unrealizability, bind
from tumato_symbolic.semantics import State, is_safe, is_start, is_valid
from tumato_symbolic.spec import Ordering, Spec, digest
from tumato_symbolic.spec.support import require_no_starts, require_one_step
from tumato_symbolic.verify.result import UnrealizabilityKind, UnrealizabilityVerdict
from tumato_symbolic.verify.undecided import UndecidedError
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import state_text
from tumato_symbolic.verify.unrealizability.no_restoration import check_no_restoration

OBLIGATION_BUDGET = 30.0
"""How many seconds Z3 may think about one obligation."""

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
    if isinstance(reason, Conflict):
        require_no_starts(spec, "the proof that goals conflict")
    if not isinstance(reason, NoRestoration) and not all(is_safe(spec, state) for state in _states_of(reason)):
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
        _check_start(reason, spec)
        if isinstance(reason, NoRestoration):
            check_no_restoration(reason, spec, used, Budget(timeout, context).until())
            return replace(found, obligations=2, by_diagrams=True)
        need_z3("check this certificate")
        from tumato_symbolic.verify.unrealizability.by_solver import check_allowed_steps

        proved = check_allowed_steps(reason, spec, used, Budget(timeout, context))
    except FalseClaimError as false:
        return replace(found, verdict="refuted", reason=false.reason, state=false.state, chosen=false.chosen)
    except UndecidedError as undecided:
        why = context.described() if context.is_over else str(undecided)
        return replace(found, verdict="undecided", reason=why)
    except LimitReachedError as limit:
        return replace(found, verdict="undecided", reason=str(limit))
    return replace(found, obligations=sum(proved), by_solver=proved.by_solver > 0, by_diagrams=proved.by_diagrams > 0)


def _check_start(reason: NoAllowedSet | NoPlan | NoRestoration | Conflict, spec: Spec) -> None:
    """With starts, a state that fails has to be one: then no part of the states that has all of them has a policy."""
    if not isinstance(reason, Conflict) and is_valid(spec, reason.state) and not is_start(spec, reason.state):
        raise FalseClaimError(f"the state {state_text(spec, reason.state)} is no start, so it need not be decided")


def _states_of(reason: NoAllowedSet | NoPlan | Conflict) -> Iterator[State]:
    """The states that a reason is about: where they are safe, so is all that runs from there meet."""
    if isinstance(reason, Conflict):
        yield from (choice.state for choice in reason.choices)
    else:
        yield reason.state


def _kind(certificate: Unrealizability) -> UnrealizabilityKind:
    match certificate.reason:
        case NoAllowedSet():
            return "no-allowed-set"
        case NoRestoration():
            return "no-restoration"
        case NoPlan():
            return "no-plan"
        case _:
            return "conflict"
