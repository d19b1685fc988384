"""What is read where a file is named: pipes that somebody writes to, and no waiting for ever."""

import os
import threading
import time
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.syntax import reading

needs_pipes = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")


@needs_pipes
@pytest.mark.parametrize(
    "command",
    [
        "check pipe",
        "synth pipe",
        "explain pipe",
        "format pipe",
        "verify pipe amr.tum",
        "verify amr.json pipe",
        "show pipe",
        "diff pipe amr.json",
        "diff amr.tum pipe",
        "decide pipe S_Load=free",
        "why pipe amr.tum S_Load=free",
        "run amr.json pipe",
        "export coq pipe amr.tum",
        "report amr.json pipe",
    ],
)
def test_a_pipe_without_a_writer_is_2(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str) -> None:
    """A pipe to which nobody writes is a mistake, and not waited for."""
    monkeypatch.setattr(reading, "PATIENCE_WITH_PIPES", 0.05)
    os.mkfifo(tmp_path / "pipe")
    ran = cli(*command.split())
    assert ran.code == 2
    assert "it is a pipe, and nobody writes to it" in ran.out + ran.err


@needs_pipes
@pytest.mark.parametrize(("opening", "writing"), [(0.1, 0.0), (0.0, 0.2)], ids=["comes-late", "writes-late"])
def test_a_pipe_with_a_writer_is_read(cli: Cli, tmp_path: Path, opening: float, writing: float) -> None:
    """Whoever opens it within a second may take as long as he likes; all of it is read, more than a pipe holds."""
    os.mkfifo(tmp_path / "pipe")
    text = (tmp_path / "amr.tum").read_text() + "// more\n" * 20_000

    def write() -> None:
        time.sleep(opening)
        with (tmp_path / "pipe").open("w") as pipe:
            time.sleep(writing)
            pipe.write(text)

    writer = threading.Thread(target=write)
    writer.start()
    ran = cli("check", "pipe")
    writer.join()
    assert (ran.code, ran.out) == (0, "pipe: no findings (4 state variables, 32 states, 8 actions, 1 rule)\n")


@needs_pipes
def test_what_is_no_file_is_not_laid_out_anew(cli: Cli, tmp_path: Path) -> None:
    """Nothing can be written back to where the text came from; it may be checked all the same."""
    for option, code, said in (("--check", 1, "another layout"), (None, 2, "error[TUM510]")):
        reader, writer = os.pipe()
        os.write(writer, (tmp_path / "amr.tum").read_bytes().replace(b"BEGIN", b"  BEGIN"))
        os.close(writer)
        ran = cli("format", f"/dev/fd/{reader}", *([option] if option else []))
        os.close(reader)
        assert (ran.code, said in ran.out + ran.err) == (code, True)
