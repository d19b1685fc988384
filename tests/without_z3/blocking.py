"""Python processes in which some packages cannot be imported."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Collection, Sequence
from importlib.abc import MetaPathFinder
from pathlib import Path
from typing import Any

from tests.repo.documents import ROOT


class Blocking(MetaPathFinder):
    """Refuses to find packages."""

    def __init__(self, packages: Collection[str]) -> None:
        self._packages = packages

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> None:
        """As where there is no such package."""
        if fullname.partition(".")[0] in self._packages:
            raise ModuleNotFoundError(f"No module named {fullname!r}", name=fullname)


def block(*packages: str) -> None:
    """From now on."""
    assert not sys.modules.keys() & set(packages)
    sys.meta_path.insert(0, Blocking(packages))


def run_module(module: str, *arguments: str, blocked: tuple[str, ...] = (), cwd: Path = ROOT) -> Any:
    """What `main` of a module returns in a process of its own, without some packages."""
    code = (
        "import json, sys\n"
        "from importlib import import_module\n"
        "from tests.without_z3.blocking import block\n"
        f"block(*{blocked!r})\n"
        f"answer = import_module({module!r}).main(*sys.argv[1:])\n"
        f"assert not sys.modules.keys() & set({blocked!r})\n"
        "print(json.dumps(answer))\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        cwd=cwd,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def outputs(commands: Sequence[Sequence[str]]) -> list[tuple[int, str, str]]:
    """Exit code, standard output and standard error stream of commands, in this process."""
    import io
    from contextlib import redirect_stderr, redirect_stdout

    from tumato_symbolic.cli.main import main

    found = []
    for command in commands:
        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = main(command)
        found.append((code, out.getvalue(), err.getvalue()))
    return found
