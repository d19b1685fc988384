"""Child processes that solve texts: whatever becomes of one, the next task is answered."""

import json
import os
import signal
import threading
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from benchmarks.robots import loads
from tests.sweep.here import COIN, answer
from tumato_symbolic.limits.processes import megabytes_of
from tumato_symbolic.sweep import Task, asking
from tumato_symbolic.sweep.asking import Children

QUICK = Task("coin.tum", COIN.text)
LONG = Task("loads.tum", loads(25, realizable=True))


@pytest.fixture
def children() -> Iterator[Children]:
    """Children, none of which is left."""
    found = Children()
    yield found
    found.end()


def asked(children: Children, task: Task) -> str:
    """The answer, as text."""
    return children.ask(json.dumps(asdict(task)))


def why(text: str) -> str:
    """Why there is no answer."""
    found = json.loads(text)["result"]
    assert found["verdict"] == "undecided"
    return str(found["limit"])


def test_answers_are_those_of_the_solver(children: Children) -> None:
    """To the byte, from the same child again and again."""
    for task in (QUICK, replace(QUICK, policy=True), Task("wrong", "BEGIN"), QUICK):
        assert asked(children, task) == answer(json.dumps(asdict(task)))
    assert len(children._all) == 1


def test_a_child_that_is_killed(children: Children) -> None:
    """Its task is undecided, and why; another child takes the next one."""

    def kill() -> None:
        while not children._all:
            time.sleep(0.01)
        time.sleep(0.1)
        os.kill(next(iter(children._all)).number, signal.SIGKILL)

    threading.Thread(target=kill).start()
    assert "most likely because memory ran out" in why(asked(children, LONG))
    assert asked(children, QUICK) == answer(json.dumps(asdict(QUICK)))


def test_limits_end_a_child(children: Children, monkeypatch: pytest.MonkeyPatch) -> None:
    """That of memory, and that of time where the child does not end by itself; the next task is answered."""
    assert "the memory limit of 1 MB was met" in why(asked(children, replace(LONG, megabytes=1)))
    monkeypatch.setattr(asking, "_GRACE", -100.0)
    assert "the time limit of 90 s was met" in why(asked(children, replace(LONG, seconds=90)))
    assert asked(children, QUICK) == answer(json.dumps(asdict(QUICK)))


def test_a_child_that_has_grown_gets_no_other_task(children: Children) -> None:
    """Else that would be undecided for what the one before it took."""
    if not megabytes_of(os.getpid()):
        pytest.skip("the system does not tell how much memory a process has")
    asked(children, replace(QUICK, megabytes=10_000))
    (child,) = children._all
    assert child.is_ready
    most = int(1.6 * megabytes_of(child.number))
    assert json.loads(asked(children, replace(QUICK, megabytes=most)))["result"]["verdict"] == "realizable"
    assert not child.is_ready


def test_children_end_at_once(children: Children) -> None:
    """Those that are at work too; who waits is told, and no other child is made."""
    threading.Timer(0.3, children.end).start()
    assert "killed" in why(asked(children, LONG))
    with pytest.raises(asking.EndedError):
        asked(children, QUICK)


def test_nothing_is_imported_from_the_folder(
    children: Children, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file there that is called like a module of Python is not executed."""
    (tmp_path / "json.py").write_text("raise SystemExit(3)")
    (tmp_path / "tumato_symbolic.py").write_text("raise SystemExit(3)")
    monkeypatch.chdir(tmp_path)
    assert json.loads(asked(children, QUICK))["result"]["verdict"] == "realizable"
