"""Results as one table of text."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

Case = Mapping[str, Any]
Number = TypeVar("Number", int, float)

COLUMNS = (
    "case", "states", "valid", "actions", "sets",
    "parse", "encode", "predecessor", "own region", "interaction", "restoring", "extraction", "verification",
    "MB", "nodes", "ranks", "bytes", "proved by", "synth", "verify", "no policy", "Python",
)  # fmt: skip

_STAGES = COLUMNS[5:12]


def table(result: Mapping[str, Any]) -> str:
    """One line per case. Stages are seconds, whole processes (`synth`, `verify`, `no policy`) are units.

    `Python` is how many times as long the search takes in pure Python as with CUDD.
    """
    rows = [COLUMNS, *(_row(case) for case in result["cases"])]
    widths = [max(len(row[column]) for row in rows) for column in range(len(COLUMNS))]
    lines = []
    for row in rows:
        cells = [row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True))]
        lines.append("  ".join(cells).rstrip())
    lines.insert(1, "  ".join("-" * width for width in widths))
    return "\n".join((described(result), "", *lines))


def described(result: Mapping[str, Any]) -> str:
    """The machine and the unit."""
    machine = result["machine"]
    versions = ", ".join(f"{name} {number}" for name, number in machine["versions"].items())
    return (
        f"{machine['cpu']}, {machine['cores']} cores, {machine['memory_gb']} GB; "
        f"Python {machine['python']}; {versions}\n"
        f'1 unit = python -c "import z3, lark, dd.cudd" = {result["unit"]["seconds"]:.3f} s; '
        f"--help: {result['help']['seconds'] / result['unit']['seconds']:.2f} units"
    )


def _row(case: Case) -> tuple[str, ...]:
    if "states" not in case:
        return (case["case"], *(["–"] * (len(COLUMNS) - 2)), case["verdict"])
    unit: float = case["unit"]["seconds"]
    stages: dict[str, float] = dict(case["stages"])
    extraction = stages.pop("write", 0.0) + stages.get("extraction", 0.0)
    stages["extraction"] = extraction
    proof = case.get("proof", {})
    proving = sum(each["seconds"] for each in proof.values())
    provers = dict.fromkeys(each["proved_by"] for each in proof.values() if each["proved_by"])
    return (
        case["case"],
        size(case["states"]),
        size(case["valid"]),
        str(case["actions"]),
        known(case.get("allowed_sets"), size),
        *(f"{stages.get(stage, 0.0):.2f}" for stage in _STAGES),
        f"{proving:.2f}" if proof else "–",
        str(peak(case)),
        known(case.get("nodes"), size),
        known(case.get("rank_nodes"), size),
        known(case.get("bytes"), size),
        "+".join(provers) or "–",
        units(case.get("synth"), unit),
        units(case.get("verify"), unit),
        units(case["twin"], unit),
        known(case.get("pure_python"), "{:.1f}".format),
    )


def peak(case: Case) -> int:
    """The most memory that a process of the case took, in MB."""
    processes = [case.get(command) or {} for command in ("synth", "verify", "twin")]
    found: list[int] = [case.get("peak_mb", 0), *(process.get("peak_mb", 0) for process in processes)]
    return max(found)


def known(value: Number | None, show: Callable[[Number], str]) -> str:
    """A number where there is one."""
    return "–" if value is None else show(value)


def size(number: int) -> str:
    """A count, short: exact up to nine digits."""
    return f"{number:,}" if number < 10**9 else f"{number:.2e}"


def units(process: Mapping[str, Any] | None, unit: float) -> str:
    """A process's time in units; an exit code that means no verdict is shown with it."""
    if process is None:
        return "–"
    if process["exit"] is None:
        return "limit"
    mark = "" if process["exit"] in (0, 1) else f" (exit {process['exit']})"
    return f"{process['seconds'] / unit:.2f}{mark}"
