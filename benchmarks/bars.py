"""What is demanded of a machine-independent measure, and whether it is kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from msgspec import Struct

from benchmarks.table import peak


class Bar(Struct, frozen=True):
    """Units for `synth` with its proof and for `verify`; bytes of the policy; MB of memory."""

    synth: float
    verify: float
    size: int | None = None
    memory: int | None = None


BARS = {
    "amr": Bar(1.05, 1.0),
    "factory": Bar(1.6, 1.6),
    "uav": Bar(1.5, 1.5, size=50_000),
    "loads 8": Bar(14, 6),
    "loads 15": Bar(12, 12, memory=1000),
    "loads 20": Bar(30, 30, memory=1000),
    "loads 25": Bar(70, 70, memory=1000),
    "loads 30": Bar(150, 150, memory=1000),
    "robots 4": Bar(7, 7),
    "samples 30": Bar(50, 30, memory=1000),
    "sampler 30": Bar(30, 30, memory=2000),
    "obstacles 126": Bar(40, 40, memory=2000),
    "counter 1000": Bar(30, 30, memory=2000),
    "plant 10": Bar(7.2, 7.2, memory=1000),
    "rooms 12": Bar(10, 10),
    "rooms 20": Bar(60, 60),
    "errands 12": Bar(10, 10),
    "errands 20": Bar(60, 60),
    "responders 4": Bar(60, 30, memory=1000),
    "puzzle 3": Bar(100, 100, memory=2000),
}
HELP = 0.35
"""Units for `--help`."""
PURE_PYTHON = 30
"""How many times as long as with CUDD the search may take in pure Python, on small sizes."""


def judged(result: Mapping[str, Any]) -> str:
    """Every bar that this run can judge, one line each."""
    lines = [_time("--help", "time", result["help"], result["unit"], HELP)]
    for case in result["cases"]:
        if bar := BARS.get(case["case"]):
            lines += _of(case, bar, case["unit"])
        if "pure_python" in case:
            lines.append(_line(case["case"], "pure Python", case["pure_python"], PURE_PYTHON))
    return "\n".join(lines)


def _of(case: Mapping[str, Any], bar: Bar, unit: Mapping[str, float]) -> Iterator[str]:
    yield _time(case["case"], "synth", case.get("synth"), unit, bar.synth)
    yield _time(case["case"], "verify", case.get("verify"), unit, bar.verify)
    if bar.size is not None:
        yield _line(case["case"], "bytes", case.get("bytes"), bar.size)
    if bar.memory is not None:
        yield _line(case["case"], "memory in MB", peak(case) if "states" in case else None, bar.memory)


def _time(case: str, what: str, ran: Mapping[str, Any] | None, unit: Mapping[str, float], limit: float) -> str:
    """A time on the clock is judged; beside it stands what was computed, which others on the machine disturb less."""
    if ran is None or ran["exit"] != 0:
        return _line(case, what, None, limit)
    return f"{_line(case, what, ran['seconds'] / unit['seconds'], limit)} (computing: {ran['cpu'] / unit['cpu']:.2f})"


def _line(case: str, what: str, found: float | None, limit: float) -> str:
    if found is None:
        return f"{case:<15}{what:<14}{'–':>10} of {limit:<8,g} MISSED (no answer)"
    number = f"{found:,.0f}" if found >= 1000 else f"{found:.2f}"
    return f"{case:<15}{what:<14}{number:>10} of {limit:<8,g} {'kept' if found <= limit else 'MISSED'}"
