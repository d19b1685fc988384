"""`format`: files are replaced as a whole, or left."""

import io
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Cli

NEAT = "BEGIN STATE VECTOR\nstate S can be a, b\nEND STATE VECTOR\n"
MESSY = "BEGIN STATE VECTOR state S can be a,b\nEND STATE VECTOR"


def test_files_are_laid_out(cli: Cli, tmp_path: Path) -> None:
    """Each that needs it, and it is named; ends of lines and a byte-order mark stay."""
    (tmp_path / "neat.tum").write_text(NEAT)
    (tmp_path / "messy.tum").write_text(MESSY)
    (tmp_path / "windows.tum").write_bytes(b"\xef\xbb\xbf" + MESSY.replace("\n", "\r\n").encode())
    ran = cli("format", "neat.tum", "messy.tum", "windows.tum")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out == "messy.tum is laid out anew\nwindows.tum is laid out anew\n"
    assert (tmp_path / "messy.tum").read_text() == NEAT
    assert (tmp_path / "windows.tum").read_bytes() == b"\xef\xbb\xbf" + NEAT.replace("\n", "\r\n").encode()
    assert cli("format", "neat.tum", "messy.tum", "windows.tum", "--check").code == 0


@pytest.mark.parametrize(("option", "shown"), [("--check", "messy.tum has another layout"), ("--diff", "+state S")])
def test_a_check_writes_nothing(cli: Cli, tmp_path: Path, option: str, shown: str) -> None:
    """It names the files, or shows what would change, and exits with 1."""
    (tmp_path / "neat.tum").write_text(NEAT)
    (tmp_path / "messy.tum").write_text(MESSY)
    ran = cli("format", option, "neat.tum", "messy.tum")
    assert ran.code == 1
    assert shown in ran.out
    assert "neat.tum" not in ran.out
    assert (tmp_path / "messy.tum").read_text() == MESSY


def test_mistakes_leave_a_file_alone(cli: Cli, tmp_path: Path) -> None:
    """They are shown, the other files are laid out, and the exit code is 2."""
    (tmp_path / "wrong.tum").write_text(MESSY.replace("can be", "can"))
    (tmp_path / "messy.tum").write_text(MESSY)
    ran = cli("format", "wrong.tum", "nowhere.tum", "messy.tum")
    assert ran.code == 2
    assert "TUM105" in ran.err
    assert "TUM101" in ran.err
    assert (tmp_path / "wrong.tum").read_text() == MESSY.replace("can be", "can")
    assert (tmp_path / "messy.tum").read_text() == NEAT
    assert cli("format", "--check", "wrong.tum", "messy.tum").code == 2


def test_standard_input_to_standard_output(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """`-` is both."""
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(MESSY.encode())))
    ran = cli("format", "-")
    assert (ran.code, ran.out, ran.err) == (0, NEAT, "")
