"""Diagnostics as text for a person: the line, what is underlined in it, notes, the way out, colours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from tumato_symbolic.diagnostics.codes import Severity
from tumato_symbolic.diagnostics.diagnostic import Diagnostic, Source, Span

MAX_SHOWN = 20
"""The most diagnostics that are written out; the rest is counted."""

MAX_WIDTH = 110
"""The most characters of a source line that are shown."""

_RED, _YELLOW, _BLUE, _GREEN, _BOLD, _PLAIN = "31;1", "33;1", "34;1", "32;1", "1", "0"

_HUES: Final[dict[Severity, str]] = {"error": _RED, "warning": _YELLOW, "remark": _BLUE}
"""The colours of severities, the worst first."""


def render(diagnostics: Iterable[Diagnostic], source: Source | None, color: bool = False) -> str:
    """Every diagnostic with its code, its place, the source line with the span underlined, notes and the way out.

    Errors come before warnings, and these before remarks, where there are too many to show all. The text ends with a
    line feed, or is empty.
    """
    found = tuple(diagnostics)
    shown = found
    if len(found) > MAX_SHOWN:
        shown = tuple(sorted(found, key=lambda each: list(_HUES).index(each.severity)))[:MAX_SHOWN]
    drawing = _Drawing(source, color)
    parts = ["".join(f"{line}\n" for line in drawing.lines(each)) for each in shown]
    if len(found) > len(shown):
        parts.append(f"and {len(found) - len(shown)} more\n")
    return "\n".join(parts)


class _Drawing:
    """Draws diagnostics that point into one source."""

    def __init__(self, source: Source | None, color: bool) -> None:
        self._name = source.name if source is not None else None
        self._text = source.text.split("\n") if source is not None else []
        self._color = color

    def lines(self, diagnostic: Diagnostic) -> Iterator[str]:
        """One diagnostic, line by line."""
        hue = _HUES[diagnostic.severity]
        head = self._dyed(f"{diagnostic.severity}[{diagnostic.code.name}]", hue)
        yield f"{head}{self._dyed(': ' + diagnostic.message, _BOLD)}"
        if diagnostic.span is not None:
            yield from self._place(diagnostic.span, hue, "^")
        elif self._name is not None:
            yield f"  {self._dyed('-->', _BLUE)} {visible(self._name)}"
        for note in diagnostic.notes:
            yield f"  {self._dyed('note', _BLUE)}: {note.message}"
            yield from self._place(note.span, _BLUE, "-")
        if diagnostic.help is not None:
            yield f"  {self._dyed('help', _GREEN)}: {diagnostic.help}"

    def _place(self, span: Span, hue: str, mark: str) -> Iterator[str]:
        """`file:line:column`, the line, and the span underlined; a span of several lines is marked on its first."""
        name = f"{visible(self._name)}:" if self._name is not None else "line "
        yield f"  {self._dyed('-->', _BLUE)} {name}{span.line}:{span.column}"
        if span.line > len(self._text):
            return
        line = self._text[span.line - 1].rstrip("\r")
        end = span.end_column if span.end_line == span.line else len(line) + 1
        start = min(span.column, len(line) + 1)
        line, start, end = _clipped(line, start, max(end, start + 1))
        number = str(span.line)
        bar = self._dyed("|", _BLUE)
        yield f" {self._dyed(number, _BLUE)} {bar} {visible(line)}"
        yield f" {' ' * len(number)} {bar} {' ' * (start - 1)}{self._dyed(mark * (end - start), hue)}"

    def _dyed(self, text: str, hue: str) -> str:
        return f"\x1b[{hue}m{text}\x1b[{_PLAIN}m" if self._color else text


def _clipped(line: str, start: int, end: int) -> tuple[str, int, int]:
    """The part of a long line around the columns from `start` to `end`, and these columns in it."""
    if len(line) <= MAX_WIDTH:
        return line, start, end
    first = max(0, min(start - 1 - MAX_WIDTH // 3, len(line) - MAX_WIDTH))
    piece = line[first : first + MAX_WIDTH]
    before, after = "…" if first else "", "…" if first + MAX_WIDTH < len(line) else ""
    shift = len(before) - first
    return before + piece + after, start + shift, min(end + shift, len(before) + len(piece) + 1)


def visible(text: str | None) -> str:
    """A text in which everything has one column and nothing steers a terminal."""
    return "".join(each if each.isprintable() else " " if each == "\t" else "\ufffd" for each in text or "")
