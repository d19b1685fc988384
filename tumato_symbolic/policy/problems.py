"""How this room says what is wrong with a policy or a state."""

from __future__ import annotations

from collections.abc import Iterable

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, UserError

SHOWN = 60
"""Names are cut after this many characters in messages."""

MOST = 20
"""So many mistakes in a policy or state are reported at once."""


def fault(code: Code, message: str, help: str | None = None, source: Source | None = None) -> UserError:
    """An error with one diagnostic."""
    return UserError((Diagnostic(code, message, help=help),), source)


def plain(name: str) -> str:
    """A name as a message may print it: printable and not too long."""
    short = name if len(name) <= SHOWN else name[:SHOWN] + "…"
    return short if short.isprintable() else ascii(short)[1:-1]


def show(value: object) -> str:
    """A value out of a file as a message may print it: names in backticks, everything else by its kind."""
    return f"`{plain(value)}`" if isinstance(value, str) else kind(value)


def kind(value: object) -> str:
    """What kind of JSON value this is."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return "a number"
    if isinstance(value, str):
        return "a string"
    return "a list" if isinstance(value, list) else "an object"


def listed(names: Iterable[str], limit: int = 8) -> str:
    """Names in a row, cut after `limit`."""
    shown = list(names)
    rest = f" and {len(shown) - limit} more" if len(shown) > limit else ""
    return ", ".join(show(name) for name in shown[:limit]) + rest


def way_out(name: object, known: Iterable[str], what: str) -> str:
    """The nearest known name, or all of them."""
    options = list(known)
    if isinstance(name, str) and len(name) <= SHOWN:
        import difflib

        close = difflib.get_close_matches(name, [option for option in options[:1000] if len(option) <= SHOWN], 1)
        if close:
            return f"did you mean {show(close[0])}?"
    return f"{what}: {listed(options)}" if options else f"there are no {what}"
