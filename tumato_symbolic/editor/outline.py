"""The outline of a text: its blocks, and what is declared in them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal, NamedTuple, TypeAlias

from tumato_symbolic.diagnostics import Source, Span
from tumato_symbolic.spec.names import KINDS
from tumato_symbolic.syntax import ast, parse

EntryKind: TypeAlias = Literal[
    "block", "copies", "state variable", "alias", "named list", "resource", "action", "rule", "goal"
]

_LONGEST = 60
"""Characters of an entry in the outline; more are cut off."""


class Entry(NamedTuple):
    """Something with a name or a title; `name_span` is the part of its span that shows it."""

    name: str
    kind: EntryKind
    span: Span
    name_span: Span
    entries: tuple[Entry, ...] = ()


def outline(source: Source) -> tuple[Entry, ...]:
    """The blocks of a text, which may have mistakes, as far as they can be read."""
    tree = parse(source).tree
    lines = source.text.split("\n")
    return tuple(_block(block, lines) for block in tree.blocks) if tree is not None else ()


def _block(block: ast.Block, lines: list[str]) -> Entry:
    span = block.span
    title = lines[span.line - 1][span.column - 1 :].split("//")[0].removeprefix("BEGIN").strip() or type(block).__name__
    entries: Iterable[object] = getattr(block, block.__struct_fields__[0])
    if isinstance(block, ast.Goals):
        entries = block.goals.members
    return Entry(title, "block", span, _first_line(span, lines), tuple(_entries(entries, lines)))


def _entries(entries: Iterable[object], lines: list[str]) -> Iterator[Entry]:
    for each in entries:
        if type(each) in KINDS:
            name: ast.Name = each.name  # type: ignore[attr-defined]
            yield Entry(name.text, KINDS[type(each)], each.span, name.span)  # type: ignore[attr-defined]
        elif isinstance(each, ast.Copies):
            here = _first_line(each.span, lines)
            yield Entry(_text(here, lines), "copies", each.span, here, tuple(_entries(each.entries, lines)))
        elif isinstance(each, ast.Node) and not isinstance(each, ast.Severity):
            here = _first_line(each.span, lines)
            goal = isinstance(each, ast.SimpleGoal | ast.ConditionalGoal | ast.GoalList)
            inner = tuple(_entries(each.members, lines)) if isinstance(each, ast.GoalList) else ()
            yield Entry(_text(here, lines), "goal" if goal else "rule", each.span, here, inner)


def _first_line(span: Span, lines: list[str]) -> Span:
    end = span.end_column if span.end_line == span.line else len(lines[span.line - 1]) + 1
    return Span(span.line, span.column, span.line, end)


def _text(span: Span, lines: list[str]) -> str:
    text = lines[span.line - 1][span.column - 1 : span.end_column - 1].strip()
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
