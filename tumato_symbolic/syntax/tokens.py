"""Text to tokens.

Whether a word is a keyword depends on where it stands, so the parser decides that; here a word is a word.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span

HARD = frozenset({"AND", "OR", "NOT", "IF", "THEN", "IFONLYIF", "BEGIN", "END"})
"""Words that are keywords everywhere."""

BLOCKS = (
    ("STATE", "VECTOR"),
    ("ALIASES",),
    ("RESOURCES",),
    ("ACTIONS",),
    ("REACTION", "RULES"),
    ("STATE", "RULES"),
    ("ASSUMPTIONS",),
    ("GOALS",),
    ("CONFIG",),
)
"""The titles of blocks."""
TITLES = frozenset(word for title in BLOCKS for word in title)
"""The words in titles."""

MAX_DIGITS = 18
"""The most digits a number may have; every sensible bound is far below."""

Kind: TypeAlias = Literal["word", "number", "symbol", "malformed", "other", "end"]


class Token(NamedTuple):
    """A piece of text. `malformed` begins with a digit and is no number; `other` fits nowhere; `end` is empty."""

    kind: Kind
    text: str
    line: int
    column: int

    @property
    def span(self) -> Span:
        """The range of the token, which never crosses a line."""
        return Span(self.line, self.column, self.line, self.column + len(self.text))


@dataclass(frozen=True, slots=True)
class Tokens:
    """All tokens of a text, the last of which is its end, and the comment that is not closed, if there is one."""

    tokens: tuple[Token, ...]
    unclosed_comment: Diagnostic | None


def pattern(space: str, comment: str, name: str, number: str) -> re.Pattern[str]:
    """The pattern of one token, made of the terminals that the grammar defines."""
    return re.compile(
        rf"(?P<space>{space})|(?P<comment>{comment})|(?P<word>{name}(?!\w))|(?P<number>{number}(?![\w.]))"
        r"|(?P<symbol>[:,()])|(?P<malformed>-?\d[\w.]*)|(?P<unclosed>/\*)"
        r"|(?P<other>[^\s\w:,()/*]+|\w+|.)"
    )


def tokenize(source: Source, token_pattern: re.Pattern[str]) -> Tokens:
    """Split a text. Nothing is lost but white space and comments."""
    tokens: list[Token] = []
    unclosed = None
    line, line_start = 1, 0
    for match in token_pattern.finditer(source.text):
        kind, text = match.lastgroup, match.group()
        column = match.start() - line_start + 1
        if kind == "unclosed":
            unclosed = Diagnostic(
                Code.TUM106,
                "this comment is not closed",
                Span(line, column, line, column + 2),
                help="close it with `*/`; everything after it was left unread",
            )
            break
        if kind in ("space", "comment"):
            breaks = text.count("\n")
            if breaks:
                line += breaks
                line_start = match.start() + text.rindex("\n") + 1
            continue
        if kind == "number" and len(text.lstrip("-")) > MAX_DIGITS:
            kind = "malformed"
        tokens.append(Token(kind, text, line, column))  # type: ignore[arg-type]
    end = tokens[-1].span if tokens else Span(1, 1, 1, 1)
    tokens.append(Token("end", "", end.end_line, end.end_column))
    return Tokens(tuple(tokens), unclosed)
