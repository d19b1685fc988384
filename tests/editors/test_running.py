"""The files for editors in editors that run, where these are installed: colours, and a mistake that arrives."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from tests.repo.documents import ROOT

HERE = Path(__file__).parent
WRONG = """\
BEGIN STATE VECTOR
state S_Door can be open, closed
END STATE VECTOR
BEGIN STATE RULES
rule: S_Dor is open
END STATE RULES
"""


def said(command: Sequence[str], folder: Path) -> str:
    """What an editor prints that opens `WRONG`."""
    (folder / "wrong.tum").write_text(WRONG)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    told = {"PATH": path, "TUMATO_EDITORS": str(ROOT / "editors"), "TUMATO_FILE": str(folder / "wrong.tum")}
    ran = subprocess.run(
        command,
        cwd=folder,
        env=os.environ | told | {"HOME": str(folder)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    return ran.stdout


@cache
def has_eglot() -> bool:
    """Whether there is an Emacs with eglot."""
    command = ["emacs", "--batch", "--eval", "(require 'eglot)"]
    return (
        shutil.which("emacs") is not None and subprocess.run(command, capture_output=True, check=False).returncode == 0
    )


@pytest.mark.skipif(shutil.which("nvim") is None, reason="Neovim is not installed")
def test_neovim_shows_a_mistake(tmp_path: Path) -> None:
    """And that it is gone, when it is corrected."""
    command = ["nvim", "--headless", "-u", "NONE", "-c", f"luafile {HERE / 'neovim.lua'}"]
    lines = said(command, tmp_path).splitlines()
    assert lines == [
        "filetype tumato",
        "colour tumatoBlock",
        "error 5 TUM201 there is no state variable `S_Dor` did you mean `S_Door`?",
        "errors left 0",
    ]


@pytest.mark.skipif(not has_eglot(), reason="there is no Emacs with eglot")
def test_emacs_shows_a_mistake(tmp_path: Path) -> None:
    """By eglot."""
    lines = said(["emacs", "--batch", "-l", str(HERE / "emacs.el")], tmp_path).splitlines()
    assert lines[:2] == ["mode tumato-mode", "colour font-lock-keyword-face"]
    assert "error 5 " in lines[2]
    assert "there is no state variable `S_Dor`" in lines[2]
