"""How deep a text may nest, so that everything after the parser may recurse over trees."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.syntax import ast

MAX_NESTING = 100
"""The most levels that parentheses, operators and goal lists may nest, each operator being one level."""

_CONTAINERS = (
    ast.Negation,
    ast.Conjunction,
    ast.Disjunction,
    ast.Implication,
    ast.Equivalence,
    ast.SimpleGoal,
    ast.ConditionalGoal,
    ast.GoalList,
    ast.Quantifier,
)


def deepest(tree: ast.Specification) -> Span | None:
    """The place of a node that lies too deep, found without recursion; None where there is none."""
    waiting: list[tuple[object, int, int]] = [(tree, 0, 0)]
    while waiting:
        node, depth, copies = waiting.pop()
        if isinstance(node, tuple):
            waiting.extend((part, depth, copies) for part in node)
            continue
        if isinstance(node, ast.Copies):
            copies += 1
            if copies > MAX_NESTING:
                return node.span
        if isinstance(node, _CONTAINERS):
            depth += 1
            if depth > MAX_NESTING:
                return node.span
        if isinstance(node, Struct) and not isinstance(node, ast.Name | Span):
            waiting.extend((getattr(node, name), depth, copies) for name in node.__struct_fields__)
    return None
