"""One message for all copies of a line that have the same mistake."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeAlias

from msgspec.structs import replace

from tumato_symbolic.diagnostics.codes import Code
from tumato_symbolic.diagnostics.diagnostic import CopySpan, Diagnostic, Note, Span

Place: TypeAlias = tuple[Code, int, int, int, int]
"""What is wrong, and where in the text."""


def place_of(code: Code, span: Span) -> Place:
    """What two copies have in common where the same is wrong with them."""
    return code, span.line, span.column, span.end_line, span.end_column


def merged(diagnostics: Iterable[Diagnostic], further: Mapping[Place, int] | None = None) -> list[Diagnostic]:
    """The diagnostics, of those about copies the first for each place: it says which copy it means, and how many more.

    `further` tells of how many copies the same was found that are not in the list.
    """
    first: dict[Place, Diagnostic] = {}
    others = dict(further or {})
    kept: list[Diagnostic] = []
    for each in diagnostics:
        place = place_of(each.code, each.span) if isinstance(each.span, CopySpan) else None
        if place is not None and place in first:
            others[place] = others.get(place, 0) + 1
            continue
        if place is not None:
            first[place] = each
        kept.append(each)
    return [_told(each, others) for each in kept]


def _told(diagnostic: Diagnostic, others: Mapping[Place, int]) -> Diagnostic:
    notes = tuple(_note(each) for each in diagnostic.notes)
    span = diagnostic.span
    if not isinstance(span, CopySpan):
        return replace(diagnostic, notes=notes) if notes != diagnostic.notes else diagnostic
    more = others.get(place_of(diagnostic.code, span), 0)
    further = f", and {more:,} more {'copy' if more == 1 else 'copies'}" if more else ""
    message = f"{diagnostic.message} (with {span.worded}{further})"
    return replace(diagnostic, message=message, span=span.in_text, notes=notes)


def _note(note: Note) -> Note:
    span = note.span
    return Note(f"{note.message} (with {span.worded})", span.in_text) if isinstance(span, CopySpan) else note
