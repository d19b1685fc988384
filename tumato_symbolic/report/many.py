"""What a command found of many files: a line for each."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.report.findings import finding_json
from tumato_symbolic.report.layout import Paint, count, seconds

Report: TypeAlias = Mapping[str, Any]
"""What a command says of one file to a program."""


class Row(Struct, frozen=True):
    """One file: the exit code that the command would have, and its report."""

    name: str
    code: int
    report: Report


class Many(Struct, frozen=True):
    """The files that are done, in their order, of so many; `limit` is why some are missing; `took` is in seconds."""

    rows: tuple[Row, ...]
    of: int
    took: float
    limit: str | None = None


def failed(name: str, error: UserError) -> Row:
    """A file that cannot be used."""
    blamed = error.source.name if error.source else None
    return Row(name, 2, {"verdict": "error", "diagnostics": [finding_json(each, blamed) for each in error.diagnostics]})


def undecided(name: str, why: str) -> Row:
    """A file without an answer."""
    return Row(name, 3, {"verdict": "undecided", "limit": why})


def without_report(name: str, code: int, noted: str) -> Row:
    """A file of which the command says nothing but a sentence."""
    return Row(name, code, {"verdict": "no answer", "limit": noted.strip().removeprefix("tumato-sym: ")})


def as_line(row: Row) -> str:
    """A file for a program: its report on one line."""
    return json.dumps({"file": row.name, "exit_code": row.code, **row.report})


def as_text(done: Many, said: Callable[[Report], str], colour: bool) -> str:
    """A table of files, of which `said` tells what the command found, and how many there are of each verdict."""
    paint = Paint(colour)
    width = max((len(row.name) for row in done.rows), default=0)
    across = max((len(str(row.report["verdict"])) for row in done.rows), default=0)
    lines = [
        f"{row.name:<{width}}  {_painted(row, across, paint)}  {_words(row.report, said)}".rstrip() for row in done.rows
    ]
    verdicts = Counter(str(row.report["verdict"]) for row in done.rows)
    found = ", ".join(
        count(number, verdict) if verdict == "error" else f"{number:,} {verdict}"
        for verdict, number in verdicts.items()
    )
    lines.append(f"{count(done.of, 'file')}{': ' if found else ''}{found}. In {seconds(done.took)}.")
    if len(done.rows) < done.of:
        lines.append(f"{done.of - len(done.rows):,} of them were not looked at: {done.limit}.")
    return "\n".join(lines)


def _painted(row: Row, across: int, paint: Paint) -> str:
    verdict = f"{row.report['verdict']:<{across}}"
    return {0: paint.good, 3: paint.doubt}.get(row.code, paint.bad)(verdict)


def _words(report: Report, said: Callable[[Report], str]) -> str:
    if report["verdict"] == "error":
        first = report["diagnostics"][0]
        place = "" if first["line"] is None else f" in line {first['line']}"
        return f"{first['code']}{place}: {first['message']}"
    if report["verdict"] in ("undecided", "no answer"):
        return str(report.get("limit") or "")
    return said(report)
