"""JSON text to plain values, strictly: how large and how deep it may be, and the checks of its shape.

Every mistake is a `UserError`.
"""

from __future__ import annotations

import json
from typing import Any

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span, UserError
from tumato_symbolic.policy.text.messages import fault, show
from tumato_symbolic.policy.text.rows import Objects, RepeatedKeyError, Row
from tumato_symbolic.spec import text_of

MAX_BYTES = 256 * 1024 * 1024
"""The largest policy that is read or written: 256 MiB."""

MAX_LEVELS = 100
"""How deep objects and lists may be nested in one another."""

MAX_DIGITS = 18
"""Longer numbers are read as fractions, and so fit nowhere."""


def _number(digits: str) -> int | float:
    return int(digits) if len(digits) <= MAX_DIGITS else float(digits)


def _no_number(name: str) -> object:
    raise ValueError(f"`{name}` is not JSON")


def parse_json(text: str, name: str) -> object:
    """The value that a JSON text denotes; objects may be `Row`s. `name` is what the text is called in messages."""
    if len(text) > MAX_BYTES:
        raise too_large(name)
    decoder = json.JSONDecoder(object_pairs_hook=Objects(), parse_int=_number, parse_constant=_no_number)
    try:
        value: object = decoder.decode(text.removeprefix("\ufeff"))
    except json.JSONDecodeError as error:
        raise _not_json(error, name, text) from None
    except RecursionError:
        raise _too_deep(name) from None
    except RepeatedKeyError as error:
        raise fault(Code.TUM502, f"an object has the key {show(error.key)} twice", None, Source(name, "")) from None
    except ValueError as error:
        raise fault(Code.TUM501, f"this is not JSON: {error}", None, Source(name, "")) from None
    if _levels_exceed(value):
        raise _too_deep(name)
    return value


def _levels_exceed(value: object) -> bool:
    """Whether objects and lists are nested too deeply."""
    level = [value]
    for _ in range(MAX_LEVELS):
        inner = [part.values() if type(part) is dict else part for part in level if type(part) in (dict, list)]
        level = [part for parts in inner for part in parts if type(part) in (dict, list)]  # type: ignore[attr-defined]
    return bool(level)


def _too_deep(name: str) -> UserError:
    message = f"objects and lists are nested more than {MAX_LEVELS} levels deep"
    return fault(Code.TUM501, message, None, Source(name, ""))


def _not_json(error: json.JSONDecodeError, name: str, text: str) -> UserError:
    if not text.strip():
        return fault(Code.TUM501, "the input is empty", "write a policy with `tumato-sym synth`", Source(name, ""))
    at_end = not error.doc[error.pos :].strip()
    before = Source(name, error.doc[: error.pos]).text
    line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
    message = f"this is not JSON: {'it ends too early' if at_end else error.msg} (line {line}, column {column})"
    span = Span(line, column, line, column + 1)
    start = error.doc.rfind("\n", 0, error.pos) + 1
    end = error.doc.find("\n", error.pos)
    if (end if end >= 0 else len(error.doc)) - start > 200:
        return fault(Code.TUM501, message, None, Source(name, ""))
    return UserError((Diagnostic(Code.TUM501, message, span),), Source(name, error.doc))


def too_large(name: str, what: str = "policy") -> UserError:
    """The error for what exceeds `MAX_BYTES`."""
    message = f"the {what} is larger than {MAX_BYTES // 1024**2} MiB"
    return fault(Code.TUM508, message, _SMALLER if what == "policy" else None, Source(name, ""))


_SMALLER = (
    "`tumato-sym synth --policy-format diagram` writes small ones; a policy that comes from elsewhere can be written "
    'without white space, or as a diagram (docs/policy.md, "Large policies")'
)


def wrong(where: str, expected: str, found: object) -> UserError:
    """The error for a value of the wrong kind."""
    text = f"the text {show(found)}" if isinstance(found, str) else show(found)
    return fault(Code.TUM502, f"{where} is {text}, expected {expected}")


def as_object(value: object, where: str) -> dict[str, Any]:
    """An object."""
    if isinstance(value, Row):
        return value.as_dict()
    if not isinstance(value, dict):
        raise wrong(where, "an object", value)
    return value


def as_list(value: object, where: str) -> list[Any]:
    """A list."""
    if not isinstance(value, list):
        raise wrong(where, "a list", value)
    return value


def as_text(value: object, where: str) -> str:
    """A string that can be written in UTF-8."""
    if not isinstance(value, str):
        raise wrong(where, "a string", value)
    try:
        value.encode()
    except UnicodeEncodeError:
        raise fault(Code.TUM502, f"{where} is {show(value)}, which is not valid Unicode text") from None
    return value


def as_value(value: object, where: str) -> str:
    """A value of a variable, as a specification writes it: a string, or a whole number."""
    if not isinstance(value, str) and type(value) is not int:
        raise wrong(where, "a string or a whole number", value)
    return as_text(text_of(value), where)


def as_names(value: object, where: str) -> tuple[str, ...]:
    """A list of different strings."""
    names = tuple(as_text(name, f"an entry of {where}") for name in as_list(value, where))
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise fault(Code.TUM502, f"{where} lists {show(name)} twice")
        seen.add(name)
    return names


def as_whole(value: object, where: str, below: int | None = None) -> int:
    """A whole number that is not negative and smaller than `below`."""
    if type(value) is not int:
        raise wrong(where, "a whole number", value)
    if value < 0 or (below is not None and value >= below):
        limit = "" if below is None else f" to {below - 1}"
        raise fault(Code.TUM502, f"{where} is {value}, expected a number from 0{limit}")
    return value


def member(section: dict[str, Any], key: str, where: str) -> object:
    """The value of a key that must be there."""
    if key not in section:
        raise fault(Code.TUM502, f"{where} has no `{key}`")
    return section[key]
