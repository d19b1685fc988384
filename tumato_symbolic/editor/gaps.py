"""What stands between the tokens of a text: comments, and ends of lines."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from tumato_symbolic.diagnostics import Source, allowed_on
from tumato_symbolic.syntax.tokens import Token


class Comment(NamedTuple):
    """A comment; `breaks` counts the ends of lines in the white space before it, up to 2: a blank line."""

    text: str
    breaks: int
    column: int

    @property
    def ends_line(self) -> bool:
        """Whether nothing can stand after it on its line."""
        return self.text.startswith("//")


class Gap(NamedTuple):
    """What stands before a token: comments, and then `breaks` ends of lines.

    Where it is `fixed`, a comment in it allows something, or one does on the line of the token or of the one before it:
    lines have to end where they do. `after_comment` tells that the line of the token before it begins like a comment,
    so that what is allowed there would be allowed on the next line as well, if there were no blank line between them.
    """

    comments: tuple[Comment, ...]
    breaks: int
    fixed: bool = False
    after_comment: bool = False

    @property
    def all_breaks(self) -> tuple[int, ...]:
        """The ends of lines before each comment, and before the token."""
        return (*(comment.breaks for comment in self.comments), self.breaks)

    @property
    def forces_break(self) -> bool:
        """Whether a line has to end in it: after `//`, around a comment on lines of its own, and where it is fixed."""
        breaks = self.all_breaks
        alone = (before and after for before, after in pairwise(breaks))
        return any(comment.ends_line for comment in self.comments) or any(alone) or self.is_fixed_break

    @property
    def is_fixed_break(self) -> bool:
        """Whether the lines that end in it have to."""
        return self.fixed and any(self.all_breaks)

    @property
    def is_fixed_line(self) -> bool:
        """Whether the token has to go on with the line of the one before it."""
        return self.fixed and not any(self.all_breaks)

    @property
    def spans_lines(self) -> bool:
        """Whether a comment in it has several lines."""
        return any("\n" in comment.text for comment in self.comments)


def gaps(source: Source, tokens: Sequence[Token], token_pattern: re.Pattern[str]) -> list[Gap]:
    """The gap before each token; the last token is the end of the text."""
    lines = source.text.split("\n")
    speaking = "allow" in source.text
    waiting = list(_comments(source.text, token_pattern))[::-1]
    found = list[Gap]()
    line, before, after_comment = 1, frozenset[str](), False
    for token in tokens:
        at_end = token.kind == "end"
        comments = list[Comment]()
        while waiting and (at_end or waiting[-1][:2] < (token.line, token.column)):
            place, column, text = waiting.pop()
            comments.append(Comment(text.rstrip(), min(place - line, 2), column))
            line = place + text.count("\n")
        allowed = allowed_on(lines, token.line - 1) if speaking and not at_end else frozenset()
        fixed = bool(allowed or before) or (speaking and any(map(_speaks, comments)))
        found.append(Gap(tuple(comments), min(max(token.line - line, 0), 2), fixed, fixed and after_comment))
        line, before = max(line, token.line), allowed
        after_comment = speaking and lines[token.line - 1].lstrip(" \t").startswith("//")
    return found


def _speaks(comment: Comment) -> bool:
    lines = comment.text.split("\n")
    return any(allowed_on([line], 0) for line in lines)


def _comments(text: str, token_pattern: re.Pattern[str]) -> Iterator[tuple[int, int, str]]:
    """Line, column and text of every comment."""
    line, start = 1, 0
    for match in token_pattern.finditer(text):
        if match.lastgroup == "comment":
            yield line, match.start() - start + 1, match.group()
        breaks = match.group().count("\n")
        if breaks:
            line += breaks
            start = match.start() + match.group().rindex("\n") + 1
