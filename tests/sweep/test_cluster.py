"""The same work by the workers of a Dask cluster."""

import json
import os
import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.sweep.here import AMR, run, shuffling
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.sweep import Plan, Task, asking, cluster, kept, mutated, sweep
from tumato_symbolic.sweep.tasks import Batch

distributed = pytest.importorskip("distributed", reason="distributed is not installed (make tools)")
dask = pytest.importorskip("dask")

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
        sweep(plan, Task("", "", prove=False), hired, results, heard=heard)
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
    text, asked = guilty.text(AMR), asking.ask
    together: list[int] = []

    def deadly(batch: str) -> str:
        if text in Batch.read(batch).texts:
            os.kill(os.getpid(), signal.SIGKILL)
        return asked(batch)

    def submitted(client: Any, address: str, batch: str) -> Any:
        texts = Batch.read(batch).texts
        together.extend([len(texts)] if text in texts else [])
        return submit(client, address, batch)

    submit = cluster._submitted
    monkeypatch.setattr(cluster, "ask", deadly)
    monkeypatch.setattr(cluster, "_submitted", submitted)
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


def test_other_versions_are_refused(workers: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the worker, the package, and both versions."""
    here = {**cluster._versions()(), "dd": "0.0.1"}
    monkeypatch.setattr(cluster, "_versions", lambda: _Pretending(here))
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
