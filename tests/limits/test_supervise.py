"""A command in a child process: its limits hold, what it knew is known, nothing is left."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest

from tumato_symbolic.cli import console, supervise
from tumato_symbolic.cli.supervise import ChildCrashedError, EndedError, TerminatedError, supervised
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.limits.processes import can_fork, end_with, megabytes_of
from tumato_symbolic.policy import save_text
from tumato_symbolic.verify.workers import in_workers

pytestmark = pytest.mark.skipif(not can_fork(), reason="there are no children here")


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(supervise, "GRACE", 0.05)


def _for_ever() -> int:
    while True:
        time.sleep(100)


def _kept(numbers: list[int], number: int) -> int:
    numbers.append(number)
    return number


def _soon() -> Context:
    return Context(Limits(seconds=0.5))


def _wait_for_the_end_of(process: int) -> None:
    """A process is gone, or has ended and was not yet asked for its exit code; nobody waits for one that goes on."""
    with suppress(FileNotFoundError):
        while "State:\tZ" not in Path(f"/proc/{process}/status").read_text():
            time.sleep(0.01)


@pytest.mark.parametrize("code", [0, 1, 3, 70])
def test_the_exit_code_is_the_childs(code: int) -> None:
    """A child that ends by itself decides the exit code, and hears of no limit."""
    assert supervised(lambda: code, Context(Limits(seconds=1000.0))) == code


def test_a_child_that_does_not_end_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever a child is at, it is gone soon after the limit; what it did and knew last is known."""
    context, fork, children = _soon(), os.fork, list[int]()
    monkeypatch.setattr(os, "fork", lambda: _kept(children, fork()))

    def work() -> int:
        context.enter("proving goals")
        context.learn(("an", "answer"))
        return _for_ever()

    with pytest.raises(EndedError, match=r"^the time limit of 0.5 s was met while proving goals$"):
        supervised(work, context)
    assert context.known == ("an", "answer")
    with pytest.raises(ChildProcessError):
        os.waitpid(children[0], os.WNOHANG)


def test_what_was_told_before_is_not_sent_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Findings refer to what was in earlier ones; the last is known as a whole."""
    context, large = _soon(), tuple(str(number) for number in range(100_000))
    sizes, write = list[int](), os.write

    def work() -> int:
        monkeypatch.setattr(os, "write", lambda file, data: _kept(sizes, write(file, data)))
        for number in range(3):
            context.learn((number, large))
        context.learn(((3, sum(sizes)), large))
        return _for_ever()

    with pytest.raises(EndedError):
        supervised(work, context)
    assert isinstance(context.known, tuple)
    (number, sent), told = context.known
    assert (number, told) == (3, large)
    assert sent < 2 * len(pickle.dumps(large))


def test_workers_of_the_child_end_with_it(tmp_path: Path) -> None:
    """Processes that the child has made are ended as well."""
    place = tmp_path / "number"

    def grandchild() -> int:
        place.write_text(str(os.getpid()))
        return _for_ever()

    with pytest.raises(EndedError):
        supervised(lambda: len(in_workers([grandchild], 1)), Context(Limits(seconds=1.0)))
    _wait_for_the_end_of(int(place.read_text()))


def test_memory_is_limited() -> None:
    """A child that takes more memory than it may is ended, whoever takes it; it begins with what this process has."""
    limit = round(megabytes_of(os.getpid())) + 200
    context = Context(Limits(megabytes=limit))

    def work() -> int:
        context.enter("growing")
        grown = [b"x" * 2**20 for _ in range(400)]
        return _for_ever() + len(grown)

    with pytest.raises(EndedError, match=f"^the memory limit of {limit} MB was met while growing$"):
        supervised(work, context)


def test_an_output_that_was_begun_is_ended_first(tmp_path: Path) -> None:
    """A limit that is met while something is written waits for that; what would be written later is not."""
    context = _soon()

    def work() -> int:
        with console.writing():
            (tmp_path / "one").write_text("half")
            time.sleep(0.8)
            (tmp_path / "one").write_text("whole")
        with console.writing():
            (tmp_path / "other").write_text("whole")
        return 0

    with pytest.raises(EndedError):
        supervised(work, context)
    assert (tmp_path / "one").read_text() == "whole"
    assert not (tmp_path / "other").exists()


@pytest.mark.parametrize(("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, TerminatedError)])
def test_signals_end_the_child(number: int, raised: type[BaseException]) -> None:
    """Ctrl-C and SIGTERM end the child, and leave what it knew."""
    context, parent = Context(Limits(seconds=1000.0)), os.getpid()

    def work() -> int:
        context.learn("something")
        os.kill(parent, number)
        return _for_ever()

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job begins without it
    try:
        with pytest.raises(raised):
            supervised(work, context)
    finally:
        signal.signal(signal.SIGINT, before)
    assert context.known == "something"


def test_a_signal_that_is_ignored_stays_so() -> None:
    """A command under `nohup` goes on when its terminal is closed."""
    parent = os.getpid()

    def work() -> int:
        os.kill(parent, signal.SIGHUP)
        time.sleep(0.3)
        return 3

    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert supervised(work, Context(Limits(seconds=1000.0))) == 3
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_signals_end_the_process_again_where_there_is_no_child(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system has no process left to give, Ctrl-C and SIGTERM mean what they meant."""

    def fork() -> int:
        raise BlockingIOError

    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.getsignal(number) for number in numbers]
    monkeypatch.setattr(os, "fork", fork)
    with pytest.raises(BlockingIOError):
        supervised(_for_ever, Context(Limits(seconds=1000.0)))
    assert [signal.getsignal(number) for number in numbers] == before


def test_signals_are_noted_whichever_thread_receives_them() -> None:
    """A solver's thread may receive what this one has blocked; what the child knew is known all the same."""
    ended = threading.Event()
    other = threading.Thread(target=ended.wait)
    other.start()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})
    try:
        test_signals_end_the_child(signal.SIGTERM, TerminatedError)
        assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == before | {signal.SIGTERM}
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        ended.set()
        other.join()


@pytest.mark.parametrize(("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, TerminatedError)])
def test_what_is_being_read_when_a_signal_comes_is_known(
    number: int, raised: type[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A signal that comes between the last byte of a message and its end loses nothing."""
    context, parent, read = Context(Limits(seconds=1000.0)), os.getpid(), os.read
    sent: list[int] = []

    def interrupted(file: int, size: int) -> bytes:
        data = read(file, size)
        if os.getpid() == parent and not sent:
            sent.append(number)
            os.kill(parent, number)
        return data

    def work() -> int:
        context.learn("something")
        return _for_ever()

    monkeypatch.setattr(os, "read", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(raised):
            supervised(work, context)
    finally:
        signal.signal(signal.SIGINT, before)
    assert context.known == "something"


def test_a_child_that_is_ended_while_it_writes_leaves_no_temporary_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where writing takes longer than anybody waits, the child is told to end before it is ended."""
    monkeypatch.setattr(supervise, "PATIENCE_WITH_OUTPUT", 0.05)
    parent = os.getpid()

    def fsync(fd: object) -> None:
        os.kill(parent, signal.SIGTERM)
        _for_ever()

    def work() -> int:
        os.fsync = fsync
        with console.writing():
            save_text("new", tmp_path / "policy.json", "policy")
        return 0

    with pytest.raises(TerminatedError):
        supervised(work, Context(Limits(seconds=1000.0)))
    assert list(tmp_path.iterdir()) == []


def test_a_child_that_crashes_is_a_bug() -> None:
    """A signal that nobody sent is no verdict; one that the system sends because memory ran out is undecided."""

    def ended_by(number: int) -> Callable[[], int]:
        def end() -> int:
            os.kill(os.getpid(), number)
            return 0

        return end

    with pytest.raises(ChildCrashedError, match="killed by signal"):
        supervised(ended_by(signal.SIGUSR1), Context())
    with pytest.raises(EndedError, match="memory ran out"):
        supervised(ended_by(signal.SIGKILL), Context())
    with pytest.raises(TerminatedError, match="15"):
        supervised(ended_by(signal.SIGTERM), Context())


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends children with their parents")
def test_a_child_ends_with_its_parent() -> None:
    """Even a parent that is killed leaves no child behind."""
    code = (
        "import os, time\nfrom tests.limits.test_supervise import orphan\nparent = os.getpid()\n"
        "child = os.fork()\nif child == 0: orphan(parent)\nprint(child, flush=True)\ntime.sleep(100)"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        child = int(process.stdout.readline())
        process.kill()
    _wait_for_the_end_of(child)


def orphan(parent: int) -> None:
    """What the child does in the test above."""
    end_with(parent)
    _for_ever()
