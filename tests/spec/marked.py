"""Specifications with the expected span written into them, between « and »."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic, Source, Span
from tumato_symbolic.spec import Loaded, load

VECTOR = "BEGIN STATE VECTOR state S can be a, b state T can be x, y, z END STATE VECTOR"
FULL = f"""{VECTOR}
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action go controlled resources: R preconditions: S is a nominal effects: S is b
END ACTIONS
BEGIN GOALS goal type: priority goal: S is b END GOALS
"""
"""Complete, without errors or warnings; cases add blocks to it."""


class Marked(Struct, frozen=True):
    """A text and the span that was marked in it, if any."""

    text: str
    span: Span | None


def unmark(text: str) -> Marked:
    """Take the marks out."""
    if "«" not in text:
        return Marked(text, None)
    before, rest = text.split("«")
    inside, after = rest.split("»")
    start, end = _position(before), _position(before + inside)
    return Marked(before + inside + after, Span(*start, *end))


def _position(text: str) -> tuple[int, int]:
    return text.count("\n") + 1, len(text) - (text.rfind("\n") + 1) + 1


def loaded(text: str) -> Loaded:
    """Load a text without marks."""
    return load(Source("test.tum", text))


FORGOTTEN = ("TUM341", "TUM342", "TUM343", "TUM344", "TUM345")
"""What is said about nearly every specification as small as these."""


def codes(text: str) -> list[str]:
    """The codes of everything else that is said about a text."""
    return [each.code.name for each in loaded(text).diagnostics if each.code.name not in FORGOTTEN]


def the(code: str, text: str) -> Diagnostic:
    """The one diagnostic of a code."""
    found = [each for each in loaded(text).diagnostics if each.code.name == code]
    assert len(found) == 1, loaded(text).diagnostics
    return found[0]
