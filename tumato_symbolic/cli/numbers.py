"""Numbers on the command line, such as limits and probabilities, and what is wrong with those that are not."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from typing import Literal

from tumato_symbolic.diagnostics.wording import quoted

MOST = 1_000_000_000
"""The largest number of seconds (30 years), megabytes (a petabyte) or pieces; the solvers take no larger ones."""

_DECIMAL = re.compile(r"\+?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
_LONGEST = 50
"""Characters of a number; one with more is none."""


def whole(least: int, what: str = "") -> Callable[[str], int]:
    """Reads a whole number from `least` on, of `what`."""

    def read(text: str) -> int:
        fits = text.isascii() and text.isdigit() and len(text) <= _LONGEST
        value = int(text) if fits else -1
        if not least <= value <= MOST:
            kind = "a positive number" if least == 1 and what else f"a whole number, at least {least}"
            raise _not(text, f"{kind}{what and f' of {what}'}", too_large=value > MOST)
        return value

    return read


def whole_or_all(least: int) -> Callable[[str], int | Literal["all"]]:
    """Reads a whole number from `least` on, or the word `all`."""
    number = whole(least)

    def read(text: str) -> int | Literal["all"]:
        return "all" if text == "all" else number(text)

    return read


def seconds(text: str) -> float:
    """A time limit."""
    value = float(text) if _DECIMAL.fullmatch(text) and len(text) <= _LONGEST else 0.0
    if not 0 < value <= MOST:
        raise _not(text, "a positive number of seconds", too_large=value > MOST)
    return value


def probability(text: str) -> float:
    """A number from 0 to 1."""
    value = float(text) if _DECIMAL.fullmatch(text) and len(text) <= _LONGEST else -1.0
    if not 0 <= value <= 1:
        raise _not(text, "a number from 0 to 1", too_large=False)
    return value


def _not(text: str, what: str, *, too_large: bool) -> argparse.ArgumentTypeError:
    reason = f"is more than {MOST:,}" if too_large else f"is not {what}"
    return argparse.ArgumentTypeError(f"{quoted(text)[1:-1]} {reason}")
