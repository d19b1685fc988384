"""Bottom-up construction of the tree: one function per rule of the grammar, called by its name. See `Rule.node`."""

# The functions are named and explained by the rules; what they are given depends on the rule.
# ruff: noqa: D103, ANN401

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, TypeAlias, TypeVar

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.tokens import Token

One = TypeVar("One")

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
    return ast.Name(token.text, span=token.span) if "{" in token.text else int(token.text)


def _of_all(kind: Callable[..., One]) -> Callable[[Children], One]:
    """Makes nodes of one field: all nodes below."""
    return lambda children: kind(_nodes(children), span=_span(children))


def _of_each(kind: Callable[..., One]) -> Callable[[Children], One]:
    """Makes nodes of a field for each node below."""
    return lambda children: kind(*_nodes(children), span=_span(children))


def _of_first_and_others(kind: Callable[..., One]) -> Callable[[Children], One]:
    """Makes nodes of two fields: the first node below, and all others."""

    def made(children: Children) -> One:
        first, *others = _nodes(children)
        return kind(first, tuple(others), span=_span(children))

    return made


def _of_number(kind: Callable[..., One]) -> Callable[[Children], One]:
    """Makes nodes of one field: the number at the end."""
    return lambda children: kind(_number(children[-1]), span=_span(children))


def _of_word(kind: Callable[..., One]) -> Callable[[Children], One]:
    """Makes nodes of one field: the word at the end, one of those that the grammar lists."""
    return lambda children: kind(children[-1].text, span=_span(children))


state_vector = _of_all(ast.StateVector)
aliases = _of_all(ast.Aliases)
resources = _of_all(ast.Resources)
actions = _of_all(ast.Actions)
reaction_rules = _of_all(ast.ReactionRules)
state_rules = _of_all(ast.StateRules)
assumptions = _of_all(ast.Assumptions)
start = _of_all(ast.Start)
config = _of_all(ast.Config)
controlled_resources = _of_all(ast.ControlledResources)
preconditions = _of_all(ast.Preconditions)
disjunction = _of_all(ast.Disjunction)
conjunction = _of_all(ast.Conjunction)
specification = _of_all(ast.Specification)

goals = _of_each(ast.Goals)
alias = _of_each(ast.AliasDefinition)
resource = _of_each(ast.ResourceDeclaration)
simple_goal = _of_each(ast.SimpleGoal)
conditional_goal = _of_each(ast.ConditionalGoal)
equivalence = _of_each(ast.Equivalence)
implies = _of_each(ast.Implication)
denied = _of_each(ast.Negation)
comparison = _of_each(ast.Comparison)
difference = _of_each(ast.Difference)
range = _of_each(ast.Range)
execution = _of_each(ast.Execution)
reference = _of_each(ast.Reference)

variable = _of_first_and_others(ast.VariableDeclaration)
named_list = _of_first_and_others(ast.NamedList)
action = _of_first_and_others(ast.ActionDeclaration)
clause = _of_first_and_others(ast.Clause)
copies = _of_first_and_others(ast.Copies)
copied_variables = copied_aliases = copied_resources = copied_actions = copied_fields = copied_clauses = copies
copied_rules = copied_assumptions = copied_starts = copied_goals = copied_settings = copies

duration = _of_number(ast.Duration)
severity = _of_number(ast.Severity)
max_plan_length = _of_number(ast.MaxPlanLength)

effect_ordering = _of_word(ast.EffectOrdering)
restoration = _of_word(ast.Restoration)
preconditions_hold = _of_word(ast.PreconditionsHold)


def nominal_effects(children: Children) -> ast.NominalEffects:
    return ast.NominalEffects(*_effects_and_clauses(children), span=_span(children))


def alternative_effects(children: Children) -> ast.AlternativeEffects:
    return ast.AlternativeEffects(*_effects_and_clauses(children), span=_span(children))


def _effects_and_clauses(children: Children) -> tuple[tuple[ast.Effect, ...], tuple[ast.Clause | ast.Copies, ...]]:
    nodes = _nodes(children)
    clauses = tuple(node for node in nodes if isinstance(node, ast.Clause | ast.Copies))
    return nodes[: len(nodes) - len(clauses)], clauses


def change(children: Children) -> ast.Change:
    variable, _, origin, *amount = children
    text = amount[-1].text if len(amount) > 1 else amount[0].text[1:]
    value = ast.Name(text, span=amount[-1].span) if "{" in text else int(text)
    return ast.Change(variable, origin, "+" if amount[0].text[0] == "+" else "-", value, span=_span(children))


def rule(children: Children) -> ast.Predicate:
    predicate: ast.Predicate = children[-1]
    return predicate


assumption = start_condition = rule


def goal_list(children: Children) -> ast.GoalList:
    if len(children) == len(("BEGIN", "GOALS", "END", "GOALS")):
        return ast.GoalList(None, (), span=_span(children))
    kind = children[len(("BEGIN", "GOALS", "goal", "type", ":"))]
    return ast.GoalList("priority" if kind.text == "priority" else "constraint", _nodes(children), span=_span(children))


def group(children: Children) -> ast.Predicate:
    """A predicate in parentheses is the predicate; its span takes the parentheses in."""
    inner: ast.Predicate = replace(children[1], span=_span(children))
    return inner


def membership(children: Children) -> ast.Membership:
    variable, *items = _nodes(children)
    return ast.Membership(variable, tuple(items), children[1].text == "not", span=_span(children))


def ordering(children: Children) -> ast.Ordering:
    variable, operator, other = children
    return ast.Ordering(variable, operator.text, other, operator.span, span=_span(children))


def number(children: Children) -> ast.Name:
    return ast.Name(children[0].text, span=children[0].span)


def header(children: Children) -> ast.Header:
    """The parameters, each from a name with `in` after it to the next such name, and the conditions."""
    parts = [part for part in children if not isinstance(part, ast.Condition)]
    starts = [place - 1 for place, part in enumerate(parts) if isinstance(part, Token) and part.text == "in"]
    parameters = []
    for start, end in pairwise([*starts, len(parts)]):
        braced = isinstance(parts[start + 2], Token)
        items = _nodes(parts[start + 2 : end])
        last = items[-1]
        parameters.append(ast.Parameter(parts[start], items, braced, span=_span([parts[start], last])))
    conditions = tuple(part for part in children if isinstance(part, ast.Condition))
    return ast.Header(tuple(parameters), conditions, span=_span(children))


def condition(children: Children) -> ast.Condition:
    left, operator, right = children
    return ast.Condition(left, operator.text, right, span=_span(children))


def operand(children: Children) -> ast.Operand:
    first = children[0]
    offset = int(children[1].text) if len(children) > 1 else 0
    return ast.Operand(ast.Name(first.text, span=first.span), offset, span=_span(children))


def quantifier(children: Children) -> ast.Quantifier:
    first = children[0].text
    return ast.Quantifier("exactly one" if first == "exactly" else first, *_nodes(children), span=_span(children))


def true(children: Children) -> ast.Truth:
    return ast.Truth(True, span=_span(children))


def false(children: Children) -> ast.Truth:
    return ast.Truth(False, span=_span(children))
