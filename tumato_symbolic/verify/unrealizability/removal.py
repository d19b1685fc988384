"""*No policy that stays in these valid states decides any of some of them*, by the walk (`docs/certificate.md`)."""

from __future__ import annotations

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy.unrealizability import Removal
from tumato_symbolic.semantics import state_text
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, given_up
from tumato_symbolic.verify.by_diagrams.goals import StepGoals
from tumato_symbolic.verify.by_diagrams.steps import Steps
from tumato_symbolic.verify.undecided import UndecidedError
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import goal_text
from tumato_symbolic.verify.unrealizability.no_restoration import states_let_out
from tumato_symbolic.verify.unrealizability.walk_distances import WalkDistances


def removed(removal: Removal) -> tuple[Diagram[bool], Reference]:
    """The states that are removed, as a root of a diagram."""
    diagram = removal.diagram
    return Diagram(diagram.order, tuple(leaf is not None for leaf in diagram.leaves), diagram.nodes), removal.root


def check_removal(removal: Removal, name: str, spec: Spec, ordering: Ordering, deadline: float) -> int:
    """How many obligations were proved; the valid states of `spec` are those that are left before.

    Raises `FalseClaimError`, and `UndecidedError` where the walk gives up.
    """
    steps = Steps(spec, ordering, removal.diagram.order, deadline)
    try:
        if removal.kind == "no-restoration":
            return _check_traps(removal, name, steps)
        return _check_no_plan(removal, name, steps)
    except (BudgetError, RecursionError) as error:
        raise UndecidedError(f"{name} removes no state that a policy may decide", given_up(error)) from None


def _check_traps(removal: Removal, name: str, steps: Steps) -> int:
    """The states of each level that are removed are a trap."""
    spec, walk = steps.spec, steps.walk
    if spec.restoration == "one_step":
        raise FalseClaimError(f"{name} speaks of traps, but safety has to be restored in one step")
    diagram, root = removed(removal)
    held = walk.import_diagram(diagram, int)[root]
    safe = walk.all_of((held, steps.safe))
    if safe != FALSE:
        state = state_text(spec, steps.first_state(safe))
        raise FalseClaimError(f"{name} removes {state} as not restored, which is safe")
    for level in range(len(spec.tiers)):
        left = states_let_out(steps, walk.all_of((held, steps.tiers[level])), level)
        if left != FALSE:
            state = state_text(spec, steps.first_state(left))
            raise FalseClaimError(f"something that may be executed in {state} leads out of the trap of {name}")
    return 1 + len(spec.tiers)


def _check_no_plan(removal: Removal, name: str, steps: Steps) -> int:
    """Whatever is allowed in a state that is removed leads where its residual goal is too far away."""
    spec, walk = steps.spec, steps.walk
    diagram, root = removed(removal)
    held = walk.all_of((steps.valid, walk.import_diagram(diagram, int)[root]))
    distances = WalkDistances(removal.diagram, removal.goals, name, steps)
    for goal in distances.goals:
        distances.check(goal)
    for goal, pairs in StepGoals(steps).residuals(walk.all_of((held, distances.taken)), steps.chosen):
        left = walk.without(pairs, distances.too_far_after(goal))
        if left != FALSE:
            state, told = state_text(spec, steps.first_state(left)), goal_text(spec, goal)
            raise FalseClaimError(
                f"in {state}, which {name} removes, something is allowed after which {told} may be reached"
            )
    return 1 + 2 * len(distances.goals)
