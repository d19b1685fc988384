"""Whether a specification may have too many residual goals to look at each apart.

The members of a `constraint` list are entered or not, each by itself: n conditions make up to 2^n sets of active goals,
of n bodies. Then one parameter for each body, *it is active*, and one for each action that bodies speak of, *it is
executed first*, tell the residual goals apart.
"""

from __future__ import annotations

from math import prod

from msgspec import Struct

from tumato_symbolic.spec.fold import fold_goal
from tumato_symbolic.spec.formula import executing_atoms
from tumato_symbolic.spec.specification import ConditionalGoal, Goal, GoalList, Spec

MOST_APART = 256
"""Up to so many sets of active goals, by the structure of the goals, are looked at one by one."""


class GoalParameters(Struct, frozen=True):
    """What residual goals are told apart by: bodies, and actions (by their first cases) that some body speaks of."""

    bodies: tuple[int, ...]
    actions: tuple[int, ...]


def goal_parameters(spec: Spec) -> GoalParameters | None:
    """The parameters of a specification whose goals may be many; None where each is looked at apart."""
    if spec.goals is None or _most(spec.goals) <= MOST_APART:
        return None
    actions = frozenset[int]().union(*(executing_atoms(body.formula) for body in spec.bodies))
    return GoalParameters(tuple(range(len(spec.bodies))), tuple(sorted(spec.as_actions(actions))))


def many_told(spec: Spec) -> str:
    """That goals may be active in many ways, where they may, as reports say it; else empty."""
    if spec.goals is None or goal_parameters(spec) is None:
        return ""
    return f"up to {_most(spec.goals):,} sets of goals may be active"


def _most(goals: Goal) -> int:
    """How many sets of active goals there can be at most, whatever the conditions say."""

    def several(goal: GoalList, members: list[int]) -> int:
        each = zip(goal.members, members, strict=True)
        if goal.kind == "priority":
            return sum(members) + all(isinstance(member, ConditionalGoal) for member in goal.members)
        return prod(inner + isinstance(member, ConditionalGoal) for member, inner in each)

    return fold_goal(goals, lambda _: 1, lambda _, inner: inner, several)
