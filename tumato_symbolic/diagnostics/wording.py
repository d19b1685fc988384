"""Pieces of sentences for users: quoting, counting, listing, and the name that was probably meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

MAX_QUOTED = 60
"""The most characters of the user's text that a message repeats."""

MAX_LISTED = 10
"""The most names that a message lists."""

MAX_CANDIDATES = 500
"""Among how many names, at most, a similar one is looked for."""


def quoted(text: str) -> str:
    """A piece of the user's text in back quotes, clipped, unprintable characters made visible."""
    clipped = text if len(text) <= MAX_QUOTED else text[: MAX_QUOTED - 1] + "…"
    return "`" + "".join(each if each.isprintable() else f"\\x{ord(each):02x}" for each in clipped) + "`"


def one_line(text: str) -> str:
    """A text without its line breaks, with single spaces."""
    return " ".join(text.split())


def count(number: int, noun: str, plural: str | None = None) -> str:
    """`1 state`, `1,024 states`."""
    return f"{number:,} {noun if number == 1 else plural or noun + 's'}"


def listed(texts: Sequence[str], last: str = "and", plain: bool = False) -> str:
    """`a`, `b` and `c`; a long list is cut. `plain` leaves the texts unquoted."""
    shown = [text if plain else quoted(text) for text in texts[:MAX_LISTED]]
    if len(texts) > MAX_LISTED:
        return f"{', '.join(shown)} and {len(texts) - MAX_LISTED} more"
    if len(shown) < 2:
        return "".join(shown)
    return f"{', '.join(shown[:-1])} {last} {shown[-1]}"


def nearest(name: str, candidates: Iterable[str]) -> str | None:
    """The candidate that looks most like `name`, if one does."""
    pool = list(candidates)
    if len(name) > MAX_QUOTED or len(pool) > MAX_CANDIDATES:
        return None
    same = next((each for each in pool if each.lower() == name.lower()), None)
    from difflib import get_close_matches

    return same or next(iter(get_close_matches(name, pool, n=1, cutoff=0.6)), None)
