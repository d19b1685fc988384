"""A specification's text with one more assumption."""

from __future__ import annotations

from textwrap import wrap

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax import ast, parse

_WIDTH = 120


def with_assumption(source: Source, predicate: str) -> str:
    """The text with `assume: predicate` in its ASSUMPTIONS block, or in a new one at the end; the rest stays as it is.

    The text must be a specification without errors.
    """
    lines = "\n".join(wrap(f"assume: {predicate}", _WIDTH, break_long_words=False, break_on_hyphens=False))
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


def _offset(text: str, line: int, column: int) -> int:
    start = 0
    for _ in range(line - 1):
        start = text.index("\n", start) + 1
    return start + column - 1
