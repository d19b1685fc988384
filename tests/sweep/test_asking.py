"""Child processes that solve texts: whatever becomes of one, the next text is answered."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from msgspec.structs import replace

from benchmarks.robots import loads
from tests.sweep.here import AMR, COIN
from tumato_symbolic.limits.processes import megabytes_of
from tumato_symbolic.sweep import Task, asking
from tumato_symbolic.sweep.asking import Children
from tumato_symbolic.sweep.solving import solved
from tumato_symbolic.sweep.tasks import Answer, Batch, Reply

QUICK = Task("coin.tum", COIN.text)
LONG = Task("loads.tum", loads(25, realizable=True))
FOUND = solved(QUICK)


_PREPARED = """
import sys, time; sys.path.append(sys.argv[1])
from tumato_symbolic.sweep import solving
right = solving.solved
def greedy():
    taken = b"x" * 400_000_000
    time.sleep(60)
def solved(task):
    return greedy() if task.text == "greedy" else 1 / 0 if task.text == "faulty" else right(task)
solving.solved = solved
"""
"""A child that takes much memory for one text, and has a bug for another."""


@pytest.fixture
def children() -> Iterator[Children]:
    """Children, none of which is left."""
    found = Children()
    yield found
    found.end()


def asked(children: Children, task: Task, *texts: str, enough: float = 60.0) -> tuple[Answer, ...]:
    """The answers to a batch of the task and other texts."""
    reply = Reply.read(children.ask(Batch(task, (task.text, *texts), enough).written()))
    assert reply.bug is None
    return reply.answers


def why(*answers: Answer) -> str:
    """Why there is no answer at the end."""
    assert answers[-1].result["verdict"] == "undecided"
    return str(answers[-1].result["limit"])


def killing(children: Children, after: float) -> threading.Thread:
    """Kill the only child in so many seconds."""

    def kill() -> None:
        while not children._all:
            time.sleep(0.01)
        time.sleep(after)
        os.kill(next(iter(children._all)).number, signal.SIGKILL)

    thread = threading.Thread(target=kill)
    thread.start()
    return thread


def test_answers_are_those_of_the_solver(children: Children) -> None:
    """To the byte, from the same child again and again; each text of a batch is answered."""
    for task in (QUICK, replace(QUICK, policy=True), Task("wrong", "BEGIN"), QUICK):
        assert asked(children, task) == (solved(task),)
    texts = (COIN.text, "BEGIN", COIN.text)
    assert asked(children, QUICK, *texts) == (FOUND, *(solved(replace(QUICK, text=each)) for each in texts))
    assert len(children._all) == 1


def test_children_that_are_started_are_used(children: Children) -> None:
    """Each of them, and no other."""
    children.start(2)
    started = set(children._all)
    assert len(started) == 2
    askers = [threading.Thread(target=asked, args=(children, QUICK)) for _ in range(2)]
    for each in askers:
        each.start()
    for each in askers:
        each.join()
    assert children._all == started


def test_a_batch_that_takes_long_is_left(children: Children) -> None:
    """After an answer; the rest is for others, and the child goes on with another batch."""
    assert asked(children, QUICK, COIN.text, COIN.text, enough=0.0) == (FOUND,)
    assert asked(children, QUICK, COIN.text) == (FOUND, FOUND)
    assert len(children._all) == 1


def test_a_bug_leaves_what_was_found(children: Children, monkeypatch: pytest.MonkeyPatch) -> None:
    """The traceback comes in place of the answer, after those that there are."""
    monkeypatch.setattr(asking, "_PROGRAM", _PREPARED + asking._PROGRAM)
    reply = Reply.read(children.ask(Batch(QUICK, (COIN.text, "faulty", COIN.text), 60.0).written()))
    assert reply.answers == (FOUND,)
    assert reply.bug is not None
    assert "ZeroDivisionError" in reply.bug
    assert asked(children, QUICK) == (FOUND,)


def test_a_child_that_is_killed(children: Children) -> None:
    """Its text is undecided, and why, as the last of its batch; another child takes the next one."""
    asked(children, QUICK)
    killer = killing(children, after=1.0)
    found = asked(children, QUICK, COIN.text, LONG.text, COIN.text)
    killer.join()
    assert found[:-1] == (FOUND, FOUND)
    assert "most likely because memory ran out" in why(*found)
    assert asked(children, QUICK) == (FOUND,)


def test_limits_end_a_child(children: Children, monkeypatch: pytest.MonkeyPatch) -> None:
    """That of memory, and that of time where the child does not end by itself; the next text is answered."""
    assert "the memory limit of 1 MB was met" in why(*asked(children, replace(LONG, megabytes=1), COIN.text))
    monkeypatch.setattr(asking, "_GRACE", -100.0)
    assert "the time limit of 90 s was met" in why(*asked(children, replace(LONG, seconds=90), COIN.text))
    assert asked(children, QUICK) == (FOUND,)


def test_a_text_that_exhausts_memory_is_undecided_alone(children: Children, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the middle of a batch: what was before it is answered, and another child takes what comes after it."""
    if not megabytes_of(os.getpid()):
        pytest.skip("the system does not tell how much memory a process has")
    monkeypatch.setattr(asking, "_PROGRAM", _PREPARED + asking._PROGRAM)
    limited = replace(QUICK, megabytes=350)
    found = asked(children, limited, AMR.text, "greedy", COIN.text)
    assert found[:-1] == (FOUND, solved(replace(QUICK, text=AMR.text)))
    assert "the memory limit of 350 MB was met" in why(*found)
    assert asked(children, limited) == (FOUND,)


def test_a_child_that_has_grown_gets_no_other_text(children: Children) -> None:
    """Else that would be undecided for what the one before it took."""
    if not megabytes_of(os.getpid()):
        pytest.skip("the system does not tell how much memory a process has")
    asked(children, replace(QUICK, megabytes=10_000))
    (child,) = children._all
    assert child.is_ready
    most = int(1.6 * megabytes_of(child.number))
    assert asked(children, replace(QUICK, megabytes=most), COIN.text) == (FOUND,)
    assert not child.is_ready


def test_children_end_at_once(children: Children) -> None:
    """Those that are at work too; who waits is told, and no other child is made."""
    threading.Timer(0.3, children.end).start()
    assert "killed" in why(*asked(children, LONG))
    with pytest.raises(asking.EndedError):
        asked(children, QUICK)


def test_a_reply_that_is_not_wanted_any_more(children: Children) -> None:
    """The child is ended at once, and another one takes the next text."""
    until = time.monotonic() + 0.3
    with pytest.raises(asking.EndedError):
        children.ask(Batch(LONG, (LONG.text,), 60.0).written(), lambda: time.monotonic() < until)
    assert not children._all
    assert asked(children, QUICK) == (FOUND,)


def test_nothing_is_imported_from_the_folder(
    children: Children, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file there that is called like a module of Python is not executed."""
    (tmp_path / "json.py").write_text("raise SystemExit(3)")
    (tmp_path / "tumato_symbolic.py").write_text("raise SystemExit(3)")
    monkeypatch.chdir(tmp_path)
    assert asked(children, QUICK) == (FOUND,)
