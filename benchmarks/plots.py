"""Charts of a run, as SVG: `python -m benchmarks.plots RESULTS FOLDER`."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any

from msgspec import Struct

WIDTH, HEIGHT = 640, 360
LEFT, RIGHT, TOP, BOTTOM = 60, 130, 30, 45
COLOURS = ("#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad", "#d68910", "#555555", "#16a085", "#b03a76")

Point = tuple[float, float]


class Chart(Struct, frozen=True):
    """A figure of every case against the time of `synth` with its proof, one line per family, both logarithmic."""

    name: str
    label: str
    figure: str
    families: tuple[str, ...]


CHARTS = (
    Chart("states", "valid states", "valid", ("loads", "robots", "samples", "plant", "grid", "uav", "factory", "amr")),
    Chart("variables", "state variables", "variables", ("loads", "robots", "samples", "plant")),
    Chart("actions", "actions", "actions", ("loads", "robots", "samples", "plant", "grid", "obstacles", "counter")),
    Chart("concurrency", "sets of actions that are allowed somewhere", "allowed_sets", ("loads", "robots", "plant")),
    Chart("goals", "goals", "goals", ("loads", "robots")),
    Chart(
        "plan_length",
        "steps of the longest run",
        "longest_run",
        ("grid", "samples", "sampler", "loads", "obstacles", "counter"),
    ),
    Chart("limits", "n", "size", ("shelves", "shelf_counts", "pairs", "paired")),
)


def main() -> None:
    """Draw every chart of a file of results into a folder."""
    result = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    for chart in CHARTS:
        (Path(sys.argv[2]) / f"{chart.name}.svg").write_text(drawn(chart, result), encoding="utf-8")


def drawn(chart: Chart, result: Mapping[str, Any]) -> str:
    """One chart; cases without an answer are left out."""
    lines: dict[str, list[Point]] = {}
    for case in result["cases"]:
        ended, x = case.get("synth"), case.get(chart.figure)
        if case["family"] in chart.families and ended and ended["exit"] == 0 and x:
            lines.setdefault(case["family"], []).append((x, ended["seconds"]))
    across = _Scale([x for line in lines.values() for x, _ in line], LEFT, WIDTH - RIGHT)
    upward = _Scale([y for line in lines.values() for _, y in line], HEIGHT - BOTTOM, TOP)
    parts = [*_axes(chart.label, across, upward)]
    for number, (name, points) in enumerate(lines.items()):
        parts += _line(name, points, number, across, upward)
    body = "\n".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="12">\n<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n{body}\n</svg>\n'
    )


class _Scale:
    """A logarithmic axis around all values, marked at 1, 2, 5, 10, …, or at powers of ten where these are many."""

    def __init__(self, values: Sequence[float], start: float, end: float) -> None:
        low, high = float(min(values, default=1)), float(max(values, default=1))
        powers = range(math.floor(math.log10(low)), math.floor(math.log10(high)) + 2)
        marks = [step * 10.0**power for power in powers for step in (1, 2, 5)]
        first = max(number for number, mark in enumerate(marks) if mark <= low)
        last = min(number for number, mark in enumerate(marks) if mark >= high)
        marks = marks[first : max(last, first + 1) + 1]
        wide = [mark for mark in marks if math.log10(mark).is_integer()]
        self.marks = wide if len(marks) > 8 else marks
        self._low, self._high = math.log(marks[0]), math.log(marks[-1])
        self._start, self._end = start, end

    def __call__(self, value: float) -> float:
        share = (math.log(value) - self._low) / (self._high - self._low)
        return round(self._start + share * (self._end - self._start), 1)


def _axes(label: str, across: _Scale, upward: _Scale) -> list[str]:
    bottom, right = HEIGHT - BOTTOM, WIDTH - RIGHT
    parts = [f'<text x="{LEFT}" y="18">seconds: synth with its proof, whole process</text>']
    for mark in upward.marks:
        y = upward(mark)
        parts.append(f'<line x1="{LEFT}" y1="{y}" x2="{right}" y2="{y}" stroke="#ddd"/>')
        parts.append(f'<text x="{LEFT - 6}" y="{y + 4}" text-anchor="end">{mark:g}</text>')
    for mark in across.marks[:: 1 + len(across.marks) // 9]:
        x, shown = across(mark), f"{mark:g}" if mark < 1e5 else f"1e{math.log10(mark):.0f}"
        parts.append(f'<line x1="{x}" y1="{TOP}" x2="{x}" y2="{bottom}" stroke="#ddd"/>')
        parts.append(f'<text x="{x}" y="{bottom + 16}" text-anchor="middle">{shown}</text>')
    parts.append(f'<text x="{(LEFT + right) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{escape(label)}</text>')
    return parts


def _line(name: str, points: Sequence[Point], number: int, across: _Scale, upward: _Scale) -> list[str]:
    colour = COLOURS[number % len(COLOURS)]
    places = [(across(x), upward(y)) for x, y in sorted(points)]
    path = " ".join(f"{x},{y}" for x, y in places)
    parts = [f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>']
    parts += [f'<circle cx="{x}" cy="{y}" r="3" fill="{colour}"/>' for x, y in places]
    parts.append(f'<text x="{WIDTH - RIGHT + 12}" y="{TOP + 12 + 18 * number}" fill="{colour}">{escape(name)}</text>')
    return parts


if __name__ == "__main__":
    main()
