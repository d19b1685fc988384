"""Warnings about a text: what always or never holds, resources and aliases that nothing uses, what is missing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import prod

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.by_action import executing_actions
from tumato_symbolic.spec.fold import subgoals
from tumato_symbolic.spec.forgotten import forgotten
from tumato_symbolic.spec.formula import And, Constant, Formula, Not
from tumato_symbolic.spec.resolve import Resolution, heading
from tumato_symbolic.spec.satisfiability import Budget, OutOfBudgetError, models, unknowns
from tumato_symbolic.spec.specification import ConditionalGoal, Rule, Spec
from tumato_symbolic.syntax import ast

MAX_DECIDED = 100_000
"""The most assignments to the variables and actions of a predicate with which it is decided."""

MAX_LINT_WORK = 2_000_000
"""How many terms are looked at to decide predicates, for a whole specification; the rest is left undecided."""


def lint(spec: Spec, tree: ast.Specification, resolution: Resolution) -> tuple[Diagnostic, ...]:
    """Every warning about a specification without errors."""
    return (
        *_unused(spec, resolution),
        *_missing(spec, tree),
        *_decided(spec),
        *forgotten(spec, resolution.used_variables),
    )


def _unused(spec: Spec, resolution: Resolution) -> Iterator[Diagnostic]:
    used = frozenset[int]().union(*(action.resources for action in spec.actions))
    for number, resource in enumerate(resolution.names.resources):
        if number not in used:
            message = f"no action controls the resource {quoted(resource.name.text)}"
            yield Diagnostic(Code.TUM321, message, resource.name.span, "remove it, or control it where it is needed")
    for number, alias in enumerate(resolution.names.aliases):
        if number not in resolution.used_aliases:
            message = f"nothing uses the alias {quoted(alias.name.text)}"
            yield Diagnostic(Code.TUM322, message, alias.name.span, "remove it, or use it")


def _missing(spec: Spec, tree: ast.Specification) -> Iterator[Diagnostic]:
    end = Span(tree.span.end_line, tree.span.end_column, tree.span.end_line, tree.span.end_column)
    if not spec.actions:
        place = next((heading(each.span, "ACTIONS") for each in tree.blocks if isinstance(each, ast.Actions)), end)
        yield Diagnostic(Code.TUM325, "there are no actions: nothing can ever change", place)
    if spec.goals is None:
        place = next((heading(each.span, "GOALS") for each in tree.blocks if isinstance(each, ast.Goals)), end)
        yield Diagnostic(Code.TUM326, "there are no goals: every allowed step will do", place)
    for block in tree.blocks:
        for action in ast.one_by_one(block.actions) if isinstance(block, ast.Actions) else ():
            if not any(isinstance(field, ast.NominalEffects) for field in action.fields):
                message = f"the action {quoted(action.name.text)} has no nominal effects"
                yield Diagnostic(
                    Code.TUM327, message, action.name.span, "write `nominal effects: none` if that is meant"
                )
            yield from _implications(action)


def _implications(action: ast.ActionDeclaration) -> Iterator[Diagnostic]:
    """Effects that read as if they depended on the state before."""
    fields: Iterator[ast.Field] = ast.one_by_one(action.fields)
    for field in fields:
        for each in field.effects if isinstance(field, ast.NominalEffects | ast.AlternativeEffects) else ():
            if isinstance(each, ast.Implication):
                from tumato_symbolic.syntax.habits import CONDITIONAL_EFFECT

                message = "an effect speaks of the state afterwards, and so does the condition of this one"
                yield Diagnostic(Code.TUM348, message, each.span, CONDITIONAL_EFFECT)


def _decided(spec: Spec) -> Iterator[Diagnostic]:
    """Predicates that their own variables decide."""
    sizes = {number: len(each.values) for number, each in enumerate(spec.variables)}
    constants = _Constants(sizes)
    for action in (spec.actions[cases[0]] for cases in spec.cases):
        single = [each for rule in action.preconditions for each in constants.of(rule, "precondition")]
        yield from single
        if not single and len(action.preconditions) > 1:
            yield from constants.together(action.preconditions, action.name)
    for rule in (*_by_action(spec, spec.reaction_rules), *spec.state_rules):
        yield from constants.of(rule, "rule")
    for rule in spec.assumptions:
        yield from constants.of(rule, "assumption")
    for rule in spec.starts:
        yield from constants.of(rule, "start condition")
    for goal in subgoals(spec.goals):
        if isinstance(goal, ConditionalGoal):
            yield from constants.of(goal.condition, "condition")
    for rule in _by_action(spec, spec.bodies):
        yield from constants.of(rule, "goal")


def _by_action(spec: Spec, rules: Sequence[Rule]) -> Iterator[Rule]:
    """Rules that speak of the first case of an action in the place of all of them: it is executed, or it is not."""
    return (replace(rule, formula=executing_actions(spec, rule.formula)) for rule in rules)


class _Constants:
    """Decides predicates within one budget."""

    def __init__(self, sizes: dict[int, int]) -> None:
        self._sizes = sizes
        self._budget = Budget(MAX_LINT_WORK)

    def of(self, rule: Rule, kind: str) -> Iterator[Diagnostic]:
        """The warning about one predicate, if it deserves one; a plain `true` is meant."""
        if rule.formula == Constant(True):
            return
        if self._possible(rule.formula) is False:
            yield Diagnostic(Code.TUM324, f"this {kind} is never true", rule.span, _NEVER[kind])
        elif self._possible(Not(rule.formula)) is False:
            yield Diagnostic(Code.TUM323, f"this {kind} is always true", rule.span, _ALWAYS[kind])

    def together(self, rules: Sequence[Rule], action: str) -> Iterator[Diagnostic]:
        """The warning about preconditions that exclude each other."""
        if self._possible(And(tuple(rule.formula for rule in rules))) is False:
            yield Diagnostic(
                Code.TUM324,
                f"the preconditions of {quoted(action)} are never true together",
                Span(rules[0].span.line, rules[0].span.column, rules[-1].span.end_line, rules[-1].span.end_column),
                "a comma means AND; for alternatives write OR",
            )

    def _possible(self, formula: Formula) -> bool | None:
        """Whether a formula can be true; None where that is not decided here."""
        count = prod(self._sizes[number] if kind == "variable" else 2 for kind, number in unknowns(formula))
        if count > MAX_DECIDED:
            return None
        try:
            return next(models(formula, self._sizes, self._budget), None) is not None
        except OutOfBudgetError:
            return None


_NEVER = {
    "precondition": "the action can never be executed",
    "rule": "no state and no set of actions can keep it",
    "assumption": "no state is valid",
    "start condition": "no state is a start because of it",
    "condition": "the goal is never entered",
    "goal": "it can never be reached",
}
_ALWAYS = {
    "precondition": "it excludes nothing; remove it or correct it",
    "rule": "it excludes nothing; remove it or correct it",
    "assumption": "it excludes nothing; remove it or correct it",
    "start condition": "every valid state is a start then, as without a START block",
    "condition": "leave the condition out or correct it",
    "goal": "write `goal: true` where there is nothing to reach",
}
