"""Text to tokens: words, numbers, symbols and comments, and which words are keywords everywhere.

Whether a word is a keyword depends on where it stands, so the parser decides that; here a word is a word.
"""

from __future__ import annotations

import re
from typing import Literal, NamedTuple, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span
from tumato_symbolic.diagnostics.wording import quoted

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
    ("START",),
    ("GOALS",),
    ("CONFIG",),
)
"""The titles of blocks."""
TITLES = frozenset(word for title in BLOCKS for word in title)
"""The words in titles."""

COMPARING = frozenset({"<", "<=", ">", ">=", "=", "!="})
"""The symbols that compare numbers."""

MISLEADING = re.compile(
    r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029"  # control characters, some of which end a line in some editors
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]"  # what changes the direction of writing
)
"""Characters that stand nowhere, not even in comments: with them, editors show other lines than are read."""

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


class Tokens(Struct, frozen=True):
    """All tokens of a text, the last of which is its end, and what is wrong with comments.

    `unclosed_comment` is the one that is not closed, if there is one; `misleading` those with a character of that kind.
    """

    tokens: tuple[Token, ...]
    unclosed_comment: Diagnostic | None
    misleading: tuple[Diagnostic, ...]


def pattern(space: str, comment: str, name: str, number: str) -> re.Pattern[str]:
    """The pattern of one token, made of the terminals that the grammar defines."""
    tail = rf"\{{{name}(?:[+-](?:0|[1-9][0-9]*))?\}}[A-Za-z0-9_]*"
    word = rf"{name}(?!\w)(?:{tail})*|[0-9]*(?:{tail})+"
    return re.compile(
        rf"(?P<space>{space})|(?P<comment>{comment})|(?P<word>(?:{word})(?!\w))|(?P<number>{number}(?!\w|\.(?!\.)))"
        r"|(?P<symbol>[:,(){}]|\.\.|(?:<=|>=|!=|[<>=])(?![=<>!&|]|->))|(?P<malformed>[+-]?\d[\w.]*)"
        r"|(?P<unclosed>/\*)|(?P<other>[^\s\w:,(){}/*]+|\w+|.)"
    )


def tokenize(source: Source, token_pattern: re.Pattern[str]) -> Tokens:
    """Split a text. Nothing is lost but white space and comments."""
    tokens: list[Token] = []
    unclosed = None
    misleading: list[Diagnostic] = []
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
            if kind == "comment" and (wrong := MISLEADING.search(text)):
                misleading.append(_misleading(text, wrong.start(), line, column))
            breaks = text.count("\n")
            if breaks:
                line += breaks
                line_start = match.start() + text.rindex("\n") + 1
            continue
        if kind == "word" and text[0] == "{" and _is_set(text, tokens):
            tokens += [Token("symbol", "{", line, column), Token("word", text[1:-1], line, column + 1)]
            kind, text, column = "symbol", "}", column + len(text) - 1
        if kind == "number" and (len(text.lstrip("+-")) > MAX_DIGITS or (text[0] in "+-" and not int(text))):
            kind = "malformed"
        tokens.append(Token(kind, text, line, column))  # type: ignore[arg-type]
    end = tokens[-1].span if tokens else Span(1, 1, 1, 1)
    tokens.append(Token("end", "", end.end_line, end.end_column))
    return Tokens(tuple(tokens), unclosed, tuple(misleading))


def _is_set(text: str, before: list[Token]) -> bool:
    """Whether `{a}` is a set with the value `a` rather than a name that is the value of a parameter `a`."""
    return text[1:-1].isidentifier() and bool(before) and before[-1].text in ("in", "as")


def _misleading(comment: str, place: int, line: int, column: int) -> Diagnostic:
    """The error for a character in a comment that begins at this line and column."""
    breaks = comment.count("\n", 0, place)
    column = place - comment.rindex("\n", 0, place) if breaks else column + place
    return Diagnostic(
        Code.TUM104,
        f"unexpected {quoted(comment[place])} in a comment",
        Span(line + breaks, column, line + breaks, column + 1),
        help="remove it: some editors begin a line there, or change the direction, and others show nothing",
    )
