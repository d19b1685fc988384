"""Warnings and remarks that the text allows: `// allow TUM341` on the line that they are about, or above it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from tumato_symbolic.diagnostics.diagnostic import Diagnostic, Source

_ALLOWING: Final = re.compile(r"//.*?\ballow((?:[ \t,]+TUM[0-9]{3})+)")
_ONLY_COMMENT: Final = re.compile(r"[ \t]*//")


def not_allowed(diagnostics: Iterable[Diagnostic], source: Source) -> tuple[Diagnostic, ...]:
    """The diagnostics that the text does not allow; errors cannot be allowed."""
    found = tuple(diagnostics)
    if not found or "allow" not in source.text:
        return found
    lines = source.text.split("\n")
    return tuple(each for each in found if each.severity == "error" or not _is_allowed(each, lines))


def allowed_on(lines: Sequence[str], place: int) -> frozenset[str]:
    """The codes that are allowed on the line at a place: by a comment on it, or in the comments just above it."""
    found = set(_allowed(lines[place]))
    while place and _ONLY_COMMENT.match(lines[place - 1]):
        place -= 1
        found.update(_allowed(lines[place]))
    return frozenset(found)


def _is_allowed(diagnostic: Diagnostic, lines: list[str]) -> bool:
    """Whether the code is allowed on the first line of its span."""
    if diagnostic.span is None or diagnostic.span.line > len(lines):
        return False
    return diagnostic.code.name in allowed_on(lines, diagnostic.span.line - 1)


def _allowed(line: str) -> list[str]:
    found = _ALLOWING.search(line)
    return re.findall(r"TUM[0-9]{3}", found[1]) if found else []
