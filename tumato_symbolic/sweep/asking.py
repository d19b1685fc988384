"""Texts solved by child processes, one for each thread that asks, within the limits of every task.

A solver may take longer than any limit in one call, or all memory; so a child is ended that meets one, and the next
task gets another child. Nothing but texts is exchanged, and a child inherits nothing, so that this is the same on all
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
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from tumato_symbolic.limits import Context
from tumato_symbolic.limits.processes import megabytes_of
from tumato_symbolic.sweep.child import IDLE
from tumato_symbolic.sweep.tasks import NOTHING, Answer, Task

_GRACE = 1.0
"""Seconds after the time limit in which a child may still answer by itself."""

_TICK = 0.05
"""Seconds between two looks at a child."""

_ROOT: Final = str(Path(__file__).resolve().parents[2])
_PROGRAM: Final = (
    "import sys; sys.path.append(sys.argv[1]); from tumato_symbolic.sweep.child import main; main(int(sys.argv[2]))"
)


class SolverError(Exception):
    """An exception in a child: a bug, with its traceback."""


class EndedError(Exception):
    """Nobody waits for the answer any more."""


class Children:
    """Child processes, one for each thread that asks."""

    def __init__(self) -> None:
        self._of_thread = threading.local()
        self._all: set[_Child] = set()
        self._lock = threading.Lock()
        self._over = False

    def ask(self, task: str) -> str:
        """The answer to a task, both as JSON. Raises `SolverError` where the child has a bug.

        A child that is ended, by a limit or by the system, has not decided.
        """
        return json.dumps(asdict(self._asked(Task(**json.loads(task)))))

    def end(self) -> None:
        """End them all at once, those that are at work too, and make no more."""
        with self._lock:
            self._over = True
            for child in self._all:
                child.end()

    def _asked(self, task: Task) -> Answer:
        child = self._mine()
        context = Context(task.limits)
        context.enter("solving it")
        child.send(json.dumps(asdict(task)))
        while True:
            with suppress(queue.Empty):
                line = child.lines.get(timeout=_TICK)
                if not line:
                    return Answer({**NOTHING, "limit": child.why_ended()})
                if _has_grown(child, task):
                    child.end()
                return _read(line)
            why = _limit(context, child)
            if why is not None:
                child.end()
                return Answer({**NOTHING, "limit": why})

    def _mine(self) -> _Child:
        """The child of this thread: one that is there, or another."""
        child: _Child | None = getattr(self._of_thread, "child", None)
        if child is not None and child.is_ready:
            return child
        with self._lock:
            if child is not None:
                child.end()
                self._all.discard(child)
            if self._over:
                raise EndedError
            child = self._of_thread.child = _Child()
            self._all.add(child)
        return child


_HERE: Final = Children()


def ask(task: str) -> str:
    """The answer of a child of this process, which is a worker of a cluster."""
    return _HERE.ask(task)


def _limit(context: Context, child: _Child) -> str | None:
    """Which limit was met, in words."""
    if context.deadline is not None and time.monotonic() >= context.deadline + _GRACE:
        return context.described()
    if context.limits.megabytes is not None and megabytes_of(child.number) > context.limits.megabytes:
        return context.described("memory")
    return None


def _has_grown(child: _Child, task: Task) -> bool:
    """Whether a child keeps so much memory that the next task would be blamed for it."""
    return task.megabytes is not None and megabytes_of(child.number) > task.megabytes / 2


def _read(line: str) -> Answer:
    found: dict[str, Any] = json.loads(line)
    if "bug" in found:
        raise SolverError(f"in a process that solves variants\n\n{found['bug']}")
    return Answer(**found)


class _Child:
    """A process that solves texts."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _PROGRAM, _ROOT, str(os.getpid())],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for its owner, which ends it
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
        """Whether it takes a task, and will not end before."""
        return self._process.poll() is None and time.monotonic() - self._since < IDLE / 2

    def send(self, task: str) -> None:
        """Give it a task."""
        with suppress(OSError, ValueError):  # it has ended: so there will be no answer
            assert self._process.stdin is not None, "it is a pipe"
            self._process.stdin.write(f"{task}\n")
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
