"""What a user is told: a coded message at a place in a source text, with notes and a way out."""

from __future__ import annotations

from msgspec import Struct
from msgspec.structs import force_setattr

from tumato_symbolic.diagnostics.codes import Code, Severity


class Span(Struct, frozen=True):
    """A range of a source text: 1-based lines and columns (in characters); the end is exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int


class CopySpan(Span, frozen=True):
    """A range of a source text that stands for several things: this one was made with these parameters."""

    parameters: tuple[tuple[str, str], ...]

    @property
    def worded(self) -> str:
        """`R = r1, Q = r2`."""
        return ", ".join(f"{name} = {value}" for name, value in self.parameters)

    @property
    def in_text(self) -> Span:
        """The range alone."""
        return Span(self.line, self.column, self.end_line, self.end_column)


class Source(Struct, frozen=True):
    """A text and the name it is shown under (usually its path as the user typed it).

    The text has no byte-order mark, and every line ends with a line feed, whatever it was made from: a line ends with a
    line feed, a carriage return, or both, as editors show it.
    """

    name: str
    text: str

    def __post_init__(self) -> None:
        plain = self.text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
        force_setattr(self, "text", plain)


class Note(Struct, frozen=True):
    """A second place that explains a diagnostic, such as the first of two declarations."""

    message: str
    span: Span


class Diagnostic(Struct, frozen=True):
    """One finding.

    `help` is the way out ("did you mean `S_Battery`?"); `span` is None where no place in a text is to blame.
    """

    code: Code
    message: str
    span: Span | None = None
    help: str | None = None
    notes: tuple[Note, ...] = ()

    @property
    def severity(self) -> Severity:
        """Whether the finding stops the work, is probably a mistake, or is worth knowing."""
        return self.code.severity


class UserError(Exception):
    """Input that cannot be used: carries the diagnostics and the source they point into (if any).

    Raised by the public API and caught at the rim of the command line (exit code 2).
    """

    def __init__(self, diagnostics: tuple[Diagnostic, ...], source: Source | None = None) -> None:
        super().__init__("; ".join(f"{d.code.name}: {d.message}" for d in diagnostics))
        self.diagnostics = diagnostics
        self.source = source

    def __reduce__(self) -> tuple[type[UserError], tuple[tuple[Diagnostic, ...], Source | None]]:
        """Exceptions are copied between processes by how they were made."""
        return UserError, (self.diagnostics, self.source)
