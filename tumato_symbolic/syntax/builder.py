"""Bottom-up construction of the tree: one function per rule of the grammar, called by its name. See `Rule.node`.

Longer than 300 lines because the grammar has so many rules: a function is a line or two.
"""

# The functions are named and explained by the rules; what they are given depends on the rule.
# ruff: noqa: D103, ANN401

from __future__ import annotations

from itertools import pairwise
from typing import Any, TypeAlias

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.tokens import Token

Children: TypeAlias = list[Any]
"""What stands for the right side of a rule: keyword tokens, names, and nodes that are already built."""


def span_of(part: Any) -> Span:
    """The range of a token or a node."""
    span: Span = part.span
    return span


def _span(children: Children) -> Span:
    if not children:
        return ast.NOWHERE
    first, last = span_of(children[0]), span_of(children[-1])
    return Span(first.line, first.column, last.end_line, last.end_column)


def _nodes(children: Children) -> tuple[Any, ...]:
    return tuple(child for child in children if not isinstance(child, Token))


def _number(token: Token) -> int | ast.Name:
    return ast.Name(token.text, token.span) if "{" in token.text else int(token.text)


def specification(children: Children) -> ast.Specification:
    return ast.Specification(tuple(children), _span(children))


def state_vector(children: Children) -> ast.StateVector:
    return ast.StateVector(_nodes(children), _span(children))


def aliases(children: Children) -> ast.Aliases:
    return ast.Aliases(_nodes(children), _span(children))


def resources(children: Children) -> ast.Resources:
    return ast.Resources(_nodes(children), _span(children))


def actions(children: Children) -> ast.Actions:
    return ast.Actions(_nodes(children), _span(children))


def reaction_rules(children: Children) -> ast.ReactionRules:
    return ast.ReactionRules(_nodes(children), _span(children))


def state_rules(children: Children) -> ast.StateRules:
    return ast.StateRules(_nodes(children), _span(children))


def assumptions(children: Children) -> ast.Assumptions:
    return ast.Assumptions(_nodes(children), _span(children))


def start(children: Children) -> ast.Start:
    return ast.Start(_nodes(children), _span(children))


def goals(children: Children) -> ast.Goals:
    return ast.Goals(children[0], _span(children))


def config(children: Children) -> ast.Config:
    return ast.Config(_nodes(children), _span(children))


def variable(children: Children) -> ast.VariableDeclaration:
    name, *values = _nodes(children)
    return ast.VariableDeclaration(name, tuple(values), _span(children))


def alias(children: Children) -> ast.AliasDefinition:
    name, predicate = _nodes(children)
    return ast.AliasDefinition(name, predicate, _span(children))


def named_list(children: Children) -> ast.NamedList:
    name, *items = _nodes(children)
    return ast.NamedList(name, tuple(items), _span(children))


def resource(children: Children) -> ast.ResourceDeclaration:
    return ast.ResourceDeclaration(children[1], _span(children))


def action(children: Children) -> ast.ActionDeclaration:
    name, *fields = _nodes(children)
    return ast.ActionDeclaration(name, tuple(fields), _span(children))


def duration(children: Children) -> ast.Duration:
    return ast.Duration(_number(children[-1]), _span(children))


def controlled_resources(children: Children) -> ast.ControlledResources:
    return ast.ControlledResources(_nodes(children), _span(children))


def preconditions(children: Children) -> ast.Preconditions:
    return ast.Preconditions(_nodes(children), _span(children))


def nominal_effects(children: Children) -> ast.NominalEffects:
    return ast.NominalEffects(*_effects_and_clauses(children), _span(children))


def alternative_effects(children: Children) -> ast.AlternativeEffects:
    return ast.AlternativeEffects(*_effects_and_clauses(children), _span(children))


def _effects_and_clauses(children: Children) -> tuple[tuple[ast.Effect, ...], tuple[ast.Clause | ast.Copies, ...]]:
    nodes = _nodes(children)
    clauses = tuple(node for node in nodes if isinstance(node, ast.Clause | ast.Copies))
    return nodes[: len(nodes) - len(clauses)], clauses


def change(children: Children) -> ast.Change:
    variable, _, origin, *amount = children
    text = amount[-1].text if len(amount) > 1 else amount[0].text[1:]
    value = ast.Name(text, amount[-1].span) if "{" in text else int(text)
    return ast.Change(variable, origin, "+" if amount[0].text[0] == "+" else "-", value, _span(children))


def clause(children: Children) -> ast.Clause:
    condition, *effects = _nodes(children)
    return ast.Clause(condition, tuple(effects), _span(children))


def rule(children: Children) -> ast.Predicate:
    predicate: ast.Predicate = children[-1]
    return predicate


assumption = start_condition = rule


def goal_list(children: Children) -> ast.GoalList:
    if len(children) == len(("BEGIN", "GOALS", "END", "GOALS")):
        return ast.GoalList(None, (), _span(children))
    kind = children[len(("BEGIN", "GOALS", "goal", "type", ":"))]
    return ast.GoalList("priority" if kind.text == "priority" else "constraint", _nodes(children), _span(children))


def simple_goal(children: Children) -> ast.SimpleGoal:
    return ast.SimpleGoal(children[-1], _span(children))


def conditional_goal(children: Children) -> ast.ConditionalGoal:
    condition, goal = _nodes(children)
    return ast.ConditionalGoal(condition, goal, _span(children))


def max_plan_length(children: Children) -> ast.MaxPlanLength:
    return ast.MaxPlanLength(_number(children[-1]), _span(children))


def effect_ordering(children: Children) -> ast.EffectOrdering:
    return ast.EffectOrdering("any" if children[-1].text == "any" else "first", _span(children))


def restoration(children: Children) -> ast.Restoration:
    value = children[-1].text
    return ast.Restoration(
        "bounded" if value == "bounded" else "fair" if value == "fair" else "one_step", _span(children)
    )


def preconditions_hold(children: Children) -> ast.PreconditionsHold:
    value = children[-1].text
    return ast.PreconditionsHold("throughout" if value == "throughout" else "at_start", _span(children))


def severity(children: Children) -> ast.Severity:
    return ast.Severity(_number(children[-1]), _span(children))


def equivalence(children: Children) -> ast.Equivalence:
    left, right = _nodes(children)
    return ast.Equivalence(left, right, _span(children))


def implies(children: Children) -> ast.Implication:
    condition, consequence = _nodes(children)
    return ast.Implication(condition, consequence, _span(children))


def disjunction(children: Children) -> ast.Disjunction:
    return ast.Disjunction(_nodes(children), _span(children))


def conjunction(children: Children) -> ast.Conjunction:
    return ast.Conjunction(_nodes(children), _span(children))


def denied(children: Children) -> ast.Negation:
    return ast.Negation(children[-1], _span(children))


def group(children: Children) -> ast.Predicate:
    """A predicate in parentheses is the predicate; its span takes the parentheses in."""
    inner: ast.Predicate = replace(children[1], span=_span(children))
    return inner


def comparison(children: Children) -> ast.Comparison:
    variable, value = _nodes(children)
    return ast.Comparison(variable, value, _span(children))


def difference(children: Children) -> ast.Difference:
    variable, value = _nodes(children)
    return ast.Difference(variable, value, _span(children))


def membership(children: Children) -> ast.Membership:
    variable, *items = _nodes(children)
    return ast.Membership(variable, tuple(items), children[1].text == "not", _span(children))


def ordering(children: Children) -> ast.Ordering:
    variable, operator, other = children
    return ast.Ordering(variable, operator.text, other, operator.span, _span(children))


def range(children: Children) -> ast.Range:
    low, high = _nodes(children)
    return ast.Range(low, high, _span(children))


def number(children: Children) -> ast.Name:
    return ast.Name(children[0].text, children[0].span)


def header(children: Children) -> ast.Header:
    """The parameters, each from a name with `in` after it to the next such name, and the conditions."""
    parts = [part for part in children if not isinstance(part, ast.Condition)]
    starts = [place - 1 for place, part in enumerate(parts) if isinstance(part, Token) and part.text == "in"]
    parameters = []
    for start, end in pairwise([*starts, len(parts)]):
        braced = isinstance(parts[start + 2], Token)
        items = _nodes(parts[start + 2 : end])
        last = items[-1]
        parameters.append(ast.Parameter(parts[start], items, braced, _span([parts[start], last])))
    conditions = tuple(part for part in children if isinstance(part, ast.Condition))
    return ast.Header(tuple(parameters), conditions, _span(children))


def condition(children: Children) -> ast.Condition:
    left, operator, right = children
    return ast.Condition(left, operator.text, right, _span(children))


def operand(children: Children) -> ast.Operand:
    first = children[0]
    offset = int(children[1].text) if len(children) > 1 else 0
    return ast.Operand(ast.Name(first.text, first.span), offset, _span(children))


def quantifier(children: Children) -> ast.Quantifier:
    first = children[0].text
    found, body = _nodes(children)
    return ast.Quantifier(
        "all" if first == "all" else "some" if first == "some" else "exactly one", found, body, _span(children)
    )


def copies(children: Children) -> ast.Copies:
    found, *entries = _nodes(children)
    return ast.Copies(found, tuple(entries), _span(children))


copied_variables = copied_aliases = copied_resources = copied_actions = copied_fields = copied_clauses = copies
copied_rules = copied_assumptions = copied_starts = copied_goals = copied_settings = copies


def execution(children: Children) -> ast.Execution:
    return ast.Execution(children[-1], _span(children))


def reference(children: Children) -> ast.Reference:
    return ast.Reference(children[0], _span(children))


def true(children: Children) -> ast.Truth:
    return ast.Truth(True, _span(children))


def false(children: Children) -> ast.Truth:
    return ast.Truth(False, _span(children))
