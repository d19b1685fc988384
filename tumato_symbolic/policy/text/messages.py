"""Mistakes in a policy or a state in words, and how many of them are told at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, UserError
from tumato_symbolic.diagnostics.wording import listed, nearest, quoted
from tumato_symbolic.spec import Value

MOST = 20
"""So many mistakes in a policy or state are reported at once, and so many variables of a state are shown."""


def fault(code: Code, message: str, help: str | None = None, source: Source | None = None) -> UserError:
    """An error with one diagnostic."""
    return UserError((Diagnostic(code, message, help=help),), source)


def show(value: object) -> str:
    """A value out of a file as a message may print it: texts quoted, everything else by its kind."""
    if isinstance(value, str):
        return quoted(value)
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return "a number"
    return "a list" if isinstance(value, list) else "an object"


def described(state: Mapping[str, Value]) -> str:
    """A state in words, cut where it has very many variables."""
    parts = [f"{quoted(name)[1:-1]} is {quoted(str(value))[1:-1]}" for name, value in state.items()]
    return ", ".join([*parts[:MOST], "…"] if len(parts) > MOST else parts)


def way_out(name: object, known: Iterable[str], what: str) -> str:
    """The nearest known name, or all of them."""
    options = list(known)
    close = nearest(name, options) if isinstance(name, str) else None
    if close is not None:
        return f"did you mean {quoted(close)}?"
    return f"{what}: {listed(options)}" if options else f"there are no {what}"
