"""Warnings that need the whole state space, by diagrams; `semantics.lint` finds the same state by state."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.game import Problem
from tumato_symbolic.semantics.lint_findings import (
    SETS,
    STATES,
    goals_to_reach,
    idle_action,
    idle_goal,
    idle_rule,
    in_order,
    keeps_guard,
    reached_goal,
)
from tumato_symbolic.spec import TRUE, ConditionalGoal
from tumato_symbolic.symbolic import compatible_sets, meant_sets, never_entered


def lint(problem: Problem) -> tuple[Diagnostic, ...]:
    """Goals that are never entered, rules that nothing breaks, actions that are allowed nowhere; in source order.

    What a predicate's own variables decide is left out: that is said when the specification is read. With one action at
    a time, it is not known what larger sets break, and where they are allowed.
    """
    return in_order(
        [
            *_idle_goals(problem),
            *_reached_goals(problem),
            *_idle_rules(problem),
            *_idle_actions(problem),
        ]
    )


def _idle_goals(problem: Problem) -> Iterator[Diagnostic]:
    encoding = problem.encoding
    for goal in never_entered(encoding, problem.steps.valid):
        condition = goal.condition.formula if isinstance(goal, ConditionalGoal) else TRUE
        if (encoding.formula(condition) & encoding.domain()) != problem.false:
            yield idle_goal(goal)


def _reached_goals(problem: Problem) -> Iterator[Diagnostic]:
    encoding, valid = problem.encoding, problem.steps.valid
    for body, when in goals_to_reach(problem.spec):
        active, missed = encoding.formula(when) & valid, ~encoding.formula(body.formula)
        if active != problem.false and (active & missed) == problem.false != (encoding.domain() & missed):
            yield reached_goal(body)


def _idle_rules(problem: Problem) -> Iterator[Diagnostic]:
    encoding, steps = problem.encoding, problem.steps
    everything = encoding.domain() & compatible_sets(encoding) & meant_sets(encoding)
    reaction_rules = () if steps.one_at_a_time else problem.spec.reaction_rules
    for rules, tried, where in (
        (problem.spec.state_rules, steps.valid, STATES),
        (reaction_rules, steps.candidates, SETS),
    ):
        for rule in rules:
            if keeps_guard(problem.spec, rule):
                continue
            broken = ~encoding.formula(rule.formula)
            if (broken & tried) == problem.false and (broken & everything) != problem.false:
                yield idle_rule(rule, where)


def _idle_actions(problem: Problem) -> Iterator[Diagnostic]:
    encoding = problem.encoding
    if problem.steps.one_at_a_time:
        return
    somewhere = encoding.manager.exists(encoding.all_state_bits, problem.steps.allowed)
    for cases in problem.spec.cases:
        if (somewhere & encoding.executing_any(cases)) == problem.false:
            yield idle_action(problem.spec.actions[cases[0]])
