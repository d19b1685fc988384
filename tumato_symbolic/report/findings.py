"""Diagnostics for programs: as JSON, and as workflow commands of GitHub."""

from __future__ import annotations

from collections.abc import Iterable

from tumato_symbolic.diagnostics import Diagnostic, Span

_IN_MESSAGE = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_IN_PROPERTY = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A", ":": "%3A", ",": "%2C"})


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


def github_commands(diagnostics: Iterable[Diagnostic], file: str | None) -> str:
    """One workflow command for every diagnostic, which GitHub shows at its line."""
    lines = []
    for diagnostic in diagnostics:
        message = diagnostic.message if diagnostic.help is None else f"{diagnostic.message}\n{diagnostic.help}"
        lines.append(github_command(diagnostic.severity, message, file, diagnostic.span, diagnostic.code.name))
    return "\n".join(lines)


def github_command(
    kind: str, message: str, file: str | None = None, span: Span | None = None, title: str | None = None
) -> str:
    """One workflow command (`error`, `warning` or `notice`), escaped as GitHub wants it."""
    properties: dict[str, object] = {}
    if file is not None:
        properties["file"] = file
    if span is not None:
        properties |= {"line": span.line, "endLine": span.end_line, "col": span.column}
        if span.line == span.end_line:
            properties["endColumn"] = span.end_column
    if title is not None:
        properties["title"] = title
    listed = ",".join(f"{name}={str(value).translate(_IN_PROPERTY)}" for name, value in properties.items())
    return f"::{kind}{' ' if listed else ''}{listed}::{message.translate(_IN_MESSAGE)}"
