"""Limits and Ctrl-C that hold: a command in a child process, which is ended when it does not end by itself.

A stage may sit in one call of a solver, where neither signals nor threads of Python are served. So the work is done by
a child; this process waits, shows progress, and knows what the child knows: every stage, and every finding.
"""

from __future__ import annotations

import io
import os
import pickle
import select
import signal
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType
from typing import NoReturn, TypeAlias

from msgspec import Struct, field

from tumato_symbolic.cli import console
from tumato_symbolic.limits import Context
from tumato_symbolic.limits.processes import end_with, megabytes_of

GRACE = 0.5
"""Seconds after the time limit in which a command may still report by itself."""

PATIENCE_WITH_OUTPUT = 2.0
"""Seconds that a command which is interrupted may go on with an output that it has begun."""

_TICK = 0.05
"""Seconds between two looks at the child."""

_FAREWELL = 1.0
"""Seconds in which the children of a child that was ended end as well."""

_SIGNALS = frozenset({signal.SIGINT, signal.SIGTERM, signal.SIGHUP})
"""What ends the work from outside."""

_Handler: TypeAlias = Callable[[int, FrameType | None], object] | int | None

_HEAD = 9
"""Bytes before the body of a message: its kind, and how long the body is."""

_STAGE, _KNOWN, _WRITING, _WRITTEN = b"S", b"K", b"W", b"D"


class EndedError(Exception):
    """The child was ended, or was ended by the system; the message says why. `context.known` is what it knew."""


class ChildCrashedError(Exception):
    """The child ended by a signal that nobody sent: a bug in it, or in a solver."""


class TerminatedError(BaseException):
    """This process, or its child, was told to end (SIGTERM, SIGHUP)."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def supervised(work: Callable[[], int], context: Context) -> int:
    """The exit code of `work`, which is done by a child within the limits of `context`.

    In the child, what `context` is told and learns is sent here. Raises `EndedError` where a limit was met,
    `KeyboardInterrupt` after Ctrl-C, both with what is known in `context.known`, and `ChildCrashedError`. No child is
    left, however this ends.
    """
    messages, sender = os.pipe()
    leave, granter = os.pipe()
    parent = os.getpid()
    console.flush()
    noted: list[int] = []
    handlers = _note_signals(noted)
    try:
        child = os.fork()
        if child == 0:
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # Ctrl-C is for the parent
            _restore(handlers)
            os.close(messages)
            os.close(granter)
            _be_the_child(work, context, _Sender(sender, leave), parent)
        os.close(sender)
        os.close(leave)
        watch = _Watch(child, messages, granter, context, noted)
        try:
            return watch.run()
        finally:
            watch.end()
    finally:
        _restore(handlers)


def _note_signals(noted: list[int]) -> dict[int, _Handler]:
    """Have signals that ask this process to end added to `noted`; the handlers that they had.

    Blocking them while a message is taken would not do: another thread, such as a solver's, may receive them all the
    same. A signal that is ignored, as under `nohup`, stays so.
    """
    handlers: dict[int, _Handler] = {}
    for number in _SIGNALS:
        handler = signal.getsignal(number)
        if handler is not None and handler is not signal.SIG_IGN:
            handlers[number] = signal.signal(number, lambda received, _: noted.append(received))
    return handlers


def _restore(handlers: dict[int, _Handler]) -> None:
    for number, handler in handlers.items():
        signal.signal(number, handler)


def _be_the_child(work: Callable[[], int], context: Context, sender: _Sender, parent: int) -> NoReturn:
    code = 70
    try:
        end_with(parent)
        console.ask_before_writing(sender.ask)
        context.progress = lambda stage: sender.send(_STAGE, stage.encode())
        context.learned = sender.tell_known
        code = work()
    finally:
        os._exit(code)


class _Sender:
    """The child's end: what it does and knows, and its requests to write."""

    def __init__(self, messages: int, leave: int) -> None:
        self._messages, self._leave, self._owner = messages, leave, os.getpid()
        self._pickled = io.BytesIO()
        self._pickler = pickle.Pickler(self._pickled, pickle.HIGHEST_PROTOCOL)

    def tell_known(self, known: object) -> None:
        """Send what is known by now; of what was sent before, only where that was."""
        self._pickled.seek(0)
        self._pickled.truncate()
        self._pickler.dump(known)
        self.send(_KNOWN, self._pickled.getvalue())

    def send(self, kind: bytes, body: bytes = b"") -> None:
        """Send a message; descendants of the child and orphans send none."""
        if os.getpid() == self._owner:
            with suppress(BrokenPipeError):
                rest = memoryview(kind + len(body).to_bytes(_HEAD - 1, "big") + body)
                while rest:
                    rest = rest[os.write(self._messages, rest) :]

    def ask(self, begins: bool) -> None:
        """Wait for leave to write, or say that it is done."""
        self.send(_WRITING if begins else _WRITTEN)
        if begins and os.getpid() == self._owner:
            os.read(self._leave, 1)


class _Watch(Struct):
    """The parent's end."""

    child: int
    messages: int
    granter: int
    context: Context
    noted: list[int]
    _received: bytearray = field(default_factory=bytearray)
    _known: bytearray = field(default_factory=bytearray)
    _writing: bool = False
    _open: bool = True
    _status: int | None = None

    def run(self) -> int:
        """Wait for the exit code."""
        line = console.ProgressLine(self.context)
        try:
            while not self._ended():
                line.draw()
                self._check()
                self._receive(line)
            return self._code()
        except (EndedError, KeyboardInterrupt, TerminatedError):
            self._let_it_write(line)
            self.kill()
            while self._open and self._receive(line, 0):
                pass  # what it said last
            self.context.known = _last(self._known)
            raise
        finally:
            line.wipe()

    def kill(self) -> None:
        """End the child, and with it its own children; one that is writing may remove what is not finished."""
        with suppress(ProcessLookupError):
            if self._status is None and self._writing:
                os.kill(self.child, signal.SIGTERM)
                latest = time.monotonic() + _FAREWELL
                while not self._reaped(os.WNOHANG) and time.monotonic() < latest:
                    time.sleep(_TICK)
            if self._status is None:
                os.kill(self.child, signal.SIGKILL)

    def end(self) -> None:
        """Leave nothing behind."""
        self.kill()
        self._reaped(0)
        while self._open and select.select([self.messages], [], [], _FAREWELL)[0]:
            self._open = bool(os.read(self.messages, 2**20))  # closed once no process is left that could send
        os.close(self.messages)
        os.close(self.granter)

    def _ended(self) -> bool:
        """Whether the child has ended, all that it sent having been received."""
        ended = self._reaped(os.WNOHANG if self._open else 0)
        return ended and not (self._open and select.select([self.messages], [], [], 0)[0])

    def _reaped(self, options: int) -> bool:
        """Whether the system says that the child has ended."""
        if self._status is None:
            found, status = os.waitpid(self.child, options)
            self._status = status if found else None
        return self._status is not None

    def _let_it_write(self, line: console.ProgressLine) -> None:
        """Wait for the end of an output that was begun, for a while."""
        latest = time.monotonic() + PATIENCE_WITH_OUTPUT
        while self._writing and self._open and time.monotonic() < latest:
            self._receive(line)

    def _check(self) -> None:
        """Raise what a signal asks for, or `EndedError` where a limit was met and no output is under way."""
        if self.noted:
            raise KeyboardInterrupt if self.noted[0] == signal.SIGINT else TerminatedError(self.noted[0])
        why = None if self._writing else self._limit()
        if why is not None:
            raise EndedError(why)

    def _limit(self) -> str | None:
        """Which limit was met, in words."""
        limits, deadline = self.context.limits, self.context.deadline
        if deadline is not None and time.monotonic() >= deadline + GRACE:
            return self.context.described()
        if limits.megabytes is not None and megabytes_of(self.child) > limits.megabytes:
            return self.context.described("memory")
        return None

    def _receive(self, line: console.ProgressLine, within: float = _TICK) -> bool:
        """Take what the child sends within some seconds; False where it sends nothing."""
        if not select.select([self.messages], [], [], within)[0]:
            return False
        data = os.read(self.messages, 2**20)
        self._open = bool(data)
        self._received += data
        self._take_all(line)
        return True

    def _take_all(self, line: console.ProgressLine) -> None:
        """Take every message that has been received whole."""
        while len(self._received) >= _HEAD:
            end = _HEAD + int.from_bytes(self._received[1:_HEAD], "big")
            if len(self._received) < end:
                return
            kind, body = bytes(self._received[:1]), bytes(self._received[_HEAD:end])
            del self._received[:end]
            self._take(kind, body, line)

    def _take(self, kind: bytes, body: bytes, line: console.ProgressLine) -> None:
        match kind:
            case b"S":
                self.context.enter(body.decode())
            case b"K":
                self._known += body
            case b"W" if self._limit() is None:
                line.wipe()
                self._writing = True
                with suppress(BrokenPipeError):
                    os.write(self.granter, b".")
            case b"D":
                self._writing = False

    def _code(self) -> int:
        code = os.waitstatus_to_exitcode(self._status or 0)
        if code >= 0:
            return code
        if code == -signal.SIGKILL:
            raise EndedError("the system killed the worker process, most likely because memory ran out")
        if -code in _SIGNALS:  # sent to all processes at once, by `timeout` or systemd
            raise TerminatedError(-code)
        raise ChildCrashedError(f"the worker process was killed by signal {-code} while {self.context.stage}")


def _last(pickled: bytearray) -> object:
    """The last of some objects, each of which refers to what was in those before; None where there is none."""
    file, known = io.BytesIO(pickled), None
    unpickler = pickle.Unpickler(file)
    while file.tell() < len(pickled):
        known = unpickler.load()
    return known
