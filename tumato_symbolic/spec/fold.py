"""Folds over formulas and over the tree of goals: what becomes of each part, once and for all engines."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Generic, TypeVar

from msgspec import Struct

from tumato_symbolic.spec.formula import And, Constant, Executing, Formula, Iff, Is, Not, Or
from tumato_symbolic.spec.specification import ConditionalGoal, Goal, GoalList, SimpleGoal

Value = TypeVar("Value")


class Connectives(Struct, Generic[Value], frozen=True):
    """What the connectives of formulas are among values of one kind: diagrams, terms, texts, truth values."""

    constant: Callable[[bool], Value]
    negation: Callable[[Value], Value]
    conjunction: Callable[[Sequence[Value]], Value]
    disjunction: Callable[[Sequence[Value]], Value]
    equivalence: Callable[[Value, Value], Value]


def fold(formula: Formula, atom: Callable[[Is | Executing], Value], by: Connectives[Value]) -> Value:
    """The value of a formula whose atoms have these values; a part that it has several times is looked at once."""
    return _fold(formula, atom, by, {})


def _fold(
    formula: Formula, atom: Callable[[Is | Executing], Value], by: Connectives[Value], known: dict[int, Value]
) -> Value:
    """`fold`; `known` are the values of parts, by what they are, not by what they say."""
    if isinstance(formula, Is | Executing):
        return atom(formula)
    if id(formula) in known:
        return known[id(formula)]
    value: Value
    match formula:
        case Constant(truth):
            value = by.constant(truth)
        case Not(operand):
            value = by.negation(_fold(operand, atom, by, known))
        case And(operands):
            value = by.conjunction([_fold(part, atom, by, known) for part in operands])
        case Or(operands):
            value = by.disjunction([_fold(part, atom, by, known) for part in operands])
        case Iff(left, right):
            value = by.equivalence(_fold(left, atom, by, known), _fold(right, atom, by, known))
    known[id(formula)] = value
    return value


def fold_goal(
    goal: Goal,
    simple: Callable[[SimpleGoal], Value],
    conditional: Callable[[ConditionalGoal, Value], Value],
    several: Callable[[GoalList, list[Value]], Value],
) -> Value:
    """The value of a goal from the values of the goals in it."""
    match goal:
        case SimpleGoal():
            return simple(goal)
        case ConditionalGoal():
            return conditional(goal, fold_goal(goal.goal, simple, conditional, several))
        case GoalList():
            return several(goal, [fold_goal(member, simple, conditional, several) for member in goal.members])


def subgoals(goal: Goal | None) -> list[Goal]:
    """Every goal of a tree, outer ones first, then in order."""
    if goal is None:
        return []
    return fold_goal(
        goal,
        lambda simple: [simple],
        lambda conditional, inner: [conditional, *inner],
        lambda several, members: [several, *(each for member in members for each in member)],
    )


class _Activity(Struct, Generic[Value], frozen=True):
    """When a goal is entered, and when it makes which body active (`docs/semantics.md`, section 4)."""

    entered: Value
    active: dict[int, Value]


def active_bodies(goals: Goal | None, holds: Callable[[Formula], Value], by: Connectives[Value]) -> dict[int, Value]:
    """When each goal body is active, where `holds` tells when a condition does; those not listed never are."""

    def simple(goal: SimpleGoal) -> _Activity[Value]:
        always = by.constant(True)
        return _Activity(always, {goal.body: always})

    def conditional(goal: ConditionalGoal, inner: _Activity[Value]) -> _Activity[Value]:
        entered = holds(goal.condition.formula)
        return _Activity(entered, {body: by.conjunction([entered, when]) for body, when in inner.active.items()})

    def several(goal: GoalList, members: list[_Activity[Value]]) -> _Activity[Value]:
        found: dict[int, list[Value]] = {}
        tried = by.constant(True)
        for member in members:
            for body, when in member.active.items():
                found.setdefault(body, []).append(by.conjunction([tried, when]))
            if goal.kind == "priority":
                tried = by.conjunction([tried, by.negation(member.entered)])
        return _Activity(by.constant(True), {body: by.disjunction(whens) for body, whens in found.items()})

    return {} if goals is None else fold_goal(goals, simple, conditional, several).active


FORMULAS: Connectives[Formula] = Connectives(
    constant=Constant,
    negation=Not,
    conjunction=lambda parts: And(tuple(parts)),
    disjunction=lambda parts: Or(tuple(parts)),
    equivalence=Iff,
)
"""A formula from formulas: a fold by these puts others in the place of atoms."""


def _all(values: Sequence[bool | None]) -> bool | None:
    return False if False in values else None if None in values else True


def _any(values: Sequence[bool | None]) -> bool | None:
    return True if True in values else None if None in values else False


THREE_VALUED: Connectives[bool | None] = Connectives(
    constant=lambda value: value,
    negation=lambda value: None if value is None else not value,
    conjunction=_all,
    disjunction=_any,
    equivalence=lambda left, right: None if left is None or right is None else left == right,
)
"""Kleene's strong three-valued logic: a truth value is right whatever is not known, None is cautious."""
