"""Mistakes that `--mutate` makes inside of a predicate or an effect."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final, TypeAlias, TypeVar

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.sweep.tree import below
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.printer import print_predicate

Part = TypeVar("Part")

Replacement: TypeAlias = tuple[Span, str]
"""A place, and what stands there by mistake."""

_MOST_VALUES = 1_000
"""Ranges of more values are left alone."""

_BRACES: Final = re.compile(r"\{[^}]*\}")
_OTHER: Final[dict[ast.Operator, ast.Operator]] = {
    "<": "<=",
    "<=": "<",
    ">": ">=",
    ">=": ">",
    "=": "!=",
    "!=": "=",
}
"""Off by one, or the contrary."""


class Domains:
    """The values that variables are declared with, as they are written."""

    def __init__(self, tree: ast.Specification) -> None:
        declared = below(tree, ast.VariableDeclaration)
        self._values = {_named(each.name): tuple(_texts(each.values)) for each in declared}

    def another(self, variable: ast.Name, value: ast.Name) -> str | None:
        """The value that is declared after another one, or first; None where that is not known."""
        values = self._values.get(_named(variable), ())
        if len(values) < 2 or value.text not in values:
            return None
        return values[(values.index(value.text) + 1) % len(values)]

    def has_two(self, variable: ast.Name) -> bool:
        """Whether there is one other value for each."""
        return len(self._values.get(_named(variable), ())) == 2


def _named(name: ast.Name) -> str:
    """A name whatever its parameters are called."""
    return _BRACES.sub("{}", name.text)


def _texts(items: Sequence[ast.Item]) -> Iterator[str]:
    for item in items:
        if isinstance(item, ast.Name):
            yield item.text
        elif "{" not in item.low.text + item.high.text:
            low, high = int(item.low.text), int(item.high.text)
            if high - low < _MOST_VALUES:
                yield from map(str, range(low, high + 1))


def wrong_predicates(predicate: ast.Predicate, domains: Domains) -> Iterator[Replacement]:
    """Replacements in a predicate and all its parts."""
    yield from _here(predicate, domains)
    match predicate:
        case ast.Conjunction(operands) | ast.Disjunction(operands):
            parts = operands
        case ast.Negation(operand):
            parts = (operand,)
        case ast.Implication(condition, consequence):
            parts = (condition, consequence)
        case ast.Equivalence(left, right):
            parts = (left, right)
        case ast.Quantifier(body=body):
            parts = (body,)
        case _:
            parts = ()
    for part in parts:
        yield from wrong_predicates(part, domains)


def _here(predicate: ast.Predicate, domains: Domains) -> Iterator[Replacement]:
    match predicate:
        case ast.Comparison(variable, value, span=span):
            yield from _another_value(predicate, domains)
            if not domains.has_two(variable):
                yield span, print_predicate(ast.Difference(variable, value))
        case ast.Difference(variable, value, span=span):
            yield from _another_value(predicate, domains)
            if not domains.has_two(variable):
                yield span, print_predicate(ast.Comparison(variable, value))
        case ast.Membership(variable, items, negated, span=span):
            yield span, print_predicate(ast.Membership(variable, items, not negated))
            for fewer in _without_each(items):
                yield span, print_predicate(ast.Membership(variable, fewer, negated))
        case ast.Ordering(variable, operator, other, span=span):
            yield span, print_predicate(ast.Ordering(variable, _OTHER[operator], other))
        case ast.Execution(span=span) | ast.Reference(span=span):
            yield span, f"NOT {print_predicate(predicate)}"
        case ast.Negation(operand, span=span):
            yield span, f"({print_predicate(operand)})"
        case _:
            yield from _compound(predicate)


def _compound(predicate: ast.Predicate) -> Iterator[Replacement]:
    """In the place of connectives and quantifiers, others; of their parts, fewer."""
    match predicate:
        case ast.Conjunction(operands, span=span):
            others: list[ast.Predicate] = [ast.Disjunction(operands)]
            others += [each[0] if len(each) == 1 else ast.Conjunction(each) for each in _without_each(operands)]
        case ast.Disjunction(operands, span=span):
            others = [ast.Conjunction(operands)]
            others += [each[0] if len(each) == 1 else ast.Disjunction(each) for each in _without_each(operands)]
        case ast.Implication(condition, consequence, span=span):
            others = [consequence, ast.Implication(consequence, condition)]
        case ast.Equivalence(left, right, span=span):
            others = [ast.Implication(left, right), ast.Implication(right, left)]
        case ast.Quantifier(kind, header, body, span=span):
            others = [ast.Quantifier("some" if kind == "all" else "all", header, body)]
        case _:
            return
    yield from ((span, f"({print_predicate(each)})") for each in others)


def wrong_effects(effect: ast.Effect, domains: Domains) -> Iterator[Replacement]:
    """Another value in the place of each, and a change the other way round."""
    for part in below(effect, ast.Comparison):
        yield from _another_value(part, domains)
    for change in below(effect, ast.Change):
        sign = "-" if change.sign == "+" else "+"
        value = change.value.text if isinstance(change.value, ast.Name) else change.value
        yield change.span, f"{change.variable.text} is {change.origin.text} {sign} {value}"


def _another_value(atom: ast.Comparison | ast.Difference, domains: Domains) -> Iterator[Replacement]:
    other = domains.another(atom.variable, atom.value)
    if other is not None:
        yield atom.span, print_predicate(type(atom)(atom.variable, ast.Name(other)))


def _without_each(parts: tuple[Part, ...]) -> Iterator[tuple[Part, ...]]:
    """The parts but one, where there are several."""
    if len(parts) > 1:
        yield from (parts[:place] + parts[place + 1 :] for place in range(len(parts)))
