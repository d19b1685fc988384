"""Ctrl-C: every command ends at once, whatever it is at, with exit code 130, and leaves nothing half done."""

import json
import os
import pty
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tests.cli.inputs import state, write_inputs
from tests.repo.documents import ROOT
from tests.shell import ENTRY, HEEDING
from tumato_symbolic.cli.command_line import parse
from tumato_symbolic.cli.commands import COMMANDS, load
from tumato_symbolic.limits.processes import can_fork

PIPE = subprocess.PIPE

BUSY = """
from importlib import import_module
from tumato_symbolic.cli.main import entry

def busy_in_cudd():
    import dd.cudd
    bdd, numbers = dd.cudd.BDD(), range(14)
    bdd.configure(reordering=False)
    bdd.declare(*(f"{name}{number}" for names in ("ac", "bd") for number in numbers for name in names))
    one, other = (
        bdd.add_expr(" & ".join(f"({a}{number} <-> {b}{number})" for number in numbers)) for a, b in ("ab", "cd")
    )
    os.write(1, b"busy\\n")
    one & other

def busy_in_z3():
    import z3
    solver, holes = z3.SolverFor("QF_FD"), range(14)
    pigeons = [[z3.Bool(f"{pigeon} in {hole}") for hole in holes] for pigeon in range(15)]
    solver.add(*map(z3.Or, pigeons), *(z3.AtMost(*each, 1) for each in zip(*pigeons)))
    os.write(1, b"busy\\n")
    solver.check()

def run(options, context):
    globals()[f"busy_in_{solver}"]()

_, solver, *sys.argv[1:] = sys.argv
import_module(f"tumato_symbolic.cli.commands.{sys.argv[1]}").run = run
entry()
"""
"""A command that is in a single call for minutes: CUDD keeps the lock of Python, Z3 has a handler of its own."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the shared inputs."""
    write_inputs(tmp_path)
    return tmp_path


@contextmanager
def _started(
    folder: Path, code: str, *arguments: str, stdin: int | None = None, stdout: int = PIPE, stderr: int = PIPE
) -> Iterator[subprocess.Popen[bytes]]:
    """A command in a session of its own, nothing of which is left."""
    command = [sys.executable, "-c", HEEDING + code, *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, cwd=folder, env=environment, start_new_session=True, stdin=stdin, stdout=stdout, stderr=stderr
    ) as process:
        try:
            yield process
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def _interrupted(process: subprocess.Popen[bytes], to_all: bool) -> tuple[int, float]:
    """The exit code after Ctrl-C, and within how many seconds it came."""
    time.sleep(0.2)  # what it has begun is under way
    started = time.monotonic()
    (os.killpg if to_all else os.kill)(process.pid, signal.SIGINT)
    return process.wait(timeout=20), time.monotonic() - started


@pytest.mark.skipif(not can_fork(), reason="where no child does the work, a solver is waited for")
@pytest.mark.parametrize("solver", ["cudd", "z3"])
def test_no_call_of_a_solver_is_waited_for(folder: Path, solver: str) -> None:
    """In a pipe and without limits, Ctrl-C ends a command that is in the middle of a call which takes minutes."""
    pytest.importorskip(f"dd.{solver}" if solver == "cudd" else solver)
    before = set(folder.iterdir())
    with _started(folder, BUSY, solver, "synth", "amr.tum") as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline() == b"busy\n"
        code, seconds = _interrupted(process, to_all=False)
        assert (code, process.stderr.read()) == (130, b"tumato-sym: interrupted\n")
    assert seconds < 5  # of an idle machine, 0.1
    assert set(folder.iterdir()) == before


@pytest.mark.skipif(not can_fork(), reason="where no child does the work, a solver is waited for")
def test_nor_is_one_on_a_terminal(folder: Path) -> None:
    """A terminal sends Ctrl-C to all processes; the word stands on it."""
    terminal, end = pty.openpty()
    with _started(folder, BUSY, "z3", "synth", "amr.tum", stdin=end, stdout=end, stderr=end) as process:
        os.close(end)
        assert os.read(terminal, 100) == b"busy\r\n"
        code, seconds = _interrupted(process, to_all=True)
        assert (code, os.read(terminal, 1000).splitlines()[-1]) == (130, b"tumato-sym: interrupted")
    os.close(terminal)
    assert seconds < 5


def test_commands_that_only_python_works_for_do_without_a_child(tmp_path: Path) -> None:
    """Every other command is one that a child does; these load no solver (`test_start_up`), and Python hears Ctrl-C."""
    alone = {name for name in COMMANDS if vars(load(name).Options).get("may_take_long") is False}
    assert alone == {"decide", "lsp"}
    large = tmp_path / "large.tum"
    large.write_text(f"// {'x' * 200_000}")
    for command in ("check", "format"):
        assert parse([command, "amr.tum"]).options.may_take_long is False
        assert parse([command, "amr.tum", str(large)]).options.may_take_long is True
    assert parse(["run", "amr.json", "amr.tum"]).options.may_take_long is False  # step by step
    assert parse(["run", "amr.json", "amr.tum", "--faults", "none"]).options.may_take_long is True


def test_ctrl_c_while_it_waits_for_a_line(folder: Path) -> None:
    """Ctrl-C: exit 130, a word instead of a traceback, and no half-written file."""
    before = set(folder.iterdir())
    with _started(folder, ENTRY, "decide", "amr.json", "--stdin", stdin=PIPE) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdin.write(json.dumps(state("corridor", "low", "free", "off")).encode() + b"\n")
        process.stdin.flush()
        process.stdout.readline()  # the program is up and waits for more
        assert _interrupted(process, to_all=False)[0] == 130
        assert process.stderr.read() == b"tumato-sym: interrupted\n"
    assert set(folder.iterdir()) == before


def test_ctrl_c_ends_a_server(folder: Path) -> None:
    """The language server ends as well, while it waits for its editor."""
    pytest.importorskip("pygls")
    asked = b'{"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}}}'
    with _started(folder, ENTRY, "lsp", stdin=PIPE) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(asked), asked))
        process.stdin.flush()
        assert process.stdout.readline().startswith(b"Content-Length")  # it is up
        assert _interrupted(process, to_all=False)[0] == 130
        assert process.stderr.read() == b"tumato-sym: interrupted\n"


TWICE = """
import tumato_symbolic.cli.main as program

def interrupted(*_):
    raise KeyboardInterrupt

program._run = program.note = interrupted
program.entry()
"""


def test_a_second_ctrl_c_is_no_bug(folder: Path) -> None:
    """Ctrl-C while the first one is reported is 130 as well."""
    with _started(folder, TWICE) as process:
        assert process.communicate(timeout=20)[1] == b""
        assert process.returncode == 130
