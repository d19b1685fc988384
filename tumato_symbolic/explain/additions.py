"""What a repair may add to a specification: a setting, an action, goals that give way to the environment."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.explain.as_predicates import cube_formula, predicate_text
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.spec import (
    TRUE,
    Action,
    Assignment,
    ConditionalGoal,
    Formula,
    GoalList,
    Restoration,
    Rule,
    SimpleGoal,
    Spec,
)

_SPAN = Span(1, 1, 1, 1)


class Setting(Struct, frozen=True):
    """A line in CONFIG: safety may take several steps to restore."""

    restoration: Restoration


class NewAction(Struct, frozen=True):
    """An action that the robot lacks: where it has to be able to start (None: anywhere), and its nominal effects."""

    condition: StateCube | None
    effects: Assignment


class NoGoalWhile(Struct, frozen=True):
    """No goal is active while one of some variables has one of its values."""

    values: tuple[tuple[int, tuple[int, ...]], ...]


Addition: TypeAlias = Setting | NewAction | NoGoalWhile


def with_additions(spec: Spec, additions: Iterable[Addition]) -> Spec:
    """The specification with all of these added."""
    for addition in additions:
        spec = _with(spec, addition)
    return spec


def _with(spec: Spec, addition: Addition) -> Spec:
    match addition:
        case Setting(restoration):
            return replace(spec, restoration=restoration)
        case NewAction(condition, effects):
            preconditions = () if condition is None else (_rule(spec, cube_formula(spec, condition)),)
            name = f"new action {len(spec.actions)}"  # of one name they would be cases of one action
            action = Action(name, 0, frozenset(), preconditions, effects, (), _SPAN)
            return replace(spec, actions=(*spec.actions, action))
        case NoGoalWhile():
            return _without_goal(spec, [_rule(spec, each) for each in conditions_of(spec, addition)])


def conditions_of(spec: Spec, addition: NoGoalWhile) -> list[Formula]:
    """The conditions under which no goal is active, one for each variable."""
    everything = every_state(spec)
    return [cube_formula(spec, within(everything, variable, values)) for variable, values in addition.values]


def every_state(spec: Spec) -> StateCube:
    """The cube of all states."""
    return tuple(tuple(range(len(variable.values))) for variable in spec.variables)


def within(cube: StateCube, variable: int, values: tuple[int, ...]) -> StateCube:
    """The cube with other values for one variable."""
    return (*cube[:variable], values, *cube[variable + 1 :])


def _without_goal(spec: Spec, conditions: Sequence[Rule]) -> Spec:
    """The specification with `when condition then goal: true` before all goals, for each condition."""
    if spec.goals is None:
        return spec
    bodies = spec.bodies
    place = next((number for number, body in enumerate(bodies) if body.formula == TRUE), len(bodies))
    if place == len(bodies):
        bodies = (*bodies, Rule(TRUE, "true", _SPAN))
    free = (ConditionalGoal(condition, SimpleGoal(place, "true", _SPAN), _SPAN) for condition in conditions)
    others = spec.goals.members if spec.goals.kind == "priority" else (spec.goals,)
    return replace(spec, bodies=bodies, goals=GoalList("priority", (*free, *others), spec.goals.span))


def _rule(spec: Spec, formula: Formula) -> Rule:
    return Rule(formula, predicate_text(spec, formula), _SPAN)
