"""This process and its children: whether it can have any, that they end with it, how much memory they take."""

from __future__ import annotations

import os
import sys
import time
from contextlib import suppress
from pathlib import Path

_MOST_LINKS = 40
"""Symbolic links that are followed one after the other."""


def can_fork() -> bool:
    """Whether this platform has children that begin with all that is known here."""
    return hasattr(os, "fork") and sys.platform != "darwin"


def end_with(parent: int) -> None:
    """Let this process be killed when its parent, which has this number, ends, however it ends. Linux only."""
    if sys.platform == "linux":
        import ctypes
        import signal

        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:
            os._exit(1)


def age() -> float:
    """How many seconds ago this process began; 0 where the system does not tell."""
    with suppress(OSError, ValueError, IndexError, AttributeError):
        ticks = int(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK"))
    return 0.0


def megabytes_of(process: int) -> float:
    """How much memory a process and its descendants take together, what they share once; 0 where that is unknown."""
    family = descendants(process)
    if len(family) == 1:
        return _resident(process)
    return sum(_proportional(each) for each in family)


def _resident(process: int) -> float:
    with suppress(OSError, ValueError, IndexError):
        return int(Path(f"/proc/{process}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20
    return 0.0


def _proportional(process: int) -> float:
    """Its own memory and its share of what it has in common with others."""
    with suppress(OSError, ValueError, StopIteration):
        lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
        return int(next(line for line in lines if line.startswith("Pss:")).split()[1]) / 2**10
    return 0.0


def descendants(process: int) -> list[int]:
    """A process and all below it."""
    found = [process]
    for each in found:
        with suppress(OSError, ValueError):
            for thread in Path(f"/proc/{each}/task").iterdir():
                found += map(int, (thread / "children").read_text().split())
    return found


def open_file(path: Path) -> int | None:
    """The open file of this process that a name such as `/dev/stdout` or `/dev/fd/63` stands for, by its number.

    Raises `OSError` or `RuntimeError` for names that lead nowhere.
    """
    ours = (Path("/dev/fd"), Path(f"/proc/{os.getpid()}/fd"))
    for _ in range(_MOST_LINKS):
        if path.name.isdecimal() and path.parent.resolve() in ours:
            return int(path.name)
        if not path.is_symlink():
            return None
        path = path.parent / path.readlink()
    return None
