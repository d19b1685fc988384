"""Changes of a text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from tumato_symbolic.diagnostics import Source, Span


class Edit(NamedTuple):
    """A place in a text, and what is to stand there."""

    span: Span
    text: str


def edited(source: Source, edits: Iterable[Edit]) -> str:
    """The text with edits made, no two of which overlap."""
    lines = source.text.split("\n")
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line) + 1)
    text = source.text
    for span, new in sorted(edits, key=lambda each: (each.span.line, each.span.column), reverse=True):
        begin, end = starts[span.line - 1] + span.column - 1, starts[span.end_line - 1] + span.end_column - 1
        text = text[:begin] + new + text[end:]
    return text


def at(line: int, column: int) -> Span:
    """A place between two characters, where something may be inserted."""
    return Span(line, column, line, column)


def whole(source: Source) -> Span:
    """The span of all text."""
    lines = source.text.split("\n")
    return Span(1, 1, len(lines), len(lines[-1]) + 1)
