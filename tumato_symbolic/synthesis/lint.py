"""Warnings that need the whole state space: what is legal, but surely not meant."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.diagnostics import Code, Diagnostic
from tumato_symbolic.spec import ConditionalGoal
from tumato_symbolic.symbolic import never_entered
from tumato_symbolic.synthesis.problem import Problem


def suspicions(problem: Problem) -> tuple[Diagnostic, ...]:
    """Goals that are never entered, rules that nothing breaks, actions that are allowed nowhere; in source order.

    What a predicate's own variables decide is left out: that is said when the specification is read.
    """
    found = [*_idle_goals(problem), *_idle_rules(problem), *_idle_actions(problem)]
    return tuple(sorted(found, key=lambda one: (one.span.line, one.span.column) if one.span else (0, 0)))


def _idle_goals(problem: Problem) -> Iterator[Diagnostic]:
    encoding = problem.encoding
    for goal in never_entered(encoding, problem.steps.valid):
        if isinstance(goal, ConditionalGoal):
            if (encoding.formula(goal.condition.formula) & encoding.domain()) == problem.false:
                continue
            message = f"this goal is never entered: in no valid state where it is tried, `{goal.condition.text}` holds"
        else:
            message = "this goal is never entered: an earlier goal of the priority list always is"
        yield Diagnostic(Code.TUM351, message, goal.span, "remove it, or move it before the goal that hides it")


def _idle_rules(problem: Problem) -> Iterator[Diagnostic]:
    encoding, steps = problem.encoding, problem.steps
    everything = encoding.domain() & encoding.choice_domain()
    for rules, tried, where in (
        (problem.spec.state_rules, steps.valid, "valid state"),
        (problem.spec.reaction_rules, steps.candidates, "applicable set of actions in a valid state"),
    ):
        for rule in rules:
            broken = ~encoding.formula(rule.formula)
            if (broken & tried) == problem.false and (broken & everything) != problem.false:
                message = f"no {where} breaks this rule, so it changes nothing"
                yield Diagnostic(Code.TUM352, message, rule.span, "remove it, or check what it was meant to forbid")


def _idle_actions(problem: Problem) -> Iterator[Diagnostic]:
    for number, action in enumerate(problem.spec.actions):
        if (problem.steps.allowed & problem.encoding.executing(number)) == problem.false:
            message = f"`{action.name}` is allowed in no valid state, alone or together with others"
            yield Diagnostic(Code.TUM353, message, action.span, "check its preconditions, and what its effects break")
