"""Pieces of a source text by their spans."""

from __future__ import annotations

import re
from collections.abc import Mapping

from tumato_symbolic.diagnostics import CopySpan, Source, Span
from tumato_symbolic.diagnostics.wording import one_line

_COMMENT = re.compile(r"//[^\n]*|/\*[\s\S]*?\*/")
_BRACES = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)([+-][0-9]+)?\}")


def _value(braces: re.Match[str], values: Mapping[str, str]) -> str:
    """What stands for a parameter in braces; the braces where it is one of a quantifier, or a set."""
    value = values.get(braces[1])
    if value is None:
        return braces[0]
    return str(int(value) + int(braces[2])) if braces[2] else value


class Excerpts:
    """A source text, cut into lines once."""

    def __init__(self, source: Source) -> None:
        self._lines = source.text.split("\n")

    def of(self, span: Span) -> str:
        """The text of `span`, comments left out and white space collapsed.

        In the text of a copy, its parameters have their values.
        """
        text = self._of(span)
        if isinstance(span, CopySpan):
            values = dict(span.parameters)
            text = _BRACES.sub(lambda found: _value(found, values), text)
        return text

    def _of(self, span: Span) -> str:
        lines = self._lines[span.line - 1 : span.end_line]
        if not lines:
            return ""
        if span.end_line == span.line:
            lines = [lines[0][span.column - 1 : span.end_column - 1]]
        else:
            lines = [lines[0][span.column - 1 :], *lines[1:-1], lines[-1][: span.end_column - 1]]
        return one_line(_COMMENT.sub(" ", "\n".join(lines)))
