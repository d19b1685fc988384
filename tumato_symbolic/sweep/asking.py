"""Texts solved by child processes, each text within its limits.

A solver may take longer than any limit in one call, or all memory; so a child is ended that meets one, and the next
text gets another child. Nothing but texts is exchanged, and a child inherits nothing, so that this is the same on all
platforms and in a worker of a cluster.
"""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from msgspec.structs import asdict

from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.limits.processes import megabytes_of
from tumato_symbolic.sweep.child import IDLE, Then
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Batch, Reply

_GRACE = 1.0
"""Seconds after the time limit in which a child may still answer by itself."""

_TICK = 0.05
"""Seconds between two looks at a child."""

_TRIMMING: Final = "MALLOC_TRIM_THRESHOLD_"
"""Dask sets it for its workers, which then give memory back to the system at once; solvers take half as long again."""

_ROOT: Final = str(Path(__file__).resolve().parents[2])
_PROGRAM: Final = (
    "import sys; sys.path.append(sys.argv[1]); from tumato_symbolic.sweep.child import main; main(int(sys.argv[2]))"
)


class EndedError(Exception):
    """Nobody waits for the answer any more."""


class Children:
    """Child processes: as many as batches are asked at a time."""

    def __init__(self) -> None:
        self._idle: list[_Child] = []
        self._all: set[_Child] = set()
        self._lock = threading.Lock()
        self._over = False

    def start(self, number: int) -> None:
        """Have so many that are ready, or will soon be."""
        for child in [self._taken() for _ in range(number)]:
            self._give_back(child)

    def ask(self, batch: str, wanted: Callable[[], bool] = lambda: True) -> str:
        """The reply to a batch, both as JSON.

        A child that is ended, by a limit or by the system, has not decided: that is its last answer. Raises
        `EndedError` once the reply is not `wanted` any more.
        """
        child = self._taken()
        try:
            return _asked(child, Batch.read(batch), wanted).written()
        except EndedError:
            child.end()
            raise
        finally:
            self._give_back(child)

    def end(self) -> None:
        """End them all at once, those that are at work too, and make no more."""
        with self._lock:
            self._over = True
            for child in self._all:
                child.end()

    def _taken(self) -> _Child:
        """A child that is idle, or another."""
        with self._lock:
            if self._over:
                raise EndedError
            while self._idle:
                child = self._idle.pop()
                if child.is_ready:
                    return child
                self._forget(child)
            child = _Child()
            self._all.add(child)
            return child

    def _give_back(self, child: _Child) -> None:
        with self._lock:
            if child.is_ready:
                self._idle.append(child)
            else:
                self._forget(child)

    def _forget(self, child: _Child) -> None:
        child.end()
        self._all.discard(child)


_HERE: Final = Children()


def ask(batch: str, wanted: Callable[[], bool]) -> str:
    """The reply of a child of this process, which is a worker of a cluster; `EndedError` once it is not wanted."""
    return _HERE.ask(batch, wanted)


def start(number: int) -> None:
    """Have children of this process start, since there will be batches."""
    _HERE.start(number)


def _asked(child: _Child, batch: Batch, wanted: Callable[[], bool]) -> Reply:
    started = time.monotonic()
    child.send(batch.written())
    found = list(_lines(child, batch.common.limits, wanted))
    bug = found.pop()["bug"] if "bug" in found[-1] else None
    return Reply(tuple(Answer(**each) for each in found), time.monotonic() - started, bug)


def _lines(child: _Child, limits: Limits, wanted: Callable[[], bool]) -> Iterator[dict[str, Any]]:
    """What a child says of a batch. It is ended where it meets a limit, or has grown."""
    then: Then = "more"
    while then == "more":
        found = _next(child, limits, wanted)
        then = found.pop("then")
        if then == "end":
            child.end()
        yield found


def _next(child: _Child, limits: Limits, wanted: Callable[[], bool]) -> dict[str, Any]:
    """What a child says of the next text, or why it says nothing."""
    context = Context(limits)
    context.enter("solving it")
    while True:
        with suppress(queue.Empty):
            line = child.lines.get(timeout=_TICK)
            return dict(json.loads(line)) if line else _nothing(child.why_ended())
        if not wanted():
            raise EndedError
        why = _limit(context, child)
        if why is not None:
            return _nothing(why)


def _nothing(why: str) -> dict[str, Any]:
    then: Then = "end"
    return {**asdict(Answer({**NOTHING, "limit": why})), "then": then}


def _limit(context: Context, child: _Child) -> str | None:
    """Which limit was met, in words."""
    if context.deadline is not None and time.monotonic() >= context.deadline + _GRACE:
        return context.described()
    if context.limits.megabytes is not None and megabytes_of(child.number) > context.limits.megabytes:
        return context.described("memory")
    return None


class _Child:
    """A process that solves texts."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _PROGRAM, _ROOT, str(os.getpid())],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for its owner, which ends it
            env={name: value for name, value in os.environ.items() if name != _TRIMMING},
            encoding="utf-8",
        )
        self.lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._since = time.monotonic()
        threading.Thread(target=self._receive, daemon=True).start()

    @property
    def number(self) -> int:
        """The number of the process."""
        return self._process.pid

    @property
    def is_ready(self) -> bool:
        """Whether it takes a batch, and will not end before."""
        return self._process.poll() is None and time.monotonic() - self._since < IDLE / 2

    def send(self, batch: str) -> None:
        """Give it a batch."""
        with suppress(OSError, ValueError):  # it has ended: so there will be no answer
            assert self._process.stdin is not None, "it is a pipe"
            self._process.stdin.write(f"{batch}\n")
            self._process.stdin.flush()

    def why_ended(self) -> str:
        """Why there is no answer."""
        code = self._process.wait()
        if code == -signal.SIGKILL:
            return "the system killed the process that solved it, most likely because memory ran out"
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        return f"the process that solved it was ended by {how}"

    def end(self) -> None:
        """Kill it."""
        self._process.kill()
        self._process.wait()

    def _receive(self) -> None:
        assert self._process.stdout is not None, "it is a pipe"
        for line in self._process.stdout:
            self._since = time.monotonic()
            self.lines.put(line)
        self.lines.put("")
