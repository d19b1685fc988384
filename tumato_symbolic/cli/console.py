"""The terminal: streams that do not fail on names, output that is written whole, colour, and the line of progress."""

from __future__ import annotations

import io
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TextIO

from tumato_symbolic.cli.options import STANDARD_OUTPUT
from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.limits import Context

_PATIENCE = 1.0
"""Seconds of silence before progress is shown."""

_CLEAR_LINE = "\r\x1b[2K"

_around_writing: list[Callable[[bool], None]] = []
"""Told True before something is written, and False when it is; a supervised process asks for permission this way."""


@contextmanager
def writing() -> Iterator[None]:
    """Work that is ended before or after, and not halfway: output."""
    for told in _around_writing:
        told(True)
    try:
        yield
    finally:
        for told in _around_writing:
            told(False)


def ask_before_writing(asked: Callable[[bool], None]) -> None:
    """Call this with True before every output, and with False after it."""
    _around_writing.append(asked)


def prepare_streams() -> None:
    """Let the output streams escape what their encoding cannot show."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def write(text: str) -> None:
    """Put a text on the standard output at once.

    Raises `UserError` when the output cannot take it (a full disk), `BrokenPipeError` when its reader has gone.
    """
    if not text.endswith("\n"):
        text += "\n"
    try:
        with writing():
            print(text, end="", flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        close_quietly()
        reason = error.strerror or str(error)
        raise UserError((Diagnostic(Code.TUM117, f"the output cannot be written: {reason}"),)) from error


def write_to(path: str, text: str, what: str) -> None:
    """Put a text into a file; `-` is the standard output. `what` is what it is called in messages."""
    from tumato_symbolic.policy import save_text

    if path == STANDARD_OUTPUT:
        write(text)
    else:
        with writing():
            save_text(text, Path(path), what)


def need_output() -> None:
    """Raise `UserError` where the standard output is closed: a report may be unwanted, an answer may not be lost."""
    if sys.stdout is None:
        raise UserError((Diagnostic(Code.TUM117, "the output cannot be written: the standard output is closed"),))


def note(text: str) -> None:
    """Put a text on the standard error stream. One that cannot be shown there is lost; the exit code stays right."""
    if sys.stderr is not None:
        with suppress(OSError), writing():
            print(text.rstrip("\n"), file=sys.stderr, flush=True)


def flush() -> None:
    """Empty the buffer of the standard output, so that its errors are met here and not at exit."""
    if sys.stdout is not None:
        sys.stdout.flush()


def close_quietly() -> None:
    """Send what is left in the buffers nowhere: the reader has gone, and Python would complain at exit."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and not _flushes(stream):
            os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def _flushes(stream: TextIO) -> bool:
    try:
        stream.flush()
    except OSError:
        return False
    return True


def wants_colour(stream: TextIO | None) -> bool:
    """Whether a stream is a terminal whose user has not asked for plain text (NO_COLOR, TERM=dumb)."""
    if stream is None or not stream.isatty():
        return False
    return not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


class ProgressLine:
    """What is being done, on one line of the terminal, once it takes longer than a second; silent in a pipe."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._shown = sys.stderr is not None and sys.stderr.isatty()
        self._drawn = False

    def draw(self, *_: object) -> None:
        """Show the stage of now, and how long the work takes already."""
        seconds = time.monotonic() - self._context.started
        if self._shown and seconds >= _PATIENCE:
            self._drawn = True
            _put_on_terminal(f"{_CLEAR_LINE}{self._context.stage} … {seconds:.0f} s")

    def wipe(self) -> None:
        """Leave the line as it was."""
        if self._drawn:
            self._drawn = False
            _put_on_terminal(_CLEAR_LINE)


def _put_on_terminal(text: str) -> None:
    with suppress(OSError):
        sys.stderr.write(text)
        sys.stderr.flush()
