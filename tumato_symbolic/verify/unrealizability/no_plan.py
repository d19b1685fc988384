"""*No run from this state meets its residual goal*: layers of states that hold all runs (`docs/certificate.md`)."""

from __future__ import annotations

from tumato_symbolic.diagrams import Diagram
from tumato_symbolic.policy.unrealizability import Layers, NoPlan
from tumato_symbolic.semantics import Residual, State, is_valid, residual_goal, state_text
from tumato_symbolic.verify.by_diagrams.functions import BudgetError
from tumato_symbolic.verify.by_z3.encoding import diagram_terms
from tumato_symbolic.verify.by_z3.goal_terms import reached_term
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, conjunction, disjunction, negation
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep, Step, is_state
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.layers_by_diagrams import first_left
from tumato_symbolic.verify.unrealizability.named_goals import goal_text, named_goal, set_text

MANY_NODES = 1000
"""Layers with more nodes tend to count, and then Z3 takes long."""

SOON = 5.0
"""How many seconds Z3 may think about layers with fewer nodes before the walk is tried."""

_HELD = "the next layers hold all successors of a layer"


def check_no_plan(reason: NoPlan, step: AllowedStep) -> int:
    """How many claims were checked without Z3. Raises `FalseClaimError` and `UndecidedError`."""
    spec, state = step.spec, reason.state
    if not is_valid(spec, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not valid, so it needs no plan")
    goals = [(named_goal(spec, goal.bodies, goal.executed), goal) for goal in reason.goals]
    others = [negation(step.goals.is_residual(goal, step.executed)) for goal, _ in goals]
    found = step.some_step("no other residual goal is possible in the state", is_state(step.state, state), *others)
    if found is not None:
        goal = residual_goal(spec, state, found[1])
        if goal in [goal for goal, _ in goals]:
            raise RuntimeError(f"{goal} is listed, against the solver")
        raise FalseClaimError(
            f"{_told(step, found)} and leaves {goal_text(spec, goal)} pending, which is not listed", *found[:2]
        )
    for goal, layers in goals:
        _check_layers(reason, goal, layers, step)
    return 1


def _check_layers(reason: NoPlan, goal: Residual, layers: Layers, step: AllowedStep) -> None:
    """The first layer holds the first successors, the layers hold each other's, none meets the goal, and they suffice.

    Layers speak of safe states only; every allowed step leads to one.
    """
    spec = step.spec
    if not layers.roots:
        raise FalseClaimError(f"there is no layer for {goal_text(spec, goal)}")
    diagram = reason.diagram
    here = [step.name(term) for term in diagram_terms(diagram, layers.roots, step.state, bool)]
    after = [step.name(term) for term in diagram_terms(diagram, layers.roots, step.after, bool)]
    pending = step.goals.is_residual(goal, step.executed)
    start = is_state(step.state, reason.state)
    found = step.some_step("the first layer holds the first successors", start, pending, negation(after[0]))
    if found is not None:
        if diagram.evaluate(layers.roots[0], found[2]):
            raise RuntimeError(f"layer 1 holds {found[2]}, against the solver")
        raise FalseClaimError(f"{_told(step, found)}, which is not in layer 1", *found[:2])
    reached = step.name(reached_term(spec, goal, step.state))
    state = step.some_state("no state of a layer meets the goal", disjunction(here), step.safe, reached)
    if state is not None:
        number = _first_layer(diagram, layers, state)
        raise FalseClaimError(f"the state {state_text(spec, state)} of layer {number} meets {goal_text(spec, goal)}")
    found = _step_out(reason, layers, step, _leaving(step, here, after))
    if found is not None:
        number = _first_layer(diagram, layers, found[0])
        if any(diagram.evaluate(root, found[2]) for root in layers.roots[: number + 1]):
            raise RuntimeError(f"a layer holds {found[2]}, against the solver")
        where = f"layers 1 to {number + 1}" if number < len(here) else "any layer, and the plan bound is not met"
        raise FalseClaimError(f"from layer {number}, {_told(step, found)}, which is not in {where}", *found[:2])


def _leaving(step: AllowedStep, here: list[Term], after: list[Term]) -> Term:
    """The step leads from some layer, the last one only where it has to be closed, to none that may follow."""
    bound, leaving = step.spec.max_plan_length, []
    allowed: Term = after[0]
    for number, layer in enumerate(here, 1):
        if number < len(here):
            allowed = step.name(disjunction((allowed, after[number])))
        elif bound is not None and number >= bound:
            break
        leaving.append(conjunction((layer, negation(allowed))))
    return disjunction(leaving)


def _step_out(reason: NoPlan, layers: Layers, step: AllowedStep, leaving: Term) -> Step | None:
    """A step that is `leaving`; None where there is none.

    By Z3 where it answers soon, otherwise by the walk, otherwise by Z3 after all. Raises `UndecidedError`.
    """
    if len(reason.diagram.nodes) <= MANY_NODES:
        try:
            return step.some_step(_HELD, step.safe, leaving, within=SOON)
        except UndecidedError:
            pass
    try:
        state = first_left(step.spec, step.ordering, reason.diagram, layers.roots, step.deadline())
    except (BudgetError, RecursionError):
        return step.some_step(_HELD, step.safe, leaving)
    if state is None:
        step.walked += 1
        return None
    found = step.some_step(_HELD, is_state(step.state, state), leaving)
    if found is None:
        raise RuntimeError(f"no step leaves the layers from {state}, against the walk")
    return found


def _first_layer(diagram: Diagram[bool], layers: Layers, state: State) -> int:
    """The number of the first layer that holds a state."""
    return next(number for number, root in enumerate(layers.roots, 1) if diagram.evaluate(root, state))


def _told(step: AllowedStep, found: Step) -> str:
    state, chosen, after = found
    spec = step.spec
    return f"in {state_text(spec, state)}, {set_text(spec, chosen)} is allowed, leads to {state_text(spec, after)}"
