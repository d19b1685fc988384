"""Lines for a shell, in which a `tumato-sym` that begins the line is done by this process.

Everything is loaded here already, so that a command takes what its work takes, and not what an interpreter and solvers
take to start, which is most. What a process is beside that is tested in `tests/cli/test_processes.py`.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections.abc import Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

from tumato_symbolic.cli.main import main

ENTRY = "from tumato_symbolic.__main__ import entry; entry()"
PROGRAM = (sys.executable, "-c", ENTRY)
"""`tumato-sym` as a process, wherever it is installed."""

HEEDING = "import os, signal, sys\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
"""Code before `ENTRY`, for tests of Ctrl-C.

Shells start background jobs, such as a whole test run, with Ctrl-C ignored, and children inherit that.
"""

_OURS = re.compile(r"(tumato-sym (?:[^|&;<>$`*?{}()#~\\]|\\\n)*?)((?:\s\d?[|&;<>].*)?)", re.DOTALL)
"""A command in which the shell has nothing to do but find its words, and what the shell does with it."""


def run(
    line: str, folder: Path, *, together: bool = False, environment: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """What a line prints in a folder, and its exit code; with `together`, both streams are one."""
    changed = {"COLUMNS": "80", **(environment or {})}
    found = _OURS.fullmatch(line)
    if found is None:
        return _by_shell(line, folder, changed, together)
    words, rest = shlex.split(found[1].replace("\\\n", " "))[1:], found[2]
    ran = _here(words, folder, changed, together and not rest)
    return _by_shell(rest, folder, changed, together, ran) if rest else ran


def _here(
    words: list[str], folder: Path, changed: Mapping[str, str], together: bool
) -> subprocess.CompletedProcess[str]:
    (_, nothing), (said, out), (told, err) = (_stream() for _ in range(3))
    with (
        chdir(folder),
        patch.dict(os.environ, changed),
        patch.object(sys, "stdin", nothing),
        redirect_stdout(out),
        redirect_stderr(out if together else err),
    ):
        code = main(words)
    return subprocess.CompletedProcess(words, code, said.getvalue().decode(), told.getvalue().decode())


def _stream() -> tuple[BytesIO, TextIOWrapper]:
    """An empty stream of text, and the bytes that are in it."""
    kept = BytesIO()
    return kept, TextIOWrapper(kept, encoding="utf-8", write_through=True)


def _by_shell(
    line: str,
    folder: Path,
    changed: Mapping[str, str],
    together: bool,
    begun: subprocess.CompletedProcess[str] | None = None,
) -> subprocess.CompletedProcess[str]:
    """What a shell makes of a line, or of the rest of one whose first command has been done."""
    with TemporaryDirectory() as kept:
        if begun is not None:
            out, err = Path(kept, "out"), Path(kept, "err")
            out.write_text(begun.stdout, encoding="utf-8")
            err.write_text(begun.stderr, encoding="utf-8")
            line = f"begun() {{ cat {out}; cat {err} >&2; return {begun.returncode}; }}; begun {line}"
        return subprocess.run(
            ["sh", "-c", line],
            cwd=folder,
            env={
                **os.environ,
                **changed,
                "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            },
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if together else subprocess.PIPE,
            text=True,
            timeout=120,
            check=False,
        )
