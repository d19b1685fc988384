"""The text that `explain --write` writes: a specification with one more assumption, or other starts."""

from __future__ import annotations

from textwrap import wrap

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax import ast, parse

_WIDTH = 120
"""Columns of a line that is added to a text."""


def with_assumption(source: Source, predicate: str) -> str:
    """The text with `assume: predicate` in its ASSUMPTIONS block, or in a new one at the end; the rest stays as it is.

    The text must be a specification without errors.
    """
    lines = _wrapped(f"assume: {predicate}")
    text, tree = source.text, parse(source).tree
    assert tree is not None, "a specification that was explained can be read"
    block = next((each for each in tree.blocks if isinstance(each, ast.Assumptions)), None)
    if block is None:
        gap = "" if text.endswith("\n") else "\n"
        return f"{text}{gap}\nBEGIN ASSUMPTIONS\n{lines}\nEND ASSUMPTIONS\n"
    place = _offset(text, block.span.end_line, block.span.end_column)
    place = text.rindex("END", 0, place)
    before = text[:place]
    gap = "" if before.endswith("\n") else "\n"
    return f"{before}{gap}{lines}\n{text[place:]}"


def with_starts(source: Source, predicate: str) -> str:
    """The text with `start: predicate` in the place of all its start conditions; the rest stays as it is.

    The text must be a specification without errors, and have a START block.
    """
    text, tree = source.text, parse(source).tree
    assert tree is not None, "a specification that was explained can be read"
    blocks = [each.span for each in tree.blocks if isinstance(each, ast.Start)]
    places = [(_offset(text, s.line, s.column), _offset(text, s.end_line, s.end_column)) for s in blocks]
    for number, (begin, end) in reversed(list(enumerate(places))):
        block = "" if number else f"BEGIN START\n{_wrapped(f'start: {predicate}')}\nEND START"
        text = f"{text[:begin]}{block}{text[end:]}"
    return text


def _wrapped(line: str) -> str:
    return "\n".join(wrap(line, _WIDTH, break_long_words=False, break_on_hyphens=False))


def _offset(text: str, line: int, column: int) -> int:
    start = 0
    for _ in range(line - 1):
        start = text.index("\n", start) + 1
    return start + column - 1
