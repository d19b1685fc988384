"""HTML for the output of a cell: tables, and the colours of the bar at the side.

Text has the colour of the notebook, light or dark; only the bar at the side has its own.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Final, Literal, TypeAlias

Tone: TypeAlias = Literal["good", "bad", "doubt", "plain"]
"""What an answer is to the reader."""

_BARS: Final[dict[Tone, str]] = {"good": "#3a9d5d", "bad": "#d9534f", "doubt": "#c98a00", "plain": "#888888"}


def panel(tone: Tone, title: str, lines: Iterable[str] = (), body: str = "") -> str:
    """A title with lines of text below it, which are escaped, and then HTML."""
    texts = "".join(f"<div>{escape(line)}</div>" for line in lines)
    style = f"border-left:4px solid {_BARS[tone]};padding:0.2em 0.8em"
    return f'<div style="{style}"><div><strong>{escape(title)}</strong></div>{texts}{body}</div>'


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of texts, which are escaped."""
    lines = (_row("th", head), *(_row("td", row) for row in rows))
    return f'<table style="margin:0.4em 0;border-collapse:collapse">{"".join(lines)}</table>'


def _row(tag: str, cells: Sequence[str]) -> str:
    style = "text-align:left;padding:0.1em 0.8em 0.1em 0"
    return "".join(("<tr>", *(f'<{tag} style="{style}">{escape(cell)}</{tag}>' for cell in cells), "</tr>"))
