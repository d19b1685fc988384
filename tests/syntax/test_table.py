"""The parse table in the package is the grammar, compiled."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax import grammar as room
from tumato_symbolic.syntax import parse
from tumato_symbolic.syntax.compiling import compile_table
from tumato_symbolic.syntax.table import read, written

GRAMMAR = room.grammar_path().read_text(encoding="utf-8")


@pytest.fixture
def use_grammar(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the grammar that is used instead of it."""
    copy = tmp_path / "tumato.lark"
    copy.write_text(GRAMMAR, encoding="utf-8")
    monkeypatch.setattr(room, "grammar_path", lambda: copy)
    room.grammar.cache_clear()
    yield copy
    room.grammar.cache_clear()


def test_the_file_is_the_grammar_compiled() -> None:
    """`tumato.table.json` is what `make regenerate` writes for the grammar as it stands."""
    assert room.TABLE_PATH.read_text(encoding="utf-8") == written(compile_table(GRAMMAR), GRAMMAR)


def test_a_table_is_read_as_it_was_written() -> None:
    """Reading is the inverse of writing, for the same grammar; a table of another grammar is not read."""
    table = compile_table(GRAMMAR)
    text = written(table, GRAMMAR)
    assert read(text, GRAMMAR) == table
    assert read(text, GRAMMAR + "\n") is None


@pytest.mark.parametrize("seed", ["1", "2"])
def test_compiling_does_not_depend_on_the_process(seed: str) -> None:
    """The same grammar gives the same file, whatever Python's hashes are."""
    program = "from tests.syntax.test_table import *; print(written(compile_table(GRAMMAR), GRAMMAR), end='')"
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, env=environment)
    assert done.stdout == room.TABLE_PATH.read_text(encoding="utf-8")


def test_an_edited_grammar_counts_at_once(use_grammar: Path) -> None:
    """Where the grammar differs from the one that was compiled, it is compiled anew, and its texts are read."""
    text = "BEGIN RESOURCES ressource arm END RESOURCES"
    assert parse(Source("before", text)).diagnostics
    use_grammar.write_text(GRAMMAR.replace('resource: "resource"', 'resource: "ressource"'), encoding="utf-8")
    room.grammar.cache_clear()
    assert not parse(Source("after", text)).diagnostics
