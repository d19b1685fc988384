"""Coq, where it is installed: the library of `proofs/coq`, exported files, and many checks in one file."""

from __future__ import annotations

import fcntl
import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from msgspec import Struct

from tumato_symbolic.export.coq import export
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Ordering, Spec

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "proofs" / "coq"
KEPT = ROOT / ".pytest_cache"

COQC = shutil.which("coqc")

needs_coq = pytest.mark.skipif(COQC is None, reason="coqc is not installed: the theorem is not compiled here")


class Case(Struct, frozen=True):
    """A policy to be judged."""

    spec: Spec
    rows: Mapping[State, ActionSet]
    ordering: Ordering

    @property
    def text(self) -> str:
        """The exported file."""
        return export(policy_from_rows(self.spec, self.rows), self.spec, self.ordering)


class Library(Struct, frozen=True):
    """The sources in a folder of their own, so that nothing is left in the repository."""

    folder: Path

    @classmethod
    def copy_to(cls, folder: Path) -> Library:
        """A copy, not yet compiled."""
        for source in _sources():
            shutil.copy(source, folder)
        return cls(folder)

    @classmethod
    @cache
    def shared(cls, target: str = "all") -> Library:
        """One for all processes and runs, compiled as far as `target` needs; another one when a source changes."""
        version = _run([str(COQC), "--print-version"], SOURCES).stdout
        digest = sha256(b"\0".join([version.encode(), *(path.read_bytes() for path in _sources())])).hexdigest()
        folder = KEPT / f"coq-{target}-{digest[:16]}"
        KEPT.mkdir(exist_ok=True)
        with (KEPT / "coq.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not folder.exists():
                unfinished = folder.with_suffix(".unfinished")
                shutil.rmtree(unfinished, ignore_errors=True)
                unfinished.mkdir()
                library = cls.copy_to(unfinished)
                for compiled in KEPT.glob(f"coq-*-{digest[:16]}"):  # for another target
                    shutil.copytree(compiled, unfinished, dirs_exist_ok=True)
                built = library.build(target)
                assert built.returncode == 0, built.stderr
                unfinished.rename(folder)
        return cls(folder)

    def build(self, target: str = "all") -> subprocess.CompletedProcess[str]:
        """What `make -C proofs/coq` does."""
        return _run(["make", "-C", str(self.folder), target], self.folder)

    def compile(self, text: str) -> subprocess.CompletedProcess[str]:
        """Compile one file against the library."""
        with TemporaryDirectory() as folder:
            Path(folder, "judged.v").write_text(text, encoding="utf-8")
            return _run([str(COQC), "-q", "-R", str(self.folder), "Tumato", "judged.v"], Path(folder))

    def checks(self, cases: Sequence[Case]) -> list[bool]:
        """What `check` answers for each case, computed in one file."""
        return self.answers([case.text for case in cases])

    def answers(self, texts: Sequence[str]) -> list[bool]:
        """The same for exported files."""
        if not texts:
            return []
        answer = self.compile(together(texts))
        assert answer.returncode == 0, answer.stderr
        return [word == "true" for word in re.findall(r"= (true|false)\b", answer.stdout)]


def together(texts: Sequence[str]) -> str:
    """One file that computes the check of each exported file instead of proving that it is `true`."""
    head = texts[0].partition("(* Numbers")[0]
    modules = []
    for number, text in enumerate(texts):
        check = re.findall(r"^Lemma accepted : (check\w* spec \w+ decisions \w+) = true", text, re.MULTILINE)[0]
        start, end = text.index("Definition spec"), text.index("(* Coq computes")
        modules.append(f"Module C{number}.\n{text[start:end]}Eval vm_compute in {check}.\n")
        modules.append(f"End C{number}.\n")
    return head + "".join(modules)


def _sources() -> list[Path]:
    return [*sorted(SOURCES.glob("*.v")), SOURCES / "Makefile"]


def _run(command: Sequence[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
