"""Executions held against the explicit meaning, step by step."""

from collections.abc import Mapping

from tumato_symbolic.semantics import (
    ActionSet,
    Disturbance,
    Move,
    State,
    Trace,
    apply,
    is_valid,
    next_states,
    nominal_agrees,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec


def faults(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering, trace: Trace) -> list[str]:
    """What is wrong with a trace; nothing where it is an execution of the policy that ends as it says."""
    here, goal, met, found = trace.start, None, False, []
    for number, event in enumerate(trace.events, 1):
        if met:
            found.append(f"{number}: goes on after the goal")
        if isinstance(event, Disturbance):
            changed = sum(one != other for one, other in zip(here, event.after, strict=True))
            if changed != 1 or not is_valid(spec, event.after):
                found.append(f"{number}: not a disturbance")
            goal = None
        else:
            if not _is_step(spec, policy, ordering, here, event):
                found.append(f"{number}: not a step of the policy")
            goal = goal or residual_goal(spec, here, event.decision)
            met = reached(spec, goal, event.after)
        here = event.after
    if met != (trace.end == "goal"):
        found.append("the goal")
    chosen = policy.get(here)
    if trace.end == "undefined" and chosen is not None and nominal_agrees(spec, chosen):
        found.append("decided")
    if trace.end == "loop" and (trace.loop is None or trace.states[trace.loop] != here or not trace.events):
        found.append("no loop")
    return found


def _is_step(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering, here: State, move: Move) -> bool:
    if policy.get(here) != move.decision or move.after not in next_states(spec, here, move.decision, ordering):
        return False
    nominal = successor(spec, here, move.decision)
    if move.deviation is None:
        return move.after == nominal
    actions = [step.action for step in move.deviation]
    if len(set(actions)) != len(actions) or not set(actions) <= move.decision or not actions:
        return False
    if ordering == "first" and len(actions) > 1:
        return False
    for step in move.deviation:
        here = apply(step.effect, here)
        if step.effect not in spec.actions[step.action].effects or step.after != here:
            return False
    return move.after == here and here != nominal
