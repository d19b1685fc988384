"""Each fault in a process of its own: the tests of its module run against the changed module.

A process forks from one that has loaded what others made (pytest, Z3, CUDD), and nothing of the project; the changed
module is compiled in the place of its file. So a fault costs what its tests cost, and no start of an interpreter.
"""

from __future__ import annotations

import importlib.machinery
import os
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import CodeType
from typing import Any, Literal

from msgspec import Struct

from tests.mutants_code.sites import planted

IDLE = 60.0
"""After so many seconds in which a run, with all its children, uses no processor, it waits for ever."""

Outcome = Literal["survived", "noticed", "no end", "crash", "not loaded", "error"]
"""How the tests ended.

`noticed`: a test failed. `no end`: they took many times the processor time that they take without a fault, or wait for
ever. `crash`: a signal ended the interpreter. `not loaded`: the module cannot be compiled or imported, and nobody can
miss that. `error`: pytest itself failed.
"""
_CODES: dict[int, Outcome] = {10: "survived", 11: "noticed", 12: "not loaded"}


class Ending(Struct, frozen=True):
    """How the tests ended, in how many seconds of the processor."""

    how: Outcome
    seconds: float

    @property
    def killed(self) -> bool:
        """Whether the tests would have stopped the fault: one failed, or they did not come to an end by themselves."""
        return self.how in ("noticed", "no end", "crash")


def load_what_tests_need() -> None:
    """Load what is not of the project, once for all processes."""
    import dd.cudd  # noqa: F401
    import hypothesis  # noqa: F401
    import jsonschema  # noqa: F401
    import lark  # noqa: F401
    import pytest  # noqa: F401
    import z3  # noqa: F401

    loaded = [name for name in sys.modules if name.split(".")[0] == "tumato_symbolic"]
    if loaded:
        raise RuntimeError(f"loaded too early: {loaded}")


def run_tests(tests: Sequence[str], path: Path | None, module: str, number: int, seconds: float) -> Ending:
    """The tests with fault `number` of the module at `path` (None: with none), within some seconds of the processor."""
    child = os.fork()
    if child == 0:
        _be_the_child(tests, path, module, number, seconds)
    used, moved = 0, time.monotonic()
    while True:
        ended, status, usage = os.wait4(child, os.WNOHANG)
        if ended:
            break
        now = time.monotonic()
        if now - moved > IDLE / 10:
            before, used = used, _ticks(child)
            if used != before:
                moved = now
            elif now - moved > IDLE:
                os.killpg(child, signal.SIGKILL)
        time.sleep(0.02)
    return Ending(_outcome(status), usage.ru_utime + usage.ru_stime)


def _outcome(status: int) -> Outcome:
    if os.WIFSIGNALED(status):
        return "no end" if os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL) else "crash"
    return _CODES.get(os.WEXITSTATUS(status), "error")


def _ticks(group: int) -> int:
    """The processor time of a process and of all that it has started, in ticks."""
    ticks = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            fields = stat.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            if int(fields[2]) == group:
                ticks += sum(map(int, fields[11:15]))
    return ticks


def _be_the_child(tests: Sequence[str], path: Path | None, module: str, number: int, seconds: float) -> None:
    code = 13
    try:
        os.setpgid(0, 0)
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        with tempfile.TemporaryFile() as out:
            os.dup2(out.fileno(), 1)
            os.dup2(out.fileno(), 2)
            code = 12 if path is not None and not _plant(path, module, number) else _first_failure(tests)
    finally:
        os._exit(code)


class _Record:
    """What pytest reports: which tests failed, and which files could not be loaded."""

    def __init__(self) -> None:
        self.failed = self.unloaded = self.passed = 0

    def pytest_runtest_logreport(self, report: Any) -> None:
        """A test, before, in or after its call."""
        self.failed += report.failed
        self.passed += report.when == "call" and not report.failed

    def pytest_collectreport(self, report: Any) -> None:
        """A file whose tests are looked up."""
        self.unloaded += report.failed


def _first_failure(tests: Sequence[str]) -> int:
    """How the first file ends whose tests do not all pass. Later files are not even loaded."""
    import pytest

    files = [test for test in tests if test.startswith("tests/")]
    options = [test for test in tests if not test.startswith("tests/")]
    passed = 0
    for file in files:
        record = _Record()
        arguments = [file, *options, "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--no-header", "--tb=no"]
        code = pytest.main(arguments, plugins=[record])
        passed += record.passed
        if record.failed:
            return 11
        if record.unloaded:
            return 12
        if code not in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            return 13
    return 10 if passed else 13


def _plant(path: Path, module: str, number: int) -> bool:
    """Whether the changed module can be compiled; it is loaded in the place of its file from now on."""
    try:
        code = compile(planted(path, module, number), str(path), "exec")
    except SyntaxError:
        return False
    plain = importlib.machinery.SourceFileLoader.get_code

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        return code if Path(loader.path) == path else plain(loader, fullname)

    setattr(importlib.machinery.SourceFileLoader, "get_code", get_code)  # noqa: B010 - a method is replaced
    return True
