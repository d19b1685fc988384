"""`make bench-compare`: two files of results, side by side, with what became worse marked.

    python -m benchmarks.compare [OLD NEW]

Without names, the last two full runs in `benchmarks/results`. Times are compared in units, so
that two machines may differ.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from msgspec import Struct

from benchmarks.table import peak

RESULTS = Path(__file__).parent / "results"

Case = Mapping[str, Any]


class Figure(Struct, frozen=True):
    """A number of a case. It is worse when it grows by more than a quarter and by more than `noise`."""

    name: str
    of: Callable[[Case], float | None]
    noise: float


def _units(command: str) -> Callable[[Case], float | None]:
    def units(case: Case) -> float | None:
        ended = case.get(command)
        return None if ended is None or ended["exit"] is None else float(ended["seconds"] / case["unit"]["seconds"])

    return units


FIGURES = (
    Figure("synth", _units("synth"), 0.3),
    Figure("verify", _units("verify"), 0.3),
    Figure("no policy", _units("twin"), 0.3),
    Figure("MB", lambda case: peak(case) if "states" in case else None, 20),
    Figure("nodes", lambda case: case.get("nodes"), 0),
    Figure("bytes", lambda case: case.get("bytes"), 0),
)


def main() -> int:
    """Print the comparison; exit with 1 where something became worse."""
    names = sys.argv[1:]
    if len(names) not in (0, 2):
        print(__doc__)
        return 2
    paths = [Path(name) for name in names] or sorted(RESULTS.glob("*[0-9].json"))[-2:]
    if len(paths) < 2:
        print("there is nothing to compare with: only one full run has been kept in benchmarks/results")
        return 0
    old, new = (json.loads(path.read_text(encoding="utf-8")) for path in paths)
    print(f"{paths[0].name} → {paths[1].name}")
    found = list(compared(old, new))
    print("\n".join(found) or "nothing to compare: no case is in both")
    return 1 if any("WORSE" in line for line in found) else 0


def compared(old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[str]:
    """One line for every case of both runs, with a mark at every figure that became worse."""
    before = {case["case"]: case for case in old["cases"]}
    for case in new["cases"]:
        if case["case"] in before:
            earlier = before.pop(case["case"])
            parts = [_change(figure, earlier, case) for figure in FIGURES]
            if earlier.get("digest") != case.get("digest"):
                parts.append("policy changed")
            yield f"{case['case']:<16}" + "; ".join(part for part in parts if part)
        else:
            yield f"{case['case']:<16}new"
    for name in before:
        yield f"{name:<16}no longer measured"


def _change(figure: Figure, earlier: Case, case: Case) -> str:
    old, new = figure.of(earlier), figure.of(case)
    if old is None and new is None:
        return ""
    if old is None or new is None:
        mark = "" if old is None else " WORSE"
        return f"{figure.name} {_number(old)} → {_number(new)}{mark}"
    mark = " WORSE" if new > 1.25 * old and new - old > figure.noise else ""
    mark = mark or (" better" if old > 1.25 * new and old - new > figure.noise else "")
    return f"{figure.name} {_number(old)} → {_number(new)}{mark}"


def _number(value: float | None) -> str:
    if value is None:
        return "–"
    return f"{value:,.0f}" if value >= 100 else f"{value:.2f}"


if __name__ == "__main__":
    sys.exit(main())
