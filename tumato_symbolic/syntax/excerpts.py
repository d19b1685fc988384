"""Pieces of a source text by their spans."""

from __future__ import annotations

import re

from tumato_symbolic.diagnostics import Source, Span

_COMMENT = re.compile(r"//[^\n]*|/\*[\s\S]*?\*/")


class Excerpts:
    """A source text, cut into lines once."""

    def __init__(self, source: Source) -> None:
        self._lines = source.text.split("\n")

    def of(self, span: Span) -> str:
        """The text of `span`, comments left out and white space collapsed."""
        lines = self._lines[span.line - 1 : span.end_line]
        if not lines:
            return ""
        if span.end_line == span.line:
            lines = [lines[0][span.column - 1 : span.end_column - 1]]
        else:
            lines = [lines[0][span.column - 1 :], *lines[1:-1], lines[-1][: span.end_column - 1]]
        return " ".join(_COMMENT.sub(" ", "\n".join(lines)).split())
