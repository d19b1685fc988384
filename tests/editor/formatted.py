"""What has to hold of a layout."""

from __future__ import annotations

from tests.editor.texts import allowances, commented, comments, plain_text
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.format import MAX_WIDTH, format_text
from tumato_symbolic.syntax import parse


def complaint(text: str) -> str | None:
    """What is wrong with the layout of a text; None if nothing is."""
    after = format_text(Source("text", text))
    checks = {
        "the tree changed": parse(Source("text", text)).tree == parse(Source("text", after)).tree,
        "comments changed": comments(text) == comments(after),
        "allowances changed": allowances(text) == allowances(after),
        "the second layout differs": format_text(Source("text", after)) == after,
        "blanks at the end of a line": all(line == line.rstrip(" \t") for line in _outside_of_comments(after)),
        "three ends of lines": "\n\n\n" not in after or "/*" in after,
        "a line is too long": "/" in text or all(len(line) <= MAX_WIDTH for line in after.split("\n")),
    }
    return next((name for name, holds in checks.items() if not holds), None)


def _outside_of_comments(text: str) -> list[str]:
    return [] if "/*" in text else text.split("\n")


def complaint_of(seed: int) -> str | None:
    """The same for the generated text of a seed."""
    return complaint(commented(plain_text(seed), seed))
