"""Where a line that is too long may be broken."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.tokens import Token


class Break(NamedTuple):
    """A place for a line to end. Those of the least level are used first, all of them, or, in `fill`, where needed."""

    level: int
    fill: bool = False


def breaks(tree: ast.Specification, tokens: Sequence[Token]) -> dict[int, Break]:
    """The places of the tokens before which a line may end: operators, and what follows commas and colons."""
    found = _Finder({(token.line, token.column): place for place, token in enumerate(tokens)})
    found.inside(tree)
    return found.breaks


class _Finder:
    """Walks through a tree."""

    def __init__(self, places: dict[tuple[int, int], int]) -> None:
        self._places = places
        self.breaks: dict[int, Break] = {}

    def inside(self, node: object) -> None:
        """Find every entry, and the places in it."""
        match node:
            case tuple():
                for each in node:
                    self.inside(each)
            case ast.VariableDeclaration(_, items) | ast.NamedList(_, items) | ast.ControlledResources(items):
                self._listed(items, Break(0, fill=True))
            case ast.AliasDefinition(_, predicate) | ast.SimpleGoal(predicate):
                self._predicate(predicate, 0)
            case ast.Preconditions(predicates):
                self._several(predicates, 0)
            case ast.NominalEffects(effects, clauses) | ast.AlternativeEffects(effects, clauses):
                self._several(effects, 0)
                self.inside(clauses)
            case ast.Clause(condition, effects):
                self._predicate(condition, 1)
                self._before(effects[:1], Break(0))
                self._several(effects, 1)
            case ast.ConditionalGoal(condition, goal):
                self._predicate(condition, 0)
                self.inside(goal)
            case ast.Copies(header, entries):
                self._header(header, 0)
                self.inside(entries)
            case ast.Name() | Span():
                pass
            case _ if _is_predicate(node):
                self._predicate(node, 0)
            case ast.Node():
                for name in node.__struct_fields__:
                    self.inside(getattr(node, name))

    def _before(self, nodes: Sequence[ast.Node], where: Break, operator: bool = False) -> None:
        """Before each of some nodes, or before the operator in front of it."""
        for node in nodes:
            self.breaks[self._places[node.span.line, node.span.column] - operator] = where

    def _listed(self, items: Sequence[ast.Node], where: Break) -> None:
        self._before(items[1:], where)

    def _several(self, effects: Sequence[ast.Effect], level: int) -> None:
        """What stands between commas."""
        self._before(effects[1:], Break(level))
        for each in effects:
            self._predicate(each, level + 1)

    def _header(self, header: ast.Header, level: int) -> None:
        """The parameters of copies, and their conditions."""
        self._before([each.left for each in header.conditions[:1]], Break(level), operator=True)
        self._before([each.left for each in header.conditions[1:]], Break(level + 1))
        self._before([each.name for each in header.parameters[1:]], Break(level + 1))
        for each in header.parameters:
            self._listed(each.items, Break(level + 2, fill=True))

    def _predicate(self, predicate: object, level: int) -> None:
        match predicate:
            case ast.Equivalence(left, right) | ast.Implication(left, right):
                self._operands((left, right), level)
            case ast.Disjunction(operands) | ast.Conjunction(operands):
                self._operands(operands, level)
            case ast.Negation(operand):
                self._predicate(operand, level)
            case ast.Quantifier(_, header, body):
                self._before([body], Break(level))
                self._header(header, level + 1)
                self._predicate(body, level + 1)
            case ast.Membership(_, items):
                self._listed(items, Break(level, fill=True))

    def _operands(self, operands: Sequence[ast.Predicate], level: int) -> None:
        self._before(operands[1:], Break(level), operator=True)
        for each in operands:
            self._predicate(each, level + 1)


def _is_predicate(node: object) -> bool:
    return isinstance(node, ast.Predicate)
