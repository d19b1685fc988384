"""*No run from this state reaches what it owes*: layers of states that hold all runs (`docs/certificate.md`)."""

from __future__ import annotations

from tumato_symbolic.policy.diagram import Diagram
from tumato_symbolic.policy.unrealizable import Layers, NoPlan
from tumato_symbolic.semantics import Residual, is_valid, residual_goal
from tumato_symbolic.verify.by_z3.encoding import diagram_terms
from tumato_symbolic.verify.by_z3.goal_terms import reached_term
from tumato_symbolic.verify.by_z3.terms import disjunction, negation
from tumato_symbolic.verify.no_policy.allowed_step import AllowedStep, FalseClaimError, Step, is_state
from tumato_symbolic.verify.no_policy.named_goals import goal_text, named_goal, set_text, state_text


def check_no_plan(reason: NoPlan, step: AllowedStep) -> int:
    """How many claims were checked without Z3. Raises `FalseClaimError` and `UndecidedError`."""
    spec, state = step.spec, reason.state
    if not is_valid(spec, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not valid, so it needs no plan")
    goals = [(named_goal(spec, goal.bodies, goal.executed), goal) for goal in reason.goals]
    others = [negation(step.goals.is_residual(goal, step.executed)) for goal, _ in goals]
    found = step.some_step("the state can owe no other goal", is_state(step.state, state), *others)
    if found is not None:
        owed = residual_goal(spec, state, found[1])
        if owed in [goal for goal, _ in goals]:
            raise RuntimeError(f"{owed} is listed, against the solver")
        raise FalseClaimError(f"{_told(step, found)} and owes {goal_text(spec, owed)}, which is not listed", *found[:2])
    for goal, layers in goals:
        _check_layers(reason, goal, layers, step)
    return 1


def _check_layers(reason: NoPlan, goal: Residual, layers: Layers, step: AllowedStep) -> None:
    """The first layer holds the first successors, the layers hold each other's, none meets the goal, and they suffice.

    Layers speak of safe states only; every allowed step leads to one.
    """
    spec, bound = step.spec, step.spec.max_plan_length
    if not layers.roots:
        raise FalseClaimError(f"there is no layer for {goal_text(spec, goal)}")
    diagram = reason.diagram
    here = [step.name(term) for term in diagram_terms(diagram, layers.roots, step.state, bool)]
    after = [step.name(term) for term in diagram_terms(diagram, layers.roots, step.after, bool)]
    owing = step.goals.is_residual(goal, step.executed)
    start = is_state(step.state, reason.state)
    found = step.some_step("the first layer holds the first successors", start, owing, negation(after[0]))
    if found is not None:
        _must_not_hold(diagram, layers.roots[:1], found)
        raise FalseClaimError(f"{_told(step, found)}, which is not in layer 1", *found[:2])
    reached = step.name(reached_term(spec, goal, step.state))
    for number, layer in enumerate(here, 1):
        state = step.some_state("no state of a layer meets the goal", layer, step.safe, reached)
        if state is not None:
            raise FalseClaimError(
                f"the state {state_text(spec, state)} of layer {number} meets {goal_text(spec, goal)}"
            )
        if number == len(here) and bound is not None and number >= bound:
            break
        outside = negation(disjunction(after[: number + 1]))
        found = step.some_step("the next layers hold all successors of a layer", layer, step.safe, outside)
        if found is not None:
            _must_not_hold(diagram, layers.roots[: number + 1], found)
            where = f"layers 1 to {number + 1}" if number < len(here) else "any layer, and the plan bound is not met"
            raise FalseClaimError(f"from layer {number}, {_told(step, found)}, which is not in {where}", *found[:2])


def _must_not_hold(diagram: Diagram[bool], roots: tuple[int, ...], found: Step) -> None:
    if any(diagram.evaluate(root, found[2]) for root in roots):
        raise RuntimeError(f"a layer holds {found[2]}, against the solver")


def _told(step: AllowedStep, found: Step) -> str:
    state, chosen, after = found
    spec = step.spec
    return f"in {state_text(spec, state)}, {set_text(spec, chosen)} is allowed, leads to {state_text(spec, after)}"
