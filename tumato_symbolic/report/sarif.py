"""Findings as SARIF 2.1.0, which code scanning tools and editors show at their lines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from urllib.parse import quote

from tumato_symbolic import __version__
from tumato_symbolic.diagnostics import Code, Span
from tumato_symbolic.report.findings import Finding

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


def as_sarif(found: Iterable[Finding], incomplete: Sequence[Mapping[str, object]] = ()) -> dict[str, object]:
    """One run with one result for every error, warning and remark; `incomplete` says what was left out."""
    listed = [each for each in found if each.level != "notice"]
    driver = {"name": "tumato-sym", "version": __version__, "rules": _rules(listed)}
    results = [_result(each) for each in listed]
    run: dict[str, object] = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    if incomplete:
        run["properties"] = {"incomplete": incomplete}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _rules(found: Sequence[Finding]) -> list[dict[str, object]]:
    """The kinds of what was found: those with a code in its order, then the others."""
    codes = {each.code for each in found}
    kinds: list[tuple[str, str, str]] = [(code.name, code.title, code.severity) for code in Code if code in codes]
    kinds += dict.fromkeys((_rule(each), each.title or "", each.level) for each in found if each.code is None)
    return [
        {"id": name, "shortDescription": {"text": title}, "defaultConfiguration": {"level": _level(level)}}
        for name, title, level in kinds
    ]


def _level(level: str) -> str:
    return "note" if level == "remark" else level


def _rule(found: Finding) -> str:
    return (found.kind or "error").replace(" ", "-")


def _result(found: Finding) -> dict[str, object]:
    result: dict[str, object] = {
        "ruleId": _rule(found),
        "level": _level(found.level),
        "message": {"text": found.message},
        "locations": [] if found.file is None else [_location(found.file, found.span)],
    }
    if found.file is not None and found.related:
        result["relatedLocations"] = [
            {"id": number, **_location(found.file, span), "message": {"text": text}}
            for number, (text, span) in enumerate(found.related, 1)
        ]
    return result


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
