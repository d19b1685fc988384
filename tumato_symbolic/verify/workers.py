"""Work done by child processes: each begins with all that is known here, and sends back what it found.

Children are made by `fork`, so that they need no copy of what they work on. Where there is none that is safe (Windows,
macOS) there are no children, and the asking process does the work alone.
"""

from __future__ import annotations

import gc
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec import Struct

from tumato_symbolic.limits.processes import end_with

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkProcess

Found = TypeVar("Found")


class Lost(Struct, frozen=True):
    """A task without an answer: it was given up, or its child was killed."""

    reason: str


class _Failed(Struct, frozen=True):
    """What was raised in a child."""

    trace: str
    out_of_memory: bool


class WorkerError(Exception):
    """An exception in a child, with its traceback."""


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_workers(
    tasks: Iterable[Callable[[], Found]], jobs: int, heard: Callable[[int, Found | Lost], None] | None = None
) -> list[Found | Lost]:
    """The answers of all `tasks`, in their order, whichever comes first; up to `jobs` children work at a time.

    A task is taken from `tasks` when there is room for its child; `heard` is told each answer, with the task's number,
    when it comes. Raises `WorkerError` where a task raises, and `MemoryError` where it is out of memory. No child is
    left when this ends, however it ends.
    """
    from multiprocessing import get_context
    from multiprocessing.connection import wait

    context, waiting = get_context("fork"), enumerate(tasks)
    running: dict[Any, tuple[int, ForkProcess]] = {}
    found: dict[int, Found | Lost] = {}
    try:
        while True:
            while len(running) < jobs and (task := next(waiting, None)) is not None:
                reader, writer = context.Pipe(duplex=False)
                with _ctrl_c_later():
                    child = context.Process(target=_work, args=(writer, task[1], os.getpid()), daemon=True)
                    child.start()
                    running[reader] = task[0], child
                writer.close()
            if not running:
                return [found[number] for number in sorted(found)]
            for ready in wait(list(running)):
                number, child = running[ready]
                found[number] = _received(ready, child)
                del running[ready]
                if heard is not None:
                    heard(number, found[number])
    finally:
        for _, child in running.values():
            child.kill()
        for reader, (_, child) in running.items():
            child.join()
            reader.close()


def _work(writer: Connection, task: Callable[[], object], parent: int) -> None:
    """All that a child does."""
    end_with(parent)
    gc.freeze()  # what was there before is not looked at again, and so not copied
    try:
        writer.send((task(),))
    except BrokenPipeError:
        return  # nobody waits for the answer any more
    except Exception as error:  # noqa: BLE001 - the parent raises it
        import traceback

        writer.send(_Failed(traceback.format_exc(), isinstance(error, MemoryError)))


def _received(reader: Any, child: ForkProcess) -> Any:  # noqa: ANN401 - whatever the task has found
    message: Any = None
    with suppress(EOFError, OSError):
        message = reader.recv()
    reader.close()
    child.join()
    if message is None:
        code = child.exitcode or 0
        return Lost(f"a worker process was ended by {f'signal {-code}' if code < 0 else f'exit code {code}'}")
    if isinstance(message, _Failed):
        raise MemoryError if message.out_of_memory else WorkerError(f"in a child process\n\n{message.trace}")
    return message[0]


@contextmanager
def _ctrl_c_later() -> Iterator[None]:
    """Hold Ctrl-C back for a moment. A child that is made meanwhile never hears of it: it is ended from here."""
    import signal

    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
