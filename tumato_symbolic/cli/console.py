"""The terminal: streams that do not fail on names, colour, and progress of long work."""

from __future__ import annotations

import io
import os
import sys
import threading
import time
from contextlib import suppress
from types import TracebackType
from typing import TextIO

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError

_PATIENCE = 1.0
"""Seconds of silence before progress is shown."""

_CLEAR_LINE = "\r\x1b[2K"


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
        print(text, end="", flush=True)
    except BrokenPipeError:
        raise
    except OSError as error:
        close_quietly()
        reason = error.strerror or str(error)
        raise UserError((Diagnostic(Code.TUM117, f"the output cannot be written: {reason}"),)) from error


def need_output() -> None:
    """Raise `UserError` where the standard output is closed: a report may be unwanted, an answer may not be lost."""
    if sys.stdout is None:
        raise UserError((Diagnostic(Code.TUM117, "the output cannot be written: the standard output is closed"),))


def note(text: str) -> None:
    """Put a text on the standard error stream. One that cannot be shown there is lost; the exit code stays right."""
    if sys.stderr is not None:
        with suppress(OSError):
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


class Progress:
    """What is being done, on one line of the terminal, once it takes longer than a second; silent in a pipe.

    Call it with a message whenever the work moves on. The line is drawn by a thread, because the solvers do not
    come back for seconds, and wiped when the context is left.
    """

    def __init__(self) -> None:
        self._message = ""
        self._stages: dict[str, float] = {}
        self._started = self._since = time.monotonic()
        self._done = threading.Event()
        shown = sys.stderr is not None and sys.stderr.isatty()
        self._thread = threading.Thread(target=self._draw, daemon=True) if shown else None

    def __call__(self, message: str) -> None:
        """Say what is being done now."""
        self._clock()
        self._message = message

    def stages(self) -> dict[str, float]:
        """How many seconds each message stood, in the order in which they came first."""
        return dict(self._stages)

    def _clock(self) -> None:
        """Count the time since the last message for what it said."""
        now = time.monotonic()
        if self._message:
            self._stages[self._message] = self._stages.get(self._message, 0.0) + now - self._since
        self._since = now

    def __enter__(self) -> Progress:
        if self._thread:
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._clock()
        self._done.set()
        if self._thread:
            self._thread.join()

    def _draw(self) -> None:
        import signal

        if hasattr(signal, "pthread_sigmask"):
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # Ctrl-C is for the thread that works
        if self._done.wait(_PATIENCE):
            return
        while not self._done.wait(0.1):
            seconds = time.monotonic() - self._started
            sys.stderr.write(f"{_CLEAR_LINE}{self._message} … {seconds:.0f} s")
            sys.stderr.flush()
        sys.stderr.write(_CLEAR_LINE)
        sys.stderr.flush()
