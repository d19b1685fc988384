"""Which specification a policy or a certificate of a folder belongs to."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.spec import load
from tumato_symbolic.spec.canonical import digest
from tumato_symbolic.syntax import read_source

SUFFIXES = (".tum", ".tmt")
"""How the names of specifications end."""

EXAMPLES = Path("..", "examples")
"""Where a specification is looked for last, seen from the folder of its policy."""


class Specifications:
    """The specifications of the folders where those of a folder of policies are looked for: those given come first."""

    def __init__(self, policies: str, spec_folders: Iterable[str]) -> None:
        folder = Path(policies)
        self._spec_folders = [*map(Path, spec_folders)]
        self._beside = [folder, Path(os.path.normpath(folder / EXAMPLES))]
        self._digests: dict[Path, str | None] = {}

    def of(self, path: Path, recorded: str | None) -> Path:
        """The specification of the same name as a file; where there is none, the one with the digest that it records.

        The name comes first, so that a policy goes stale with its specification even where a copy of the old one is
        kept. Raises `UserError` (TUM501) where there is none.
        """
        found = self.named(path)
        if found is None and recorded is not None:
            found = next((each for each in self._all() if self._digest(each) == recorded), None)
        if found is None:
            where = ", ".join(map(str, (*self._spec_folders, *self._beside)))
            message = f"there is no specification {_names(path)[-1]}.tum for this file in {where}"
            made = "" if recorded is None else ", and none there that it was made for"
            raise UserError((Diagnostic(Code.TUM501, message + made, help="give its folder with --specs DIR"),))
        return found

    def named(self, path: Path) -> Path | None:
        """The specification of the same name as a policy or certificate."""
        files = (
            folder / f"{name}{suffix}"
            for folder in (*self._spec_folders, *self._beside)
            for name in _names(path)
            for suffix in SUFFIXES
        )
        return next((file for file in files if os.path.isfile(file)), None)  # noqa: PTH113 - fails for no name

    def without(self, covered: Iterable[Path]) -> list[Path]:
        """The specifications that are none of those covered, nor equal to one in meaning.

        Looked at are the folders that the user names, else those where a specification is looked for anyway.
        """
        covered = list(covered)
        known = {each.resolve() for each in covered}
        meant = {self._digest(each) for each in covered} - {None}
        everything = inside(self._spec_folders or self._beside)
        return [each for each in everything if each.resolve() not in known and self._digest(each) not in meant]

    def _all(self) -> Iterator[Path]:
        return inside([*self._spec_folders, *self._beside])

    def _digest(self, path: Path) -> str | None:
        """The digest of a specification; None where it cannot be used."""
        if path not in self._digests:
            try:
                spec = load(read_source(str(path))).spec
            except UserError:
                spec = None
            self._digests[path] = None if spec is None else digest(spec)
        return self._digests[path]


def _names(path: Path) -> list[str]:
    """The names that the specification of a file may have."""
    name = path.name.rsplit(".", 2)[0]
    return [name, name.removesuffix(".policy")] if name.endswith(".policy") else [name]


def inside(folders: Iterable[Path]) -> Iterator[Path]:
    """The specifications that stand directly in folders."""
    for folder in folders:
        if os.path.isdir(folder):  # noqa: PTH112 - fails for no name
            yield from sorted(each for each in folder.iterdir() if each.suffix in SUFFIXES and each.is_file())
