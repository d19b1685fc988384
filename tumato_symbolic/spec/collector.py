"""Where the stages of resolution put what they find, how much of it is kept, and which names are suggested."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, CopySpan, Diagnostic, Note, Span
from tumato_symbolic.diagnostics.copies import Place, place_of
from tumato_symbolic.diagnostics.wording import nearest

MAX_FINDINGS = 1_000
"""The most diagnostics that one run keeps."""

MAX_SUGGESTIONS = 100
"""For how many names, at most, a similar one is looked for."""


class Findings:
    """Collects the diagnostics of one run; of what is wrong with several copies of a line, the first, and a count."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.copies: dict[Place, int] = {}
        self._suggestions = 0

    def add(
        self, code: Code, message: str, span: Span, way_out: str | None = None, notes: tuple[Note, ...] = ()
    ) -> None:
        """Keep a diagnostic."""
        if isinstance(span, CopySpan):
            place = place_of(code, span)
            if place in self.copies:
                self.copies[place] += 1
                return
            self.copies[place] = 0
        if len(self.diagnostics) < MAX_FINDINGS:
            self.diagnostics.append(Diagnostic(code, message, span, way_out, notes))

    def similar(self, name: str, candidates: list[str]) -> str | None:
        """The candidate that the user may have meant."""
        self._suggestions += 1
        return nearest(name, candidates) if self._suggestions <= MAX_SUGGESTIONS else None
