"""Places in a text as editors count them: lines from 0, and columns in code units, of UTF-16 if nothing is said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, Literal, NamedTuple, TypeAlias

from tumato_symbolic.diagnostics import Source, Span

Encoding: TypeAlias = Literal["utf-8", "utf-16", "utf-32"]

_UNITS: Final[dict[Encoding, Callable[[str], int]]] = {
    "utf-8": lambda each: len(each.encode()),
    "utf-16": lambda each: 1 + (each > "\uffff"),
    "utf-32": lambda _: 1,
}
"""How many code units a character takes."""


class Position(NamedTuple):
    """A place between two characters: `line` from 0, `character` in code units from 0."""

    line: int
    character: int


class Positions:
    """Translates between the places of a source text and those of an editor that shows `shown`."""

    def __init__(self, source: Source, shown: str = "", encoding: Encoding = "utf-16") -> None:
        self.lines = source.text.split("\n")
        self._units = _UNITS[encoding]
        self._mark = self._units("\ufeff") if shown.startswith("\ufeff") else 0

    def position(self, line: int, column: int) -> Position:
        """The editor's place of a line and column, both from 1; a place beyond the text is the end of it."""
        line = min(line, len(self.lines))
        before = self.lines[line - 1][: max(column - 1, 0)]
        mark = self._mark if line == 1 else 0
        return Position(line - 1, mark + sum(map(self._units, before)))

    def range(self, span: Span) -> tuple[Position, Position]:
        """Both ends of a span."""
        return self.position(span.line, span.column), self.position(span.end_line, span.end_column)

    def place(self, position: Position) -> tuple[int, int]:
        """The line and column, both from 1, of an editor's place; one within a character is before it."""
        if position.line >= len(self.lines):
            return len(self.lines), len(self.lines[-1]) + 1
        units = position.character - (self._mark if position.line == 0 else 0)
        text = self.lines[position.line]
        column = 0
        while column < len(text) and units >= (size := self._units(text[column])):
            units -= size
            column += 1
        return position.line + 1, column + 1
