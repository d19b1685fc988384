"""The stand-alone checker, imported by its path as a user would run it, and what it says of given texts."""

from __future__ import annotations

import importlib.util
import io
import re
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from types import ModuleType

from msgspec import Struct

CHECKER = Path(__file__).parents[2] / "proofs" / "checker.py"


def load_checker() -> ModuleType:
    """The module that the file is."""
    spec = importlib.util.spec_from_file_location("standalone_checker", CHECKER)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


checker = load_checker()


class Answer(Struct, frozen=True):
    """What the checker answers: the exit code, and what it prints."""

    code: int
    out: str
    err: str

    @property
    def failing(self) -> dict[str, int]:
        """In how many states each property fails that does."""
        found = re.findall(r"^(\w+) +FAILS in (\d+) states?: ", self.out, re.MULTILINE)
        return {name: int(count) for name, count in found}

    @property
    def states(self) -> tuple[int, int]:
        """The numbers of valid and of safe states."""
        valid, safe = re.findall(r"^(\d+) valid states: (\d+) safe", self.out)[0]
        return int(valid), int(safe)


def ask(folder: Path, policy: str, spec: str, *options: str) -> Answer:
    """Run the checker on two texts."""
    (folder / "policy.json").write_bytes(policy.encode())
    (folder / "spec.tum").write_bytes(spec.encode())
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = checker.main([str(folder / "policy.json"), str(folder / "spec.tum"), *options])
    return Answer(code, out.getvalue(), err.getvalue())


def sizes(text: str) -> tuple[int, int] | None:
    """The numbers of valid and of safe states of a specification; None where the checker refuses it."""
    try:
        world = checker.World(checker.read_specification(text.encode()), "any")
        return len(world.valid), len(world.safe)
    except checker.Unreadable:
        return None
