"""Mistakes and warnings in a text while it is written, and fixes for them, each of which was tried."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from tumato_symbolic.diagnostics import Diagnostic, Source, not_allowed
from tumato_symbolic.spec import load
from tumato_symbolic.syntax.edits import Edit, edited

_MEANT = re.compile(r"`([^`]+)`")


class Fix(NamedTuple):
    """A change of a text that a user may choose; `diagnostic` is what it mends, if it is one thing."""

    title: str
    edits: tuple[Edit, ...]
    diagnostic: Diagnostic | None = None


def findings(source: Source, thorough: bool = False) -> tuple[Diagnostic, ...]:
    """Mistakes and warnings, in the order of the text; `thorough`: also what shows only in the states."""
    loaded = load(source)
    if not thorough or loaded.spec is None:
        return loaded.diagnostics
    from tumato_symbolic.semantics.lint import lint

    return (*loaded.diagnostics, *not_allowed(lint(loaded.spec), source))


def fixes(source: Source, first: int, last: int) -> Iterator[Fix]:
    """For each mistake that begins on these lines, what was surely meant: each was tried, and mends it.

    Of several words, the first may stand in the text already.
    """
    found = findings(source)
    for each in found:
        span = each.span
        if span is None or not first <= span.line <= last or "did you mean" not in (each.help or ""):
            continue
        for text in _MEANT.findall(each.help or ""):
            words = text.split()
            tried = (Edit(span, " ".join(words[first_word:])) for first_word in range(len(words)))
            edit = next((edit for edit in tried if _mends(source, edit, found)), None)
            if edit is not None:
                yield Fix(f"Change to `{text}`", (edit,), each)


def _mends(source: Source, edit: Edit, found: tuple[Diagnostic, ...]) -> bool:
    """Whether there are fewer errors after an edit."""
    after = findings(Source(source.name, edited(source, (edit,))))
    return _errors(after) < _errors(found)


def _errors(found: tuple[Diagnostic, ...]) -> int:
    return sum(each.severity == "error" for each in found)
