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
needs_cxx = pytest.mark.skipif(CXX is None, reason="there is no C++ compiler (c++): nothing is compiled here")

_STRICT = ("-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic")


def compile_c(sources: Sequence[Path], folder: Path, options: Sequence[str] = (), *, plus_plus: bool = False) -> Path:
    """Compile and link as strictly as the manual promises; the program's path."""
    if plus_plus and CXX is None:
        pytest.skip("there is no C++ compiler (c++)")
    program = folder / "program"
    command = [str(CXX), "-std=c++11", "-Wall", "-Wextra", "-Werror"] if plus_plus else [str(CC), "-std=c99", *_STRICT]
    ran = subprocess.run(
        [*command, *options, "-o", program, *sources], cwd=folder, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    return program


def compile_cpp(sources: Sequence[Path], folder: Path, options: Sequence[str] = ()) -> Path:
    """Compile and link C++17 as strictly as the manual promises, and a little more; the program's path."""
    program = folder / "program"
    strict = ["-std=c++17", *_STRICT, "-Wshadow", "-Wold-style-cast", "-Wsign-conversion"]
    ran = subprocess.run(
        [str(CXX), *strict, *options, "-o", program, *sources], cwd=folder, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    return program
