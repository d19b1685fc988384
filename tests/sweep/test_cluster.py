"""The same work by the workers of a Dask cluster."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import wait
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from benchmarks.robots import loads
from tests.repo.documents import ROOT
from tests.sweep.here import AMR, COIN, run, shuffling
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.sweep import Plan, Task, cluster, kept, mutated, sweep
from tumato_symbolic.sweep.portions import Workers
from tumato_symbolic.sweep.tasks import Batch, Reply
from tumato_symbolic.sweep.versions import versions

distributed = pytest.importorskip("distributed", reason="distributed is not installed (make tools)")
dask = pytest.importorskip("dask")

TASK = Task("", "", prove=False)
PLAN = Plan("mutate", AMR, mutated(AMR, 12, 0)[0])


def made() -> Any:
    """A scheduler and two workers, which are processes of their own."""
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    return distributed.LocalCluster(processes=True, **options)


@pytest.fixture(scope="module")
def workers() -> Iterator[Any]:
    """They are made once."""
    with made() as found:
        yield found


def swept(hired: Any, plan: Plan = PLAN, heard: Callable[[], None] = lambda: None) -> str:
    """All results as text."""
    with kept(None, plan.header("0")) as results:
        sweep(plan, TASK, hired, results, heard=heard)
        return results.text()


def test_a_worker_that_is_killed_loses_nothing(workers: Any) -> None:
    """The results are the same bytes as on one machine."""
    alone = run(None, shuffling(0, {}), PLAN)
    victims = [next(each.pid for each in workers.workers.values())]

    def heard() -> None:
        if victims:
            os.kill(victims.pop(), signal.SIGKILL)

    assert swept(lambda: cluster.cluster(workers.scheduler_address), heard=heard) == alone
    assert not victims


def test_a_text_that_kills_workers_is_lost_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """All that was handed over with it, and to the same worker, is solved by others."""
    guilty = PLAN.variants[2]
    text, asking, submit = guilty.text(AMR), cluster._asking, cluster._Cluster.submit
    together: list[int] = []

    def deadly(*versions: Any) -> Any:
        ask = asking(*versions)

        def killed(batch: str) -> Any:
            if text in Batch.read(batch).texts:
                os.kill(os.getpid(), signal.SIGKILL)
            return ask(batch)

        return killed

    def submitted(found: cluster._Cluster, batch: str) -> Any:
        texts = Batch.read(batch).texts
        together.extend([len(texts)] if text in texts else [])
        return submit(found, batch)

    monkeypatch.setattr(cluster, "_asking", deadly)
    monkeypatch.setattr(cluster._Cluster, "submit", submitted)
    monkeypatch.setattr(cluster, "_SECONDS", 10.0)
    alone = run(None, shuffling(0, {}), PLAN).splitlines()
    with dask.config.set({"distributed.scheduler.allowed-failures": 0}), made() as workers:
        found = swept(lambda: cluster.cluster(workers.scheduler_address)).splitlines()
    line = json.loads(found.pop(guilty.number + 1))
    assert (line["verdict"], line["limit"]) == (
        "undecided",
        "the workers that solved it were killed one after the other",
    )
    assert found == [*alone[: guilty.number + 1], *alone[guilty.number + 2 :]]
    assert together[0] > 1
    assert together[-1] == 1


def test_a_worker_that_can_start_no_process(workers: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is named, with what the system told it: the connection to it is not lost."""
    asking = cluster._asking

    def starved(*versions: Any) -> Any:
        ask = asking(*versions)

        def failing(batch: str) -> Any:
            from unittest.mock import patch

            with patch("tumato_symbolic.sweep.asking.ask", side_effect=OSError(24, "Too many open files")):
                return ask(batch)

        return failing

    monkeypatch.setattr(cluster, "_asking", starved)
    with pytest.raises(UserError, match=r"the worker tcp://\S+ of .* cannot .*: \[Errno 24\] Too many") as error:
        swept(lambda: cluster.cluster(workers.scheduler_address))
    assert "the same command goes on" in str(error.value.diagnostics[0].help)


def test_other_versions_are_refused(workers: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the worker, the package, and both versions."""
    here = {**versions()(), "dd": "0.0.1"}
    monkeypatch.setattr(cluster, "versions", lambda: _Pretending(here))
    with pytest.raises(UserError, match=r"TUM119: the worker .* and dd here is 0\.0\.1"):
        swept(lambda: cluster.cluster(workers.scheduler_address))


def test_a_worker_with_other_versions_may_not_join(workers: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is asked with each batch, since it may come when the others have been asked."""
    here = {**versions()(), "dd": "0.0.1"}
    monkeypatch.setattr(cluster, "versions", lambda: _Pretending(here))
    monkeypatch.setattr(cluster._Cluster, "run", lambda *_: {})
    with pytest.raises(UserError, match=r"TUM119: the worker .* and dd here is 0\.0\.1"):
        swept(lambda: cluster.cluster(workers.scheduler_address))


class _Pretending:
    """What tells other versions here than in a worker."""

    def __init__(self, here: dict[str, str | None]) -> None:
        self._here, self._owner = here, os.getpid()

    def __call__(self) -> dict[str, str | None]:
        return self._here if os.getpid() == self._owner else {**self._here, "dd": "0.6"}


@pytest.mark.parametrize(
    ("address", "said"),
    [("127.0.0.1:9", "cannot be reached"), ("nowhere", "missing port"), ("http://a:b/", "unknown address scheme")],
)
def test_a_scheduler_that_is_not_there(address: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is an error with a way out, soon."""
    monkeypatch.setattr(cluster, "_PATIENCE", 0.3)
    with pytest.raises(UserError) as error:
        swept(lambda: cluster.cluster(address))
    (diagnostic,) = error.value.diagnostics
    assert said in diagnostic.message
    assert diagnostic.help


def test_a_scheduler_without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Is not waited for."""
    monkeypatch.setattr(cluster, "_PATIENCE", 0.5)
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None, silence_logs=50) as empty,
        pytest.raises(UserError, match="has no workers"),
    ):
        swept(lambda: cluster.cluster(empty.scheduler_address))


class Started:
    """A scheduler and workers that nobody starts anew: processes as users have them."""

    def __init__(self, folder: Path) -> None:
        self.folder, self._file = folder, folder / "scheduler.json"
        self._processes: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        while not self._file.exists():
            time.sleep(0.05)

    @property
    def address(self) -> str:
        """Where the scheduler is."""
        return str(json.loads(self._file.read_text())["address"])

    def worker(self) -> subprocess.Popen[bytes]:
        """A worker of one thread, which may be there a moment later."""
        return self._start("worker", "--no-nanny", "--nthreads", "1", "--no-dashboard")

    def end(self) -> None:
        """Leave none of them, not even one that is stopped."""
        for each in self._processes:
            each.kill()
            each.wait()

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        started = subprocess.Popen(
            [sys.executable, "-m", "dask", *words, "--scheduler-file", str(self._file)],
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._processes.append(started)
        return started


@pytest.fixture
def started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Started]:
    """A scheduler; it and its workers, which may take a while to start, are ended."""
    monkeypatch.setattr(cluster, "_PATIENCE", 60.0)
    found = Started(tmp_path)
    yield found
    found.end()


@contextmanager
def once(action: Callable[[], object]) -> Iterator[Callable[[], None]]:
    """What does something when it is called first, which has to happen."""
    done: list[object] = []

    def heard() -> None:
        if not done:
            done.append(action())

    yield heard
    assert done


@pytest.mark.parametrize(
    ("whom", "number", "said"),
    [
        ("worker", signal.SIGKILL, "has no workers any more"),
        ("worker", signal.SIGSTOP, "has no worker that has answered within 2 s"),
        ("scheduler", signal.SIGKILL, "was lost"),
        ("scheduler", signal.SIGSTOP, "has not answered within 2 s"),
    ],
)
def test_nobody_is_left_who_works(
    whom: str, number: int, said: str, started: Started, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This is an error with a way out, in bounded time; what was found is kept, and the same command goes on."""
    monkeypatch.setattr(cluster, "_SILENCE", 2.0)
    results = started.folder / "results.jsonl"
    worker = started.worker()
    victim = worker if whom == "worker" else started.scheduler
    with once(lambda: victim.send_signal(number)) as heard, kept(str(results), PLAN.header("0")) as found:
        with pytest.raises(UserError, match=said) as error:
            sweep(PLAN, TASK, lambda: cluster.cluster(started.address), found, heard=heard)
        assert "the same command goes on" in str(error.value.diagnostics[0].help)
        assert 0 < len(found.lines) < found.total
    assert results.read_text().splitlines()[1:] == [json.dumps(each, ensure_ascii=False) for each in found.in_order()]
    assert run(results, shuffling(0, {}), PLAN) == run(None, shuffling(0, {}), PLAN)


def test_a_worker_that_hangs(started: Started, monkeypatch: pytest.MonkeyPatch) -> None:
    """What it was at is done by another; nothing is lost."""
    monkeypatch.setattr(cluster, "_SILENCE", 2.0)
    victim, _ = started.worker(), started.worker()
    with once(lambda: victim.send_signal(signal.SIGSTOP)) as heard:
        hired = partial(_with_two, started.address)
        assert swept(hired, heard=heard) == run(None, shuffling(0, {}), PLAN)


def test_a_worker_that_hangs_at_the_start(started: Started, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is named, and not waited for."""
    worker = started.worker()
    with cluster.cluster(started.address):
        pass
    monkeypatch.setattr(cluster, "_PATIENCE", 1.0)
    worker.send_signal(signal.SIGSTOP)
    with pytest.raises(UserError, match=r"the worker tcp:.* there is no answer within 1 s"):
        swept(lambda: cluster.cluster(started.address))


def test_a_worker_that_joins_late(started: Started) -> None:
    """It gets work as well; and there is time to start one anew where none is left."""
    first = started.worker()
    with cluster.cluster(started.address) as workers:
        assert workers.hands() == 1
        started.worker()
        _until(lambda: workers.hands() == 2)
        first.kill()
        _until(lambda: workers.hands() == 1)
        reply = workers.submit(Batch(TASK, (COIN.text,), 1.0).written())
        assert Reply.read(reply.result()).answers[0].result["verdict"] == "realizable"


def test_who_gives_up_leaves_workers_free(started: Started) -> None:
    """What they were at is ended, though it would take long; else the next sweep would wait for it."""
    started.worker()
    for text, within in ((loads(100, realizable=True), 1), (COIN.text, 60)):
        with cluster.cluster(started.address) as workers:
            reply = workers.submit(Batch(TASK, (text,), 1.0).written())
            wait([reply], within)
    assert Reply.read(reply.result(0)).answers[0].result["verdict"] == "realizable"


@contextmanager
def _with_two(address: str) -> Iterator[Workers]:
    """The workers, once there are two."""
    with cluster.cluster(address) as workers:
        _until(lambda: workers.hands() == 2)
        yield workers


def _until(what: Callable[[], bool]) -> None:
    """Wait, for a minute at most."""
    until = time.monotonic() + 60
    while not what():
        assert time.monotonic() < until
        time.sleep(0.1)
