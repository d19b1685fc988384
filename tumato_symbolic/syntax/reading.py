"""How a specification is read from a file, a pipe or standard input, and how large it may be."""

from __future__ import annotations

import os
import stat
import sys
import time
from typing import BinaryIO

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span, UserError
from tumato_symbolic.diagnostics.wording import quoted

PATIENCE_WITH_PIPES = 1.0
"""Seconds in which somebody has to begin to write to a pipe that is read."""

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


def content(path: str, most: int) -> bytes:
    """The bytes of a file (`-` is the standard input), no more than `most` of them. Raises `OSError`, `ValueError`."""
    if path == "-":
        return _first(standard_input(), most)
    with open(path, "rb", opener=_opened) as file:
        begun = _begun(file.fileno()) if stat.S_ISFIFO(os.fstat(file.fileno()).st_mode) else b""
        return begun + _first(file, most - len(begun))


def _opened(path: str, flags: int) -> int:
    """Open without waiting: a pipe that nobody writes to would keep the program for ever."""
    number = os.open(path, flags | getattr(os, "O_NONBLOCK", 0))
    if hasattr(os, "set_blocking") and not stat.S_ISFIFO(os.fstat(number).st_mode):
        os.set_blocking(number, True)
    return number


def _begun(pipe: int) -> bytes:
    """The first byte of a pipe, if one is there, once somebody writes to it."""
    latest = time.monotonic() + PATIENCE_WITH_PIPES
    try:
        while not (first := os.read(pipe, 1)):
            if time.monotonic() >= latest:
                raise OSError("it is a pipe, and nobody writes to it")
            time.sleep(0.02)
    except BlockingIOError:  # somebody does, and takes time
        first = b""
    os.set_blocking(pipe, True)
    return first


def _first(file: BinaryIO, most: int) -> bytes:
    """At most so many bytes; space is asked for only where there is so much to read."""
    start = file.read(min(2**20, most))
    return start + file.read(most - len(start)) if len(start) == 2**20 else start


def _read(path: str, name: str) -> bytes:
    """At most one byte more than is allowed."""
    try:
        return content(path, MAX_BYTES + 1)
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
