"""Files and functions are as short as CONTRIBUTING.md says, or say why they are not."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

import pytest
from msgspec import Struct

from tests.repo.documents import ROOT

LINES_OF_A_FILE = 300
LINES_OF_A_FUNCTION = 40
"""Without the docstring."""

REASON = re.compile(r"^Longer than 300 lines because [^.]+\.$", re.MULTILINE)
"""A sentence in the docstring of a file."""

FILES = sorted((ROOT / "tumato_symbolic").rglob("*.py"))


class Source(Struct, frozen=True):
    """A file: how many lines it has, and its tree."""

    path: str
    lines: int
    tree: ast.Module

    @classmethod
    def of(cls, path: str, text: str) -> Source:
        """A file with this text."""
        return cls(path, len(text.splitlines()), ast.parse(text))


@pytest.fixture(scope="module")
def package() -> list[Source]:
    """Every file of the package."""
    return [Source.of(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")) for path in FILES]


def test_long_files_say_why(package: list[Source]) -> None:
    """A file of more than 300 lines has a sentence for it, and no other file has one."""
    assert len(package) > 100
    long = [source.path for source in package if source.lines > LINES_OF_A_FILE]
    assert long == [source.path for source in package if REASON.search(ast.get_docstring(source.tree) or "")]


def test_functions_fit_a_screen(package: list[Source]) -> None:
    """No function has more than 40 lines, counted from `def`, its docstring left out."""
    assert [found for source in package for found in _long_functions(source)] == []


def test_a_long_function_is_noticed() -> None:
    """One line more than may be is found, in methods too; a docstring takes none."""
    line = "    pass\n"
    fits = 'class A:\n  async def f(self):\n    """Two\n    lines."""\n' + line * (LINES_OF_A_FUNCTION - 1)
    assert list(_long_functions(Source.of("a.py", fits))) == []
    assert list(_long_functions(Source.of("a.py", fits + line))) == ["a.py: f has 41 lines"]


def _long_functions(source: Source) -> Iterator[str]:
    for node in ast.walk(source.tree):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        documented = ast.get_docstring(node) is not None
        lines = _lines(node) - (_lines(node.body[0]) if documented else 0)
        if lines > LINES_OF_A_FUNCTION:
            yield f"{source.path}: {node.name} has {lines} lines"


def _lines(node: ast.stmt) -> int:
    assert node.end_lineno is not None
    return node.end_lineno - node.lineno + 1
