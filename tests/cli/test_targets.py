"""Where commands write: never over what they read, whole or not at all, and wherever a name leads."""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.cli.commands import COMMANDS, load

SAME: dict[str, Callable[[Path], str]] = {
    "the same name": lambda file: file.name,
    "a longer name": lambda file: f"./{file.name}",
    "a name through its folder": lambda file: f"../{file.parent.name}/{file.name}",
    "an absolute name": str,
    "a symbolic link": lambda file: _linked(file, Path.symlink_to),
    "a hard link": lambda file: _linked(file, Path.hardlink_to),
}
"""Other names for a file."""


def _linked(file: Path, link: Callable[[Path, Path], None]) -> str:
    link(file.with_name("link"), file)
    return "link"


@pytest.mark.parametrize("name", SAME)
@pytest.mark.parametrize(
    ("command", "input_"),
    [
        ("synth amr.tum -o OUTPUT", "amr.tum"),
        ("export coq amr.json amr.tum -o OUTPUT", "amr.tum"),
        ("export coq amr.json amr.tum -o OUTPUT", "amr.json"),
        ("explain no_plan.tum --write OUTPUT", "no_plan.tum"),
        ("run amr.json amr.tum --faults none --itf OUTPUT", "amr.json"),
    ],
)
def test_an_input_is_never_the_output(cli: Cli, tmp_path: Path, name: str, command: str, input_: str) -> None:
    """Whatever its name: exit 2, the reason, the input as it was, and no report, for nothing was worked out."""
    before = (tmp_path / input_).read_bytes()
    ran = cli(*command.replace("OUTPUT", SAME[name](tmp_path / input_)).split())
    assert (ran.code, ran.out) == (2, "")
    assert "TUM118" in ran.err
    assert "input" in ran.err
    assert (tmp_path / input_).read_bytes() == before


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--html policy.json", "the policy and the page are not both written to `policy.json`"),
        ("-o new.json --html ../NAME/new.json", "the policy and the page are not both written to `new.json`"),
        ("-o new.json --html ./new.unrealizable.json", "there is no policy are not both written to"),
        ("-o amr.json --html link", "the policy and the page are not both written to `amr.json`"),
        ("-o - --html -", "the policy and the page do not both go to the standard output"),
        ("-o - --html /dev/stdout", "the policy and the page do not both go to the standard output"),
    ],
)
def test_no_output_is_another(cli: Cli, tmp_path: Path, options: str, said: str) -> None:
    """A page does not take the place of the policy, whatever its name: nothing is written, with a way out."""
    (tmp_path / "link").symlink_to("amr.json")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    ran = cli("synth", "amr.tum", *options.replace("NAME", tmp_path.name).split())
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err
    assert "help: name another file with --html FILE" in ran.err
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_one_device_may_take_all(cli: Cli) -> None:
    """Nothing is lost where nothing is kept."""
    assert cli("synth", "amr.tum", "-o", "/dev/null", "--html", "/dev/null").code == 0


@pytest.mark.parametrize("output", ["no_plan.json", "no_plan"])
def test_a_certificate_is_not_written_over_the_input(cli: Cli, tmp_path: Path, output: str) -> None:
    """The name that `synth` gives to a certificate counts as well."""
    spec = (tmp_path / "no_plan.tum").rename(tmp_path / "no_plan.unrealizable.json")
    before = spec.read_bytes()
    ran = cli("synth", spec.name, "-o", output)
    assert ran.code == 2
    assert "TUM118" in ran.err
    assert spec.read_bytes() == before


def test_every_option_that_names_an_output_is_covered(cli: Cli) -> None:
    """An option whose help mentions writing a file says with `writes=` what is written there."""
    for name in COMMANDS:
        said = " ".join(cli(name, "--help").out.split())
        names_a_file = any(each in said for each in ("--write", "--output FILE", "--itf FILE"))
        assert bool(load(name).Options.outputs()) == names_a_file, name


def test_a_file_keeps_its_mode(cli: Cli, tmp_path: Path) -> None:
    """What is overwritten keeps its mode; a link stays a link, also one that leads to no file yet."""
    for output, command in (
        ("old.json", "synth amr.tum -o link"),
        ("old.unrealizable.json", "synth no_plan.tum -o old.json"),
        ("old.v", "export coq amr.json amr.tum -o link"),
        ("old.tum", "explain no_plan.tum --write link"),
    ):
        target, link = tmp_path / output, tmp_path / "link"
        target.write_text("old")
        target.chmod(0o640)
        link.symlink_to(target.name)
        cli(*command.split())
        assert stat.S_IMODE(target.stat().st_mode) == 0o640, command
        assert target.read_text() != "old", command
        assert link.readlink() == Path(target.name)
        link.unlink()
    link.symlink_to("new.v")
    cli("export", "coq", "amr.json", "amr.tum", "-o", "link")
    assert (tmp_path / "new.v").exists()
    assert link.is_symlink()


@pytest.mark.parametrize("failing", ["fsync", "replace"])
def test_nothing_is_left_of_a_failure(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: str) -> None:
    """Ctrl-C and a full disk in the middle of writing: the old file as it was, and nothing beside it."""
    for error, code in ((KeyboardInterrupt(), 130), (OSError(28, "No space left on device"), 2)):

        def fail(*_: object, error: BaseException = error) -> None:
            raise error

        with monkeypatch.context() as patched:
            patched.setattr(os if failing == "fsync" else Path, failing, fail)
            for command in (
                "synth amr.tum -o amr.json",
                "export coq amr.json amr.tum -o warned.tum",
                "explain no_plan.tum --write warned.tum",
            ):
                before = {path: path.read_bytes() for path in tmp_path.iterdir()}
                assert cli(*command.split()).code == code, command
                assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    ("command", "text"),
    [
        ("synth amr.tum -o", '"Type": "policy"'),
        ("export coq amr.json amr.tum -o", "Print Assumptions"),
        ("explain no_plan.tum --write", "BEGIN ASSUMPTIONS"),
    ],
)
def test_pipes_take_an_output(cli: Cli, tmp_path: Path, command: str, text: str) -> None:
    """A named pipe, an open pipe such as `>(cat)`, and `/dev/null` take what is written to a file otherwise."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    found: list[str] = []
    reader = threading.Thread(target=lambda: found.append(pipe.read_text()), daemon=True)
    reader.start()
    cli(*command.split(), "pipe")
    reader.join(10)
    out, in_ = os.pipe()
    with os.fdopen(out) as end:
        reader = threading.Thread(target=lambda: found.append(end.read()), daemon=True)
        reader.start()
        cli(*command.split(), f"/dev/fd/{in_}")
        os.close(in_)
        reader.join(10)
    assert len(found) == 2
    assert all(text in each for each in found)
    assert pipe.is_fifo()
    assert cli(*command.split(), "/dev/null").code in (0, 1)


@pytest.mark.parametrize("name", ["-", "/dev/stdout", "/dev/fd/1"])
@pytest.mark.parametrize("command", ["synth amr.tum -o", "explain no_plan.tum --write"])
def test_names_of_the_standard_output(cli: Cli, command: str, name: str) -> None:
    """With the output on the standard output, by whatever name, the report goes to the standard error stream."""
    ran = cli(*command.split(), name)
    assert "realizable" in ran.err
    assert ran.out.startswith(("{", "BEGIN"))
    assert " is written" not in ran.err


@pytest.mark.parametrize("output", ["x" * 300, "x" * 300 + "/policy.json", "x" * 244 + ".json", "loop", "/dev/fd/999"])
def test_names_that_cannot_be(cli: Cli, tmp_path: Path, output: str) -> None:
    """Too long, also for a certificate beside it; a link to itself; a file that is not open: exit 2 before the work."""
    (tmp_path / "loop").symlink_to("loop")
    ran = cli("synth", "no_plan.tum", "-o", output)
    assert (ran.code, ran.out) == (2, "")
    assert "TUM510" in ran.err
    ran = cli("explain", "no_plan.tum", "--write", "x" * 300)
    assert (ran.code, ran.out) == (2, "")
    assert cli("verify", "x" * 300).code == 2
    (tmp_path / "two_robots.tum").unlink()
    assert cli("verify", ".", "--specs", "x" * 300).code == 2


def test_a_protected_file_is_left_alone(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that may not be written to is not replaced either."""
    allowed = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path).name != "amr.json" and allowed(path, mode))
    ran = cli("synth", "amr.tum", "-o", "amr.json")
    assert (ran.code, ran.out) == (2, "")
    assert "amr.json may not be written to" in ran.err


def test_the_standard_input_is_read_once(cli: Cli) -> None:
    """Two inputs from one stream are wrong usage."""
    for command in ("verify - -", "why - - a=b", "export coq - -", "check - -", "decide - --stdin"):
        ran = cli(*command.split())
        assert ran.code == 2
        assert "only one input can be the standard input" in ran.err
