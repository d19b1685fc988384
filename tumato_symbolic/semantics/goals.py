"""Which goals are active, and what is left of them once a set is chosen (`docs/semantics.md`, section 4)."""

from __future__ import annotations

from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics.states import ActionSet, State, holds, is_safe
from tumato_symbolic.spec import ConditionalGoal, Goal, Rule, SimpleGoal, Spec, executing_atoms

ActiveGoals: TypeAlias = frozenset[int]
"""`Γ(s)`: numbers of goal bodies (`Spec.bodies`)."""


class Residual(Struct, frozen=True):
    """A residual goal: active bodies whose `executing` atoms are settled by the first set.

    `executed` holds those actions of the first set that the bodies speak of, each by its first case; every other atom
    `executing a` is false.
    """

    bodies: ActiveGoals
    executed: ActionSet


def active_goals(spec: Spec, state: State) -> ActiveGoals:
    """`Γ(s)`."""
    return frozenset(goal.body for goal in _active(spec, state))


def goals_as_written(spec: Spec, state: State) -> tuple[tuple[int, Rule], ...]:
    """The goals that are active, in the order of the text: the number of the body, and the body as each is written.

    Several may have one body.
    """
    return tuple((goal.body, spec.as_written(goal)) for goal in _active(spec, state))


def _active(spec: Spec, state: State) -> tuple[SimpleGoal, ...]:
    if spec.goals is None:
        return ()
    entered, found = _walk(spec.goals, state)
    return found if entered else ()


def _walk(goal: Goal, state: State) -> tuple[bool, tuple[SimpleGoal, ...]]:
    """Whether `goal` is entered in `state`, and the simple goals that it makes active there."""
    if isinstance(goal, SimpleGoal):
        return True, (goal,)
    if isinstance(goal, ConditionalGoal):
        if not holds(goal.condition.formula, state):
            return False, ()
        return True, _walk(goal.goal, state)[1]
    found: tuple[SimpleGoal, ...] = ()
    for member in goal.members:
        entered, active = _walk(member, state)
        found += active
        if entered and goal.kind == "priority":
            break
    return True, found


def residual_goal(spec: Spec, state: State, chosen: ActionSet) -> Residual:
    """The residual goal of `state` when `chosen` is the first set."""
    bodies = active_goals(spec, state)
    mentioned = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in bodies))
    return Residual(bodies, spec.as_actions(chosen & mentioned))


def reached(spec: Spec, goal: Residual, state: State) -> bool:
    """Whether the residual goal is met in `state`: where safety may take several steps to restore, in safe ones."""
    if spec.restores_stepwise and not is_safe(spec, state):
        return False
    return all(holds(spec.bodies[body].formula, state, goal.executed) for body in goal.bodies)
