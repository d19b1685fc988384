"""Edits that leave out an entry of a text, with what belongs to it and nothing else."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.syntax.edits import Edit
from tumato_symbolic.syntax.tokens import Token


def without_member(tokens: Sequence[Token], first: int, span: Span) -> Edit:
    """A member of a list, which begins with the token `first`, is left out with a comma beside it.

    Of a list with no other member, `none` is left.
    """
    after = next(place for place in range(first, len(tokens)) if is_after(tokens[place], span))
    if tokens[first - 1].text == ",":
        return Edit(joined(tokens[first - 1].span, span), "")
    if tokens[after].text == ",":
        start = tokens[after + 1].span
        return Edit(Span(span.line, span.column, start.line, start.column), "")
    return Edit(span, "none")


def without_entry(lines: Sequence[str], tokens: Sequence[Token], first: int, span: Span) -> Edit:
    """A predicate, which begins with the token `first`, is left out with its keyword, as in `rule: PREDICATE`."""
    return without_line(lines, joined(tokens[first - 2].span, span))


def without_line(lines: Sequence[str], span: Span) -> Edit:
    """What stands at a span is left out of the lines of a text, whole lines where nothing else stands on them."""
    before, after = lines[span.line - 1][: span.column - 1], lines[span.end_line - 1][span.end_column - 1 :]
    if before.strip() or after.strip() or span.end_line == len(lines):
        return Edit(span, "")
    return Edit(Span(span.line, 1, span.end_line + 1, 1), "")


def places_of(tokens: Sequence[Token]) -> dict[tuple[int, int], int]:
    """Which token begins at a line and column."""
    return {(each.line, each.column): place for place, each in enumerate(tokens)}


def is_after(token: Token, span: Span) -> bool:
    """Whether a token stands behind a span."""
    return token.kind == "end" or (token.line, token.column) >= (span.end_line, span.end_column)


def joined(first: Span, last: Span) -> Span:
    """From the beginning of one span to the end of another."""
    return Span(first.line, first.column, last.end_line, last.end_column)
