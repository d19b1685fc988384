"""The C compiler, where there is one."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest

CC = shutil.which("cc")
CXX = shutil.which("c++")

needs_cc = pytest.mark.skipif(CC is None, reason="there is no C compiler (cc): nothing is compiled here")

_STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic")


def compile_c(sources: Sequence[Path], folder: Path, options: Sequence[str] = (), *, plus_plus: bool = False) -> Path:
    """Compile and link as strictly as the manual promises; the program's path."""
    if plus_plus and CXX is None:
        pytest.skip("there is no C++ compiler (c++)")
    program = folder / "program"
    command = [str(CXX), "-std=c++11", "-Wall", "-Wextra", "-Werror"] if plus_plus else [str(CC), *_STRICT]
    ran = subprocess.run(
        [*command, *options, "-o", program, *sources], cwd=folder, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    return program
