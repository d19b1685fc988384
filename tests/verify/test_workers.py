"""Child processes of a proof: what is known of them, and that none is left, however it ends."""

from __future__ import annotations

import mmap
import os
import select
import signal
import sys
import time
from collections.abc import Callable
from functools import partial
from multiprocessing import get_context

import pytest

from tumato_symbolic.verify.workers import Lost, WorkerError, cores, in_workers


def _is_gone(process: int) -> bool:
    """Whether this child has ended and was waited for."""
    try:
        os.waitpid(process, os.WNOHANG)
    except ChildProcessError:
        return True
    return False


def _end_by(number: signal.Signals) -> None:
    signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)


@pytest.mark.parametrize(
    ("end", "how"),
    [
        (partial(os._exit, 0), "exit code 0"),
        (partial(os._exit, 3), "exit code 3"),
        (partial(_end_by, signal.SIGHUP), "signal 1"),
        (partial(_end_by, signal.SIGTERM), "signal 15"),
    ],
)
def test_how_a_child_ended_is_told(end: Callable[[], object], how: str) -> None:
    """Its exit code or its signal; also of the last one, where nobody else is waited for."""
    assert in_workers([end], 1) == [Lost(f"a worker process was ended by {how}")]


def test_answers_are_told_as_they_come() -> None:
    """Each with the number of its task."""
    told: list[tuple[int, object]] = []

    def slow() -> str:
        time.sleep(0.3)
        return "slow"

    tasks = [slow, lambda: "quick"]
    assert in_workers(tasks, 2, lambda number, answer: told.append((number, answer))) == ["slow", "quick"]
    assert told == [(1, "quick"), (0, "slow")]


def test_nobody_is_left() -> None:
    """Neither children that have answered, nor those that were ended because another one failed."""
    (answered,) = in_workers([os.getpid], 1)
    assert isinstance(answered, int) and _is_gone(answered)
    number = memoryview(mmap.mmap(-1, 8)).cast("q")

    def slow() -> None:
        number[0] = os.getpid()
        time.sleep(30)

    def fail() -> None:
        while not number[0]:
            time.sleep(0.01)
        raise ValueError("planted")

    with pytest.raises(WorkerError):
        in_workers([fail, slow], 2)
    assert _is_gone(number[0])


def test_ctrl_c_is_heard_here_and_by_no_child() -> None:
    """It is held back while a child is made, and the child goes on so; here it is heard again."""

    def blocked() -> bool:
        return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])

    assert in_workers([blocked, blocked], 1) == [True, True]
    assert not blocked()


@pytest.mark.skipif(sys.platform != "linux", reason="asks the Linux kernel")
def test_a_child_ends_with_its_parent() -> None:
    """Where its parent is killed outright, nobody holds its output any more."""
    reader, writer = os.pipe()

    def endless() -> None:
        os.write(writer, b"begun")
        time.sleep(30)

    parent = get_context("fork").Process(target=in_workers, args=([endless], 1))
    parent.start()
    os.close(writer)
    assert os.read(reader, 5) == b"begun"
    parent.kill()
    parent.join()
    ready, _, _ = select.select([reader], [], [], 10)
    assert ready and os.read(reader, 1) == b""
    os.close(reader)


def test_no_child_goes_on_after_a_failure() -> None:
    """Where one task fails, the others are ended, not waited for."""
    done = memoryview(mmap.mmap(-1, 1))

    def slow() -> int:
        time.sleep(1.0)
        done[0] = 1
        return 1

    with pytest.raises(WorkerError):
        in_workers([lambda: int("no number"), slow], 2)
    assert done[0] == 0


def test_answers_come_in_the_order_of_the_tasks() -> None:
    """Whoever comes first; and no more children than jobs work at a time."""
    began = time.monotonic()

    def task(number: int) -> tuple[int, float, float]:
        since = time.monotonic() - began
        time.sleep(0.2 if number == 0 else 0.05)
        return number, since, time.monotonic() - began

    found = in_workers([partial(task, number) for number in range(5)], 2)
    assert [answer[0] for answer in found if not isinstance(answer, Lost)] == list(range(5))
    spans = [answer[1:] for answer in found if not isinstance(answer, Lost)]
    assert max(sum(one[0] <= other[0] < one[1] for one in spans) for other in spans) == 2


def test_every_processor_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    """The processors that this process may use are counted, where the system tells; else all."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set() if process else {1, 3, 4}, raising=False)
    assert cores() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: 5)
    assert cores() == 5
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert cores() == 1
