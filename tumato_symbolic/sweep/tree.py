"""Looking for nodes in the tree of a specification as it is written, copies and all."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

from tumato_symbolic.syntax import ast

Found = TypeVar("Found", bound=ast.Node)


def below(node: object, kind: type[Found]) -> Iterator[Found]:
    """Every node of a kind at or below another, in the order of the text."""
    if isinstance(node, kind):
        yield node
    if isinstance(node, tuple):
        for each in node:
            yield from below(each, kind)
    elif isinstance(node, ast.Node):
        for name in node.__struct_fields__:
            yield from below(getattr(node, name), kind)
