"""JSON text to plain values, strictly, and the checks of their shape. Every mistake is a `UserError`."""

from __future__ import annotations

import json
from typing import Any

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span, UserError
from tumato_symbolic.policy.problems import fault, show

MAX_BYTES = 32 * 1024 * 1024
"""The largest policy that is read or written: 32 MiB."""

MAX_DIGITS = 18
"""Longer numbers are read as fractions, and so fit nowhere."""


class Doubled(dict[str, Any]):
    """An object in which a key came twice; it is refused where it is used."""

    key: str = ""


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) == len(pairs):
        return found
    doubled = Doubled(found)
    seen: set[str] = set()
    doubled.key = next(key for key, _ in pairs if key in seen or seen.add(key))  # type: ignore[func-returns-value]
    return doubled


def _number(digits: str) -> int | float:
    return int(digits) if len(digits) <= MAX_DIGITS else float(digits)


def _no_number(name: str) -> object:
    raise ValueError(f"`{name}` is not JSON")


_decoder = json.JSONDecoder(object_pairs_hook=_object, parse_int=_number, parse_constant=_no_number)


def parse_json(text: str, name: str) -> object:
    """The value that a JSON text denotes. `name` is what the text is called in messages."""
    if len(text) > MAX_BYTES:
        raise too_large(name)
    try:
        value: object = _decoder.decode(text.removeprefix("\ufeff"))
    except json.JSONDecodeError as error:
        raise _not_json(error, name, text) from None
    except RecursionError:
        raise fault(
            Code.TUM501, "this is no policy and no certificate: the JSON is nested too deeply", None, Source(name, "")
        ) from None
    except ValueError as error:
        raise fault(Code.TUM501, f"this is not JSON: {error}", None, Source(name, "")) from None
    return value


def _not_json(error: json.JSONDecodeError, name: str, text: str) -> UserError:
    if not text.strip():
        return fault(Code.TUM501, "the input is empty", "write a policy with `tumato-sym synth`", Source(name, ""))
    at_end = not error.doc[error.pos :].strip()
    message = (
        f"this is not JSON: {'it ends too early' if at_end else error.msg} (line {error.lineno}, column {error.colno})"
    )
    span = Span(error.lineno, error.colno, error.lineno, error.colno + 1)
    start = error.doc.rfind("\n", 0, error.pos) + 1
    end = error.doc.find("\n", error.pos)
    if (end if end >= 0 else len(error.doc)) - start > 200:
        return fault(Code.TUM501, message, None, Source(name, ""))
    return UserError((Diagnostic(Code.TUM501, message, span),), Source(name, error.doc))


def too_large(name: str, what: str = "policy") -> UserError:
    """The error for what exceeds `MAX_BYTES`."""
    message = f"the {what} is larger than {MAX_BYTES // 1024**2} MiB"
    return fault(Code.TUM508, message, "use `--policy-format diagram`" if what == "policy" else None, Source(name, ""))


def wrong(where: str, expected: str, found: object) -> UserError:
    """The error for a value of the wrong kind."""
    text = f"the text {show(found)}" if isinstance(found, str) else show(found)
    return fault(Code.TUM502, f"{where} is {text}, expected {expected}")


def as_object(value: object, where: str) -> dict[str, Any]:
    """An object whose keys are all different."""
    if isinstance(value, Doubled):
        raise fault(Code.TUM502, f"{where} has the key {show(value.key)} twice")
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
