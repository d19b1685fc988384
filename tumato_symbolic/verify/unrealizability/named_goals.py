"""Residual goals as certificates name them."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.semantics import ActionSet, Residual, action_names
from tumato_symbolic.spec import Spec, canonical_text
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError


def named_goal(spec: Spec, bodies: Sequence[str], executed: Sequence[str]) -> Residual:
    """The residual goal with these names. Raises `FalseClaimError` where the specification has none."""
    numbers = {canonical_text(spec, rule.formula): number for number, rule in enumerate(spec.bodies)}
    actions = {spec.actions[cases[0]].name: cases[0] for cases in spec.cases}
    unknown = next((text for text in bodies if text not in numbers), None)
    if unknown is not None:
        raise FalseClaimError(f"it mentions the goal '{unknown}', which the specification does not have")
    return Residual(frozenset(numbers[text] for text in bodies), frozenset(actions[name] for name in executed))


def goal_text(spec: Spec, goal: Residual) -> str:
    """A residual goal in words."""
    bodies = " AND ".join(f"({' '.join(spec.bodies[body].text.split())})" for body in sorted(goal.bodies))
    executed = ", ".join(action_names(spec, goal.executed))
    return (bodies or "no goal") + (f" while executing {executed}" if executed else "")


def set_text(spec: Spec, chosen: ActionSet) -> str:
    """A set of actions; the empty one is `nothing`."""
    return f"{{{', '.join(action_names(spec, chosen))}}}" if chosen else "nothing"
