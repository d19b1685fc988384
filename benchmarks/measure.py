"""Whole processes: their time, their memory, and the machine they ran on."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from msgspec import Struct

COMMAND = (sys.executable, "-c", "from tumato_symbolic.__main__ import entry; entry()")
"""What the console script `tumato-sym` runs."""

UNIT = (sys.executable, "-c", "import z3, lark, dd.cudd")
"""Its time is one unit: a machine's speed, and the least that a cold run of ours could take."""

REPEATS = 5
REPEATED_UP_TO = 2.0
"""Processes that take no more seconds than this are run `REPEATS` times, the others once; the best time counts."""


class Ran(Struct, frozen=True):
    """A finished process; `code` is None where it was ended at the time limit.

    `seconds` passed on the clock; `cpu` seconds were computed, which says more on a machine that others use too.
    """

    code: int | None
    output: str
    seconds: float
    cpu: float
    peak_mb: int

    def record(self) -> dict[str, object]:
        """What is kept of it."""
        times = {"seconds": round(self.seconds, 3), "cpu": round(self.cpu, 3)}
        return {"exit": self.code, **times, "peak_mb": self.peak_mb}


def run(command: Sequence[str], limit: float) -> Ran:
    """One process, in the folder of the repository; it may take `limit` seconds."""
    root = Path(__file__).resolve().parents[1]
    with tempfile.TemporaryFile() as output:
        started = time.perf_counter()
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.DEVNULL, cwd=root)
        ended_by_us = threading.Event()

        def end() -> None:
            ended_by_us.set()
            process.kill()

        timer = threading.Timer(limit, end)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - started
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode()
    code = None if ended_by_us.is_set() else process.returncode
    return Ran(code, text, seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024)


def best(command: Sequence[str], limit: float, repeats: int = REPEATS) -> Ran:
    """The fastest of some runs, or the only one where the first takes long."""
    runs = [run(command, limit)]
    while len(runs) < repeats and runs[0].seconds <= REPEATED_UP_TO:
        runs.append(run(command, limit))
    return min(runs, key=lambda ran: ran.seconds)


def machine() -> dict[str, object]:
    """What the times depend on; nothing that names the machine."""
    return {
        "cpu": _cpu(),
        "cores": os.cpu_count(),
        "memory_gb": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9),
        "system": platform.system(),
        "python": platform.python_version(),
        "versions": {name: version(name) for name in ("tumato-symbolic", "dd", "lark", "msgspec", "z3-solver")},
    }


def _cpu() -> str:
    described = Path("/proc/cpuinfo")
    if described.exists():
        for line in described.read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
