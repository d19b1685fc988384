"""Small pieces of text that all reports share: times, enumerations, colours."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from tumato_symbolic.diagnostics.wording import count

__all__ = ["Paint", "count", "dump", "enumeration", "every", "seconds"]


def dump(report: Mapping[str, object]) -> str:
    """A report for a program: one JSON object, in plain ASCII."""
    return json.dumps(report, indent=2)


def every(number: int, noun: str) -> str:
    """`the one state`, `all 1,024 states`."""
    return f"the one {noun}" if number == 1 else f"all {count(number, noun)}"


def seconds(duration: float) -> str:
    """A duration as a person says it: `0.12 s`, `75 s`, `2 min 5 s`."""
    if duration < 10:
        return f"{duration:.2f} s"
    if duration < 120:
        return f"{duration:.0f} s"
    return f"{int(duration // 60)} min {int(duration % 60)} s"


def enumeration(parts: Sequence[str], last: str = "and") -> str:
    """`a`, `a and b`, `a, b and c`."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} {last} {parts[-1]}"


class Paint:
    """Colours of a terminal, or none."""

    def __init__(self, colour: bool) -> None:
        self._colour = colour

    def good(self, text: str) -> str:
        """Green."""
        return self._paint("32;1", text)

    def bad(self, text: str) -> str:
        """Red."""
        return self._paint("31;1", text)

    def doubt(self, text: str) -> str:
        """Yellow."""
        return self._paint("33;1", text)

    def _paint(self, code: str, text: str) -> str:
        return f"\x1b[{code}m{text}\x1b[0m" if self._colour else text
