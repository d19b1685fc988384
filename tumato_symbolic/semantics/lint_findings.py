"""Findings that need the whole state space, however they are found: their words, and what they leave out.

`semantics.lint` looks for them state by state, `synthesis.lint` by diagrams.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.diagnostics.copies import merged
from tumato_symbolic.spec import (
    FORMULAS,
    Action,
    ConditionalGoal,
    Formula,
    Goal,
    Rule,
    Spec,
    active_bodies,
    executing_atoms,
    variables_of,
)

STATES, SETS = "valid state", "applicable set of actions in a valid state"
"""What could break a state rule, and a reaction rule."""


def no_valid_state(spec: Spec) -> Diagnostic:
    """The error where the assumptions exclude every state."""
    notes = tuple(Note("an assumption", rule.span) for rule in spec.assumptions[1:])
    message = "no state satisfies all assumptions, so there is nothing to decide"
    return Diagnostic(Code.TUM312, message, spec.assumptions[0].span, "weaken or remove an assumption", notes)


def no_start(spec: Spec) -> Diagnostic:
    """The error where no valid state satisfies a start condition."""
    notes = tuple(Note("a start condition", rule.span) for rule in spec.starts[1:])
    message = "no valid state is a start, so there is nothing to decide"
    return Diagnostic(Code.TUM317, message, spec.starts[0].span, "weaken the condition, or remove the block", notes)


def idle_goal(goal: Goal) -> Diagnostic:
    """The warning about a goal that is never entered."""
    message = "this goal is never entered: an earlier goal of the priority list always is"
    if isinstance(goal, ConditionalGoal):
        message = f"this goal is never entered: in no valid state where it is tried, `{goal.condition.text}` holds"
    return Diagnostic(Code.TUM351, message, goal.span, "remove it, or move it before the goal that hides it")


def goals_to_reach(spec: Spec) -> Iterator[tuple[Rule, Formula]]:
    """The goal bodies about the state alone that something may falsify, and when they are active."""
    active = active_bodies(spec.goals, lambda formula: formula, FORMULAS)
    for number, body in enumerate(spec.bodies):
        if variables_of(body.formula) and not executing_atoms(body.formula):
            yield body, active[number]


def reached_goal(body: Rule) -> Diagnostic:
    """The warning about a goal that there is nothing to be done for."""
    message = "this goal holds already in every valid state where it is active"
    return Diagnostic(
        Code.TUM355, message, body.span, "check its condition; where nothing is to be done, `goal: true` says so"
    )


def idle_rule(rule: Rule, where: str) -> Diagnostic:
    """The warning about a rule that nothing breaks; `where` is what could."""
    message = f"no {where} breaks this rule, so it changes nothing"
    return Diagnostic(Code.TUM352, message, rule.span, "remove it, or check what it was meant to forbid")


def idle_action(action: Action) -> Diagnostic:
    """The warning about an action that is allowed nowhere."""
    message = f"`{action.name}` is allowed in no valid state, alone or together with others"
    return Diagnostic(Code.TUM353, message, action.span, "check its preconditions, and what its effects break")


def keeps_guard(spec: Spec, rule: Rule) -> bool:
    """Whether a rule that nothing breaks ought to stay: it is about the environment, of which something is assumed.

    A rule that only repeats an assumption need not.
    """
    assumed = [each.formula for each in spec.assumptions]
    return bool(assumed) and rule.formula not in assumed and bool(spec.environment & variables_of(rule.formula))


def in_order(found: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Diagnostics as their places come in the text."""
    return tuple(sorted(merged(found), key=lambda one: (one.span.line, one.span.column) if one.span else (0, 0)))
