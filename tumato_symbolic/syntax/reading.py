"""A file, or standard input, to a source text."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import BinaryIO

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span, UserError
from tumato_symbolic.diagnostics.wording import quoted

MAX_BYTES = 2_000_000
"""The largest specification that is read, in bytes."""


def read_source(path: str) -> Source:
    """The text at `path`, or of standard input where that is `-`.

    Raises `UserError` for what is missing, not a
    file, unreadable, not UTF-8, binary, or larger than `MAX_BYTES`.
    """
    name = "<stdin>" if path == "-" else path
    data = _read(path, name)
    if len(data) > MAX_BYTES:
        raise _error(Code.TUM103, f"{quoted(name)} is larger than {MAX_BYTES:,} bytes", "is this the right file?")
    if b"\0" in data:
        raise _error(Code.TUM102, f"{quoted(name)} is a binary file", "a specification is a text in UTF-8")
    try:
        return Source(name, data.decode())
    except UnicodeDecodeError as problem:
        raise _not_utf8(name, data, problem.start) from None


def standard_input() -> BinaryIO:
    """The bytes of standard input. Raises `OSError` where it is closed."""
    if sys.stdin is None:
        raise OSError("the standard input is closed")
    return sys.stdin.buffer


def _read(path: str, name: str) -> bytes:
    """At most one byte more than is allowed."""
    try:
        if path == "-":
            return standard_input().read(MAX_BYTES + 1)
        with Path(path).open("rb") as file:
            return file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise _error(Code.TUM101, f"there is no file {quoted(name)}", None) from None
    except IsADirectoryError:
        raise _error(Code.TUM101, f"{quoted(name)} is a directory", "name a file in it") from None
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise _error(Code.TUM101, f"{quoted(name)} cannot be read: {reason}", None) from None


def _not_utf8(name: str, data: bytes, offset: int) -> UserError:
    line = data.count(b"\n", 0, offset) + 1
    column = len(data[data.rfind(b"\n", 0, offset) + 1 : offset].decode("utf-8", "replace")) + 1
    return UserError(
        (
            Diagnostic(
                Code.TUM102,
                f"{quoted(name)} is not UTF-8: byte 0x{data[offset]:02x} in line {line}",
                Span(line, column, line, column + 1),
                help="save the file as UTF-8",
            ),
        ),
        Source(name, data.decode("utf-8", "replace")),
    )


def _error(code: Code, message: str, way_out: str | None) -> UserError:
    return UserError((Diagnostic(code, message, help=way_out),))
