"""The parameters of copies and quantifiers: where each is declared, and where it stands in braces and conditions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeAlias

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.spec.parameters import BRACES
from tumato_symbolic.syntax import ast


class ParameterPlace(NamedTuple):
    """A parameter at a place. Those of one name are told apart by where they are declared."""

    name: str
    declared: Span
    span: Span


_Scope: TypeAlias = Mapping[str, Span]
"""Where the parameters are declared that are known at a place."""


def parameter_places(node: object, scope: _Scope | None = None) -> Iterator[ParameterPlace]:
    """All of them below a node of a tree in which copies are not written out."""
    scope = scope or {}
    match node:
        case tuple():
            for each in node:
                yield from parameter_places(each, scope)
        case ast.Copies(header, body) | ast.Quantifier(_, header, body):
            inner = {**scope, **{each.name.text: each.name.span for each in header.parameters}}
            yield from (ParameterPlace(each.name.text, each.name.span, each.name.span) for each in header.parameters)
            for parameter in header.parameters:
                yield from parameter_places(parameter.items, scope)
            for condition in header.conditions:
                for side in (condition.left.name, condition.right.name):
                    if side.text in inner:
                        yield ParameterPlace(side.text, inner[side.text], side.span)
            yield from parameter_places(body, inner)
        case ast.Name(text, span=span):
            for found in BRACES.finditer(text):
                if found[1] in scope:
                    column = span.column + found.start(1)
                    place = Span(span.line, column, span.line, column + len(found[1]))
                    yield ParameterPlace(found[1], scope[found[1]], place)
        case ast.Node():
            for each in node.__struct_fields__:
                if each != "span":
                    yield from parameter_places(getattr(node, each), scope)
