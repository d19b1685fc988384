"""`--jobs`: how many processes work, and what a user sees of them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Cli, Ran
from tests.repo.documents import ROOT
from tumato_symbolic.cli import folder as folder_command
from tumato_symbolic.cli import verifying
from tumato_symbolic.verify import portfolio, verify, workers
from tumato_symbolic.verify.by_diagrams import prover
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks

TEST_PROCESS = os.getpid()


@pytest.fixture
def forked(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Have children work on the smallest proof and folder; their numbers."""
    made: list[int] = []
    fork = os.fork

    def counted() -> int:
        child = fork()
        made.extend([child] if child else [])
        return child

    monkeypatch.setattr(prover, "FEWEST_NODES", 0)
    monkeypatch.setattr(portfolio, "MANY_RANK_NODES", -1)
    monkeypatch.setattr(portfolio, "LARGEST_TABLE", -1)
    monkeypatch.setattr(folder_command, "FEWEST_BYTES", 0)
    monkeypatch.setattr(os, "fork", counted)
    return made


@pytest.fixture
def folder(tmp_path: Path) -> str:
    """Two policies (one specification has a warning), a certificate of unrealizability, and a file that is neither."""
    for name in ("amr.policy.json", "coin.policy.json", "two_robots.unrealizable.json"):
        (tmp_path / name).write_text((ROOT / "proofs" / name).read_text())
        spec = name.split(".")[0] + ".tum"
        (tmp_path / spec).write_text((ROOT / "examples" / spec).read_text())
    (tmp_path / "zero.policy.json").write_text("0")
    (tmp_path / "zero.tum").write_text((ROOT / "examples" / "coin.tum").read_text())
    coin = tmp_path / "coin.tum"
    coin.write_text(coin.read_text().replace("resource HAND", "resource HAND\nresource UNUSED", 1))
    return str(tmp_path)


def _without_seconds(found: Any) -> Any:
    if isinstance(found, dict):
        return {key: _without_seconds(value) for key, value in found.items() if key not in ("seconds", "solve_seconds")}
    return [_without_seconds(each) for each in found] if isinstance(found, list) else found


@pytest.mark.parametrize("jobs", ["0", "-1", "two", "1.5"])
def test_jobs_is_a_positive_number(cli: Cli, jobs: str) -> None:
    """Anything else is a mistake on the command line."""
    ran = cli("verify", "amr.json", "amr.tum", "--jobs", jobs)
    assert ran.code == 2
    assert f"{jobs} is not a positive number of processes" in ran.err


@pytest.mark.parametrize("command", ["verify amr.json amr.tum", "synth amr.tum"])
def test_the_default_is_every_processor(cli: Cli, monkeypatch: pytest.MonkeyPatch, command: str) -> None:
    """Without `--jobs`, as many processes may work as there are processors; with it, as many as it says."""
    given: list[int] = []
    original = verify

    def recorded(*arguments: Any, jobs: int, **named: Any) -> Any:
        given.append(jobs)
        return original(*arguments, jobs=jobs, **named)

    monkeypatch.setattr(verifying, "verify", recorded)
    monkeypatch.setattr(import_module("tumato_symbolic.verify"), "verify", recorded, raising=False)
    monkeypatch.setattr(workers, "cores", lambda: 5)
    monkeypatch.setattr(verifying, "cores", lambda: 5)
    assert cli(*command.split()).code == 0
    assert cli(*command.split(), "--jobs", "3").code == 0
    assert given == [5, 3]


@pytest.mark.parametrize("command", ["verify amr.json amr.tum", "verify lacking.json amr.tum", "synth amr.tum"])
def test_the_report_does_not_depend_on_the_jobs(cli: Cli, tmp_path: Path, forked: list[int], command: str) -> None:
    """The JSON is the same for one process and for two, seconds aside."""
    lacking = json.loads((tmp_path / "amr.json").read_text())
    lacking["Certificate"]["Goals"].pop()
    (tmp_path / "lacking.json").write_text(json.dumps(lacking))
    one, two = (cli(*command.split(), "--output-format", "json", "--jobs", jobs) for jobs in "12")
    assert one.code == two.code
    assert _without_seconds(json.loads(one.out)) == _without_seconds(json.loads(two.out))
    assert forked


def test_a_folder_does_not_depend_on_the_jobs(cli: Cli, forked: list[int], folder: str) -> None:
    """Reports, errors and warnings of a folder are the same, in the order of the files; every part has its process."""
    runs: list[Ran] = []
    for jobs in "123":
        runs.append(cli("verify", folder, "--output-format", "json", "--jobs", jobs))
        forked.clear() if jobs == "1" else None
    assert {ran.code for ran in runs} == {2}
    assert len({json.dumps(_without_seconds(json.loads(ran.out))) for ran in runs}) == 1
    assert len(forked) == 5
    texts = [cli("verify", folder, "--jobs", jobs) for jobs in "12"]
    assert texts[0].err == texts[1].err != ""
    assert texts[0].out.split("In ")[0] == texts[1].out.split("In ")[0]


def test_a_folder_of_small_files_forks_nothing(cli: Cli, folder: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A few small files are verified sooner than a process is made."""
    monkeypatch.setattr(os, "fork", lambda: pytest.fail("a process was forked"))
    assert cli("verify", folder, "--jobs", "4").code == 2


def test_a_folder_is_undecided_when_a_child_is_killed(
    cli: Cli, forked: list[int], folder: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A child that dies is no proof of its files: exit 3, and a word about it."""
    monkeypatch.setattr(folder_command, "_part", lambda *_: os.kill(os.getpid(), signal.SIGKILL))
    ran = cli("verify", folder, "--jobs", "2")
    assert (ran.code, ran.out) == (3, "")
    assert ran.err == "tumato-sym: undecided: a worker process was ended by signal 9\n"


def test_an_exception_in_a_child_is_a_bug(cli: Cli, forked: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Exit 70 with the traceback of the child."""

    def planted(*_: object) -> bool:
        if os.getpid() == TEST_PROCESS:
            return True
        raise ValueError("planted")

    monkeypatch.setattr(WalkRanks, "decreases", planted)
    ran = cli("verify", "amr.json", "amr.tum", "--jobs", "2")
    assert (ran.code, ran.out) == (70, "")
    assert "in planted\n" in ran.err
    assert "ValueError: planted" in ran.err
    assert "this is a bug in tumato-sym" in ran.err


ENDLESS = """
import os, signal, sys
from tumato_symbolic.cli.main import entry
from tumato_symbolic.verify import portfolio
from tumato_symbolic.verify.by_diagrams import prover, ranks

prover.FEWEST_NODES, portfolio.MANY_RANK_NODES = 0, -1
signal.signal(signal.SIGINT, signal.default_int_handler)

def endless(found, goal):
    os.write(1, f"{os.getpid()}\\n".encode())
    while True:
        found._model.walk.check_time()

ranks.WalkRanks.decreases = endless
entry()
"""


def _started(tmp_path: Path) -> tuple[subprocess.Popen[str], list[int]]:
    """A command whose two children never end, and these children."""
    files = (str(ROOT / "proofs" / "amr.policy.json"), str(ROOT / "examples" / "amr.tum"))
    command = [sys.executable, "-c", ENDLESS, "verify", *files, "--jobs", "2", "--prover", "walk"]
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert process.stdout is not None
    return process, [int(process.stdout.readline()) for _ in range(2)]


def _ended(pids: list[int]) -> bool:
    """Whether these processes are gone, or will be soon."""
    deadline = time.monotonic() + 10
    while time.monotonic() < deadline:
        if not any(Path(f"/proc/{pid}").exists() and "Z" not in _state(pid) for pid in pids):
            return True
        time.sleep(0.02)
    return False


def _state(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return "Z"


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for processes in /proc")
@pytest.mark.parametrize("to_all", [True, False], ids=["terminal", "command-alone"])
def test_ctrl_c_ends_all_processes(tmp_path: Path, to_all: bool) -> None:
    """Ctrl-C, sent to all as a terminal does or to the command alone: exit 130, one word, and no child is left."""
    process, pids = _started(tmp_path)
    with process:
        (os.killpg if to_all else os.kill)(process.pid, signal.SIGINT)
        out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (130, "", "tumato-sym: interrupted\n")
    assert _ended(pids)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for processes in /proc")
def test_workers_end_with_their_parent(tmp_path: Path) -> None:
    """A command that is killed outright leaves no child that works on."""
    process, pids = _started(tmp_path)
    with process:
        process.kill()
        assert _ended(pids)
