"""Explanations as SARIF 2.1.0, which code scanning tools and editors show at the lines to blame."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from urllib.parse import quote

from tumato_symbolic.diagnostics import Code, Diagnostic, Span
from tumato_symbolic.explain.explanation import Explanation
from tumato_symbolic.report.explained import Explained
from tumato_symbolic.report.explained_data import Mark, marks

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def as_sarif(done: Explained, version: str) -> dict[str, object]:
    """One run with one result for every line to blame, and for every warning."""
    left_out = done.found.left_out if isinstance(done.found, Explanation) else ()
    incomplete = [{"what": each.stage, "found": each.found, "why": each.why} for each in left_out]
    return _log([*marks(done), *map(_mark, done.warnings)], done.source.name, version, incomplete)


def findings_sarif(diagnostics: Iterable[Diagnostic], file: str, version: str) -> dict[str, object]:
    """One run with one result for every finding, where the input cannot be used."""
    return _log([_mark(each) for each in diagnostics], file, version)


def _log(
    found: list[Mark], file: str, version: str, incomplete: Sequence[Mapping[str, object]] = ()
) -> dict[str, object]:
    used = {mark.code for mark in found}
    rules = [
        {
            "id": code.name,
            "shortDescription": {"text": code.title},
            "defaultConfiguration": {"level": code.severity},
        }
        for code in Code
        if code in used
    ]
    driver = {"name": "tumato-sym", "version": version, "rules": rules}
    results = [_result(mark, file) for mark in found]
    run: dict[str, object] = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    if incomplete:
        run["properties"] = {"incomplete": incomplete}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(mark: Mark, file: str) -> dict[str, object]:
    result: dict[str, object] = {
        "ruleId": mark.code.name,
        "level": mark.code.severity,
        "message": {"text": mark.message},
        "locations": [_location(file, mark.span)],
    }
    if mark.others:
        related = [
            {"id": number, **_location(file, span), "message": {"text": text}}
            for number, (text, span) in enumerate(mark.others, 1)
        ]
        result["relatedLocations"] = related
    return result


def _mark(diagnostic: Diagnostic) -> Mark:
    text = diagnostic.message if diagnostic.help is None else f"{diagnostic.message}\n{diagnostic.help}"
    return Mark(diagnostic.code, text, diagnostic.span)


def _location(file: str, span: Span | None) -> dict[str, object]:
    place: dict[str, object] = {"artifactLocation": {"uri": quote(file.replace("\\", "/"))}}
    if span is not None:
        place["region"] = {
            "startLine": span.line,
            "startColumn": span.column,
            "endLine": span.end_line,
            "endColumn": span.end_column,
        }
    return {"physicalLocation": place}
