"""What a command found, each thing at its place: as workflow commands of GitHub, and diagnostics as JSON."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Span

_IN_MESSAGE = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_IN_PROPERTY = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A", ":": "%3A", ",": "%2C"})


class Finding(Struct, frozen=True):
    """One thing to show at a place in a file, whatever the format; the first report of a verdict is a `notice`.

    `title` names its kind where it has no code. `related` are other places in the same file, with what they have to do
    with it.
    """

    level: Literal["error", "warning", "remark", "notice"]
    message: str
    file: str | None = None
    span: Span | None = None
    title: str | None = None
    code: Code | None = None
    related: tuple[tuple[str, Span], ...] = ()

    @property
    def kind(self) -> str | None:
        """The name of its code, or its title."""
        return self.code.name if self.code is not None else self.title


def finding(diagnostic: Diagnostic, file: str | None) -> Finding:
    """A diagnostic of a file, with its help in the message."""
    message = diagnostic.message if diagnostic.help is None else f"{diagnostic.message}\n{diagnostic.help}"
    related = tuple((note.message, note.span) for note in diagnostic.notes)
    return Finding(diagnostic.severity, message, file, diagnostic.span, code=diagnostic.code, related=related)


def findings_of(diagnostics: Iterable[Diagnostic], file: str | None) -> list[Finding]:
    """The diagnostics of a file."""
    return [finding(each, file) for each in diagnostics]


def undecided(why: str, file: str | None) -> Finding:
    """That there is no verdict."""
    return Finding("error", f"undecided: {why}", file, title="undecided")


def finding_json(diagnostic: Diagnostic, file: str | None) -> dict[str, object]:
    """One diagnostic as JSON; the places are 1-based, their ends exclusive, null where there is none."""
    return {
        "code": diagnostic.code.name,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        "help": diagnostic.help,
        "file": file,
        **_place(diagnostic.span),
        "notes": [{"message": note.message, **_place(note.span)} for note in diagnostic.notes],
    }


def _place(span: Span | None) -> dict[str, int | None]:
    return {
        "line": span.line if span else None,
        "column": span.column if span else None,
        "end_line": span.end_line if span else None,
        "end_column": span.end_column if span else None,
    }


def as_github(found: Iterable[Finding]) -> str:
    """One workflow command for every finding, which GitHub shows at its line."""
    return "\n".join(map(_command, found))


def _command(found: Finding) -> str:
    properties: dict[str, object] = {}
    if found.file is not None:
        properties["file"] = found.file
    if (span := found.span) is not None:
        properties |= {"line": span.line, "endLine": span.end_line, "col": span.column}
        if span.line == span.end_line:
            properties["endColumn"] = span.end_column
    if found.kind is not None:
        properties["title"] = found.kind
    listed = ",".join(f"{name}={str(value).translate(_IN_PROPERTY)}" for name, value in properties.items())
    kind = "notice" if found.level == "remark" else found.level
    return f"::{kind}{' ' if listed else ''}{listed}::{found.message.translate(_IN_MESSAGE)}"
