"""The grammar, ready for the parser, once per process."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from msgspec import Struct

from tumato_symbolic.syntax.table import Table, read
from tumato_symbolic.syntax.tokens import pattern

TABLE_PATH = Path(__file__).with_name("tumato.table.json")
"""The parse table of the grammar, compiled beforehand."""


class Grammar(Struct, frozen=True):
    """A parse table, the words and symbols that the grammar spells out, and the pattern of a token."""

    table: Table
    keywords: frozenset[str]
    token_pattern: re.Pattern[str]


def grammar_path() -> Path:
    """Where the grammar is: beside this file in an installed package, in `grammar/` in a checkout."""
    installed = Path(__file__).with_name("tumato.lark")
    checkout = Path(__file__).parents[2] / "grammar" / "tumato.lark"
    return installed if installed.exists() else checkout


@lru_cache(maxsize=1)
def grammar() -> Grammar:
    """The grammar with the table in the file, or, where it was edited since, with one that is compiled now."""
    text = grammar_path().read_text(encoding="utf-8")
    table = read(TABLE_PATH.read_text(encoding="utf-8"), text)
    if table is None:
        from tumato_symbolic.syntax.compiling import compile_table

        table = compile_table(text)
    patterns = table.patterns
    return Grammar(
        table,
        frozenset().union(*table.actions) - patterns.keys() - {"$END"},
        pattern(patterns["SPACE"], patterns["COMMENT"], patterns["NAME"], patterns["NUMBER"]),
    )
