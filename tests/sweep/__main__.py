"""500 variants of the AMR by one process, by two, on a cluster of two workers, and with one of these killed.

`python -m tests.sweep [--variants N]` prints how long each took, as wall and as processor time, and fails where the
results are not the same bytes. Wall times tell something on a machine that has nothing else to do.
"""

from __future__ import annotations

import argparse
import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from tests.sweep.here import AMR
from tumato_symbolic.limits.processes import descendants
from tumato_symbolic.sweep import Plan, Task, defined, definition, kept, processes, sweep
from tumato_symbolic.sweep.portions import Hired


def main() -> int:
    """Measure all of them that can be."""
    parser = argparse.ArgumentParser(prog="python -m tests.sweep", description=__doc__)
    parser.add_argument("--variants", type=int, default=500, help="how many, a multiple of 4 (default: 500)")
    number = parser.parse_args().variants
    bounds = ",".join(map(str, range(1, number // 4 + 1)))
    said = (f"max_plan_length={bounds}", "effect_ordering=any,first", "preconditions=at_start,throughout")
    plan = Plan("define", AMR, defined(AMR, [definition(each) for each in said]))
    found = [
        _measured("one process", plan, lambda: processes(1)),
        _measured("two processes", plan, lambda: processes(2)),
    ]
    try:
        from distributed import LocalCluster
    except ImportError:
        print("distributed is not installed: no cluster")
    else:
        from tumato_symbolic.sweep.cluster import cluster

        for what, kills in (("a cluster of two workers", False), ("with one of them killed", True)):
            with ExitStack() as stack:
                options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
                workers = stack.enter_context(LocalCluster(**options))
                half = _killing(workers, len(plan.variants) // 2) if kills else None
                address: str = workers.scheduler_address
                found.append(_measured(what, plan, lambda address=address: cluster(address), half))  # type: ignore[misc]
    return len(set(found)) != 1


def _killing(workers: Any, after: int) -> Callable[[int], None]:
    """Kill a worker when so many variants are done."""
    victim, once = next(each.pid for each in workers.workers.values()), threading.Event()

    def heard(done: int) -> None:
        if done >= after and not once.is_set():
            once.set()
            os.kill(victim, signal.SIGKILL)

    return heard


def _measured(what: str, plan: Plan, hired: Callable[[], Hired], told: Callable[[int], None] | None = None) -> bytes:
    """The results as they stand in a file; prints what they took."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "results.jsonl")
        before, began = _processor(), time.perf_counter()
        with kept(str(path), plan.header("0")) as results:
            used = 0.0

            def heard() -> None:
                nonlocal used
                if told is not None:
                    told(len(results.lines))
                if len(results.lines) == results.total:
                    used = _processor() - before  # while those who worked are there

            sweep(plan, Task("", ""), hired, results, heard=heard)
        wall = time.perf_counter() - began
        text = path.read_bytes()
    print(f"{what:<26}{wall:8.2f} s wall{used:9.2f} s of processors", flush=True)
    return text


def _processor() -> float:
    """The processor time of this process, of those below it that run, and of those that have ended and were ours."""
    ticks = 0
    for process in descendants(os.getpid()):
        with suppress(OSError):
            ticks += sum(map(int, Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[11:15]))
    return ticks / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    sys.exit(main())
