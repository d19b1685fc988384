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
from dataclasses import dataclass
from pathlib import Path
from types import CodeType

from tests.mutants_code.sites import planted

WALL = 6
"""A fault may take so many times its limit of processor time on the clock, where others use the machine."""


@dataclass(frozen=True)
class Ending:
    """How the tests ended, in how many seconds of the processor. `killed`: a test failed, or they did not end."""

    killed: bool
    how: str
    seconds: float


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
    started = time.monotonic()
    child = os.fork()
    if child == 0:
        _be_the_child(tests, path, module, number, seconds)
    while True:
        ended, status, usage = os.wait4(child, os.WNOHANG)
        if ended:
            break
        if time.monotonic() - started > WALL * seconds:
            os.killpg(child, signal.SIGKILL)
        time.sleep(0.02)
    used = usage.ru_utime + usage.ru_stime
    if os.WIFSIGNALED(status):
        return Ending(True, "no end" if os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL) else "crash", used)
    code = os.WEXITSTATUS(status)
    return Ending(code != 0, {0: "survived", 1: "test"}.get(code, f"exit {code}"), used)


def _be_the_child(tests: Sequence[str], path: Path | None, module: str, number: int, seconds: float) -> None:
    code = 3
    try:
        os.setpgid(0, 0)
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        with tempfile.TemporaryFile() as out:
            os.dup2(out.fileno(), 1)
            os.dup2(out.fileno(), 2)
            if path is not None:
                _plant(path, module, number)
            code = _first_failure(tests)
    finally:
        os._exit(code)


def _first_failure(tests: Sequence[str]) -> int:
    """The exit code of the first file with a test that fails; 0 without one. Later files are not even loaded."""
    import pytest

    files = [test for test in tests if test.startswith("tests/")]
    options = [test for test in tests if not test.startswith("tests/")]
    for file in files:
        code = int(pytest.main([file, *options, "-x", "-q", "-p", "no:cacheprovider", "--no-header", "--tb=no"]))
        if code not in (0, pytest.ExitCode.NO_TESTS_COLLECTED):
            return code
    return 0


def _plant(path: Path, module: str, number: int) -> None:
    code = compile(planted(path, module, number), str(path), "exec")
    plain = importlib.machinery.SourceFileLoader.get_code

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        return code if Path(loader.path) == path else plain(loader, fullname)

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign]
