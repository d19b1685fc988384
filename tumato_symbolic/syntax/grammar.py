"""The grammar file, compiled once per process."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from lark import Lark, Token
from lark.lexer import Lexer

from tumato_symbolic.syntax.builder import Builder
from tumato_symbolic.syntax.tokens import pattern


@dataclass(frozen=True)
class Grammar:
    """A parser that is fed with tokens, the terminal of every keyword and symbol, and the pattern of a token."""

    parser: Lark
    terminals: Mapping[str, str]
    spellings: Mapping[str, str]
    token_pattern: re.Pattern[str]


class _Fed(Lexer):
    """In place of a lexer: tokens are fed one by one, and the patterns of lark's own lexer need not be compiled."""

    def __init__(self, lexer_conf: object) -> None:
        pass

    def lex(self, lexer_state: object, parser_state: object) -> Iterator[Token]:
        return iter(())


def grammar_path() -> Path:
    """Where the grammar is: beside this file in an installed package, in `grammar/` in a checkout."""
    installed = Path(__file__).with_name("tumato.lark")
    checkout = Path(__file__).parents[2] / "grammar" / "tumato.lark"
    return installed if installed.exists() else checkout


@lru_cache(maxsize=1)
def grammar() -> Grammar:
    """Read and compile the grammar."""
    parser = Lark(
        grammar_path().read_text(encoding="utf-8"),
        start="specification",
        parser="lalr",
        lexer=_Fed,
        keep_all_tokens=True,
        maybe_placeholders=False,
        transformer=Builder(),
    )
    literal = {each.pattern.value: each.name for each in parser.terminals if each.pattern.type == "str"}
    regular = {each.name: each.pattern.value for each in parser.terminals if each.pattern.type == "re"}
    return Grammar(
        parser,
        literal,
        {terminal: text for text, terminal in literal.items()},
        pattern(regular["SPACE"], regular["COMMENT"], regular["NAME"], regular["NUMBER"]),
    )
