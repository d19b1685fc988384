"""The tests where Z3 cannot be imported: `python -m tests.without_z3 tests/cli tests/spec`, with arguments of pytest.

Nothing that is tested can import it, here or in the processes that tests start; the oracles of the tests keep theirs.
A test that fails after Z3 was asked for is about Z3, and counts as skipped, with what was said. It still fails where
the program did not get over it: by an exception that a user would see, or by the exit code of a bug.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Generator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from tests.repo.documents import ROOT

_ABSENT = """\
with open({asked!r}, "a") as file:
    file.write(".")
raise ModuleNotFoundError("No module named 'z3'", name="z3")
"""
_SAID = re.compile(r"Z3 is needed to [^,;']+")
_BROKEN = re.compile(r"this is a bug in tumato-sym|code=70|MissingPackageError:")


class Judge:
    """A plugin that tells tests that are about Z3 from those that should pass without."""

    def __init__(self, asked: Path) -> None:
        self._asked, self._module, self._before = asked, "", 0

    @pytest.hookimpl(wrapper=True)
    def pytest_make_collect_report(
        self, collector: pytest.Collector
    ) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
        """A module may be about Z3 as a whole."""
        self._enter(collector.nodeid)
        report = yield
        if report.failed and self._was_asked() and not _BROKEN.search(report.longreprtext):
            report.longrepr = (str(collector.path), 0, _reason(report.longreprtext))
            report.outcome = "skipped"
        return report

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """What a module asks counts from its first test on."""
        self._enter(nodeid.partition("::")[0])

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Or one of its tests. What one test has computed another may look at."""
        report = yield
        if report.failed and self._was_asked() and call.excinfo is not None and _got_over(call.excinfo, report):
            report.longrepr = (str(item.path), item.location[1] or 0, _reason(report.longreprtext))
            report.outcome = "skipped"
        return report

    def _enter(self, module: str) -> None:
        if module != self._module:
            self._module, self._before = module, self._count()

    def _was_asked(self) -> bool:
        return self._count() > self._before

    def _count(self) -> int:
        return self._asked.stat().st_size


def _reason(text: str) -> str:
    said = _SAID.search(" ".join(text.replace("\nE  ", " ").split()))
    return f"Skipped: {said[0] if said else 'it is about Z3'}"


def _got_over(raised: pytest.ExceptionInfo[BaseException], report: pytest.TestReport) -> bool:
    """Whether a test missed something, or imports what needs Z3 itself, and nothing broke."""
    if raised.errisinstance(ImportError):
        ours = [each for each in raised.traceback if str(each.path).startswith(str(ROOT / "tests"))]
        return bool(ours) and re.match(r"\s*(from|import)\b", str(ours[-1].statement)) is not None
    return not _BROKEN.search(report.longreprtext)


def main(arguments: Sequence[str]) -> int:
    """Run pytest."""
    import tests.oracle
    import tests.restoration.oracle  # noqa: F401

    for name in [name for name in sys.modules if name.partition(".")[0] == "z3"]:
        del sys.modules[name]
    with TemporaryDirectory() as folder:
        absent, asked = Path(folder, "z3"), Path(folder, "asked")
        absent.mkdir()
        asked.touch()
        (absent / "__init__.py").write_text(_ABSENT.format(asked=str(asked)))
        sys.path.insert(0, folder)
        os.environ["PYTHONPATH"] = os.pathsep.join((folder, os.environ.get("PYTHONPATH", "")))
        return pytest.main(["-p", "no:xdist", *arguments], plugins=[Judge(asked)])


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
