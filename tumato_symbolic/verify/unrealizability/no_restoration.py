"""*Safety is never surely restored from this state*: a trap, checked by the walk (`docs/certificate.md`)."""

from __future__ import annotations

from typing import Final

from tumato_symbolic.policy.unrealizability import NoRestoration
from tumato_symbolic.semantics import is_safe, is_valid, level, state_text
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function, given_up
from tumato_symbolic.verify.by_diagrams.steps import Steps
from tumato_symbolic.verify.undecided import UndecidedError
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError

_CLAIM: Final = "nothing is sure to lead out of the trap"


def check_no_restoration(reason: NoRestoration, spec: Spec, ordering: Ordering, deadline: float) -> None:
    """Raises `FalseClaimError`, and `UndecidedError` where the walk gives up."""
    state = reason.state
    if spec.restoration == "one_step":
        raise FalseClaimError("safety has to be restored in one step, so it does not matter what several steps can do")
    if not is_valid(spec, state) or is_safe(spec, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not unsafe, so nothing has to be restored")
    if not reason.diagram.evaluate(reason.root, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not in the trap")
    try:
        _check_trap(reason, spec, ordering, deadline)
    except (BudgetError, RecursionError) as error:
        raise UndecidedError(_CLAIM, given_up(error)) from None


def _check_trap(reason: NoRestoration, spec: Spec, ordering: Ordering, deadline: float) -> None:
    steps = Steps(spec, ordering, reason.diagram.order, deadline)
    walk, place = steps.walk, level(spec, reason.state)
    held = walk.all_of((steps.tiers[place], walk.import_diagram(reason.diagram, int)[reason.root]))
    left = states_let_out(steps, held, place)
    if left != FALSE:
        state = state_text(spec, steps.first_state(left))
        raise FalseClaimError(f"something that may be executed in {state} leads out of the trap")


def states_let_out(steps: Steps, held: Function, place: int) -> Function:
    """The pairs that are sure to lead out of those of some states that have this level."""
    walk = steps.walk
    trap = walk.without(held, steps.tiers[place + 1])
    outside = walk.negation(trap)
    if steps.spec.restoration == "fair":
        leaving = walk.compose(outside, steps.successor(steps.chosen))
    else:
        leaving = steps.into(outside)
    return walk.all_of((trap, leaving, steps.allowed))
