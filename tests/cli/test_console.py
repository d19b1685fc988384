"""Progress on a terminal, silence elsewhere; Ctrl-C inside a solver."""

import io
import json
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.cli import console
from tumato_symbolic.limits import Context


class Terminal(io.StringIO):
    """A standard error stream that calls itself a terminal."""

    def isatty(self) -> bool:
        """Yes."""
        return True


def _line(context: Context) -> console.ProgressLine:
    """The progress line of work that began a while ago."""
    context.started -= 5
    context.tell("measuring distances")
    return console.ProgressLine(context)


def test_long_work_shows_progress_and_wipes_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a terminal, what is being done appears, with the seconds that it took, and is gone at the end."""
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    line = _line(Context())
    line.draw()
    assert terminal.getvalue() == "\r\x1b[2Kmeasuring distances … 5 s"
    line.wipe()
    assert terminal.getvalue().endswith("\r\x1b[2K")


def test_short_work_shows_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is done within a second leaves no trace."""
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)
    line = console.ProgressLine(Context())
    line.draw()
    line.wipe()
    assert terminal.getvalue() == ""


def test_a_pipe_shows_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stream that is no terminal gets no progress, however long it takes."""
    stream = io.StringIO()
    monkeypatch.setattr("sys.stderr", stream)
    _line(Context()).draw()
    assert stream.getvalue() == ""


@pytest.mark.parametrize("command", ["synth amr.tum", "synth amr.tum --no-verify", "verify amr.json amr.tum"])
def test_ctrl_c_inside_z3_is_no_verdict(
    cli: Cli, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, command: str
) -> None:
    """Z3 answers Ctrl-C with `unknown`: the exit code is 130, and no verdict or file comes of it."""
    import z3

    monkeypatch.setattr(z3.Solver, "check", lambda *_: z3.unknown)
    monkeypatch.setattr(z3.Solver, "reason_unknown", lambda _: "interrupted from keyboard")
    ran = cli(*command.split())
    assert (ran.code, ran.out, ran.err) == (130, "", "tumato-sym: interrupted\n")
    assert not (tmp_path / "policy.json").exists()


@pytest.mark.parametrize(
    ("command", "stage"),
    [
        (("synth", "amr.tum", "-o", "made.json"), "choosing restoring sets"),
        (("verify", "amr.json", "amr.tum"), "proving goals"),
    ],
)
def test_a_profile_stands_beside_the_report(cli: Cli, command: tuple[str, ...], stage: str) -> None:
    """`--profile` lists the stages on the standard error stream, and leaves a report for a program as it is."""
    ran = cli(*command, "--profile", "--output-format", "json")
    assert json.loads(ran.out)["verdict"] in ("realizable", "proved")
    assert "Time by stage:" in ran.err
    assert any(line.endswith(stage) for line in ran.err.splitlines())
    assert "Time by stage:" not in cli(*command).err
