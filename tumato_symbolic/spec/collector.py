"""Where the stages of resolution put what they find."""

from __future__ import annotations

from tumato_symbolic.diagnostics import Code, Diagnostic, Note, Span
from tumato_symbolic.diagnostics.wording import nearest

MAX_FINDINGS = 1_000
"""The most diagnostics that one run keeps."""

MAX_SUGGESTIONS = 100
"""For how many names, at most, a similar one is looked for."""


class Findings:
    """Collects the diagnostics of one run."""

    def __init__(self) -> None:
        self.diagnostics: list[Diagnostic] = []
        self._suggestions = 0

    def add(
        self, code: Code, message: str, span: Span, way_out: str | None = None, notes: tuple[Note, ...] = ()
    ) -> None:
        """Keep a diagnostic."""
        if len(self.diagnostics) < MAX_FINDINGS:
            self.diagnostics.append(Diagnostic(code, message, span, way_out, notes))

    def similar(self, name: str, candidates: list[str]) -> str | None:
        """The candidate that the user may have meant."""
        self._suggestions += 1
        return nearest(name, candidates) if self._suggestions <= MAX_SUGGESTIONS else None
