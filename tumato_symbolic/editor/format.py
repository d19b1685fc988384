"""One layout for all texts: spaces, blank lines and the width of lines change, and nothing else.

Comments stay where they are.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise

from msgspec import Struct

from tumato_symbolic.diagnostics import Source, UserError
from tumato_symbolic.editor.breaks import Break, breaks
from tumato_symbolic.editor.gaps import Gap, gaps
from tumato_symbolic.editor.structure import STEP, Start, starts
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.grammar import grammar
from tumato_symbolic.syntax.parser import read_terminals
from tumato_symbolic.syntax.tokens import Token

MAX_WIDTH = 120
"""The columns of a line, unless nothing in it can be broken."""

_TIGHT_AFTER = frozenset({"(", "{", ".."})
_TIGHT_BEFORE = frozenset({")", "}", ",", ":", ".."})


def format_text(source: Source) -> str:
    """The text in its one layout, which has the same tokens and comments.

    Raises `UserError` with the mistakes in the syntax where there are any.
    """
    parsed, tokens, terminals = read_terminals(source)
    if parsed.diagnostics or parsed.tree is None:
        raise UserError(parsed.diagnostics, source)
    between = gaps(source, tokens, grammar().token_pattern)
    layout = _Layout(tokens, terminals, between, starts(tokens, terminals), breaks(parsed.tree, tokens))
    text = layout.text()
    _confirm(Source(source.name, text), parsed.tree, tokens, between)
    return text


def _confirm(after: Source, tree: ast.Specification, tokens: Sequence[Token], between: Sequence[Gap]) -> None:
    """Raise `AssertionError` where a mistake of ours would change what a text says, or lose a comment."""
    parsed, found, _ = read_terminals(after)
    comments = _comments(gaps(after, found, grammar().token_pattern))
    same = parsed.tree == tree and not parsed.diagnostics and comments == _comments(between)
    if not same or "".join(each.text for each in found) != "".join(each.text for each in tokens):
        raise AssertionError(f"{after.name} would be changed by its layout")


def _comments(between: Sequence[Gap]) -> list[str]:
    return [comment.text for gap in between for comment in gap.comments]


class _Layout(Struct, frozen=True, dict=True):
    """A text whose lines are being chosen. Its first token and each of `starts` begin a line, or go on with one."""

    tokens: Sequence[Token]
    terminals: Sequence[str]
    gaps: Sequence[Gap]
    starts: Mapping[int, Start]
    breaks: Mapping[int, Break]

    @cached_property
    def columns(self) -> list[int]:
        """The column at which the line of each token begins, be it with a comment."""
        return _line_columns(self.tokens, self.gaps)

    def text(self) -> str:
        """Every line."""
        lines = _Lines()
        end = len(self.tokens) - 1
        for first, last in pairwise([*self.entries, end]):
            self._write_entry(lines, first, last)
        self._write_gap(lines, end, 0)
        return lines.text()

    @cached_property
    def entries(self) -> list[int]:
        """The places at which lines begin; a goal that fits after its condition begins none."""
        found = [place for place in self.starts if not (place and self.gaps[place].is_fixed_line)]
        kept = list[int]()
        for place, after in pairwise([*found, len(self.tokens) - 1]):
            if place and self.terminals[place - 1] == "then" and self.terminals[place] == "goal":
                first = kept[-1]
                if self._fits(first, after, self.starts[first].indent):
                    continue
            kept.append(place)
        return kept

    def _write_entry(self, lines: _Lines, first: int, last: int) -> None:
        """One entry: as one line, or as several."""
        start = self.starts.get(first, Start(0))
        self._write_gap(lines, first, start.indent)
        broken = dict[int, int]()
        self._break(broken, first, last, start.indent, start.indent + 2 * STEP)
        for place in range(first, last):
            if place in broken:
                self._write_gap(lines, place, broken[place])
            elif place > first:
                for comment in self.gaps[place].comments:
                    lines.add(" " + comment.text)
                lines.add(self._space(place))
            lines.add(self._token(place))

    # How lines are broken.

    def _break(self, broken: dict[int, int], first: int, last: int, column: int, indent: int) -> None:
        """Break what begins at a column and does not fit; what follows on lines of its own has an indentation."""
        if self._fits(first, last, column):
            return
        inside = range(first + 1, last)
        free = [place for place in inside if place in self.breaks and not self.gaps[place].is_fixed_line]
        if not free:
            broken.update((place, indent) for place in inside if self.gaps[place].forces_break)
            return
        level = min(self.breaks[place].level for place in free)
        chosen = [place for place in free if self.breaks[place].level == level]
        ends = [*chosen[1:], last]
        kept = [first]
        for place, end in zip(chosen, ends, strict=True):
            here = column if kept[-1] == first else indent
            if self.breaks[place].fill and self._fits(kept[-1], end, here):
                continue
            kept.append(place)
            broken[place] = indent
        for place, end in zip(kept, [*kept[1:], last], strict=True):
            self._break(broken, place, end, column if place == first else indent, indent + STEP)

    def _fits(self, first: int, last: int, column: int) -> bool:
        """Whether tokens fit on one line that begins at a column."""
        width = column
        for place in range(first, last):
            if place > first:
                gap = self.gaps[place]
                if gap.forces_break or gap.spans_lines:
                    return False
                width += sum(1 + len(comment.text) for comment in gap.comments) + len(self._space(place))
            width += len(self._token(place))
        return width <= MAX_WIDTH

    # What is written.

    def _token(self, place: int) -> str:
        """A token; the sign of a relative effect stands apart from its number, as when they are two tokens."""
        text = self.tokens[place].text
        return f"{text[0]} {text[1:]}" if self._is_change(place) else text

    def _is_change(self, place: int) -> bool:
        return self.terminals[place] == "OFFSET" and self.terminals[place - 2] == "is"

    def _space(self, place: int) -> str:
        """What stands between a token and what is before it on its line."""
        text, gap = self.tokens[place].text, self.gaps[place]
        tight = text in _TIGHT_BEFORE or (self.terminals[place] == "OFFSET" and not self._is_change(place))
        after = self.tokens[place - 1].text in _TIGHT_AFTER and not gap.comments
        return "" if tight or after else " "

    def _write_gap(self, lines: _Lines, place: int, indent: int) -> None:
        """The comments of a gap in which a line ends, and that end of a line."""
        gap = self.gaps[place]
        wanted = list(gap.all_breaks)
        start = self.starts.get(place)
        at_end = place == len(self.tokens) - 1
        if not any(wanted) and place and not at_end and (start or not gap.spans_lines):
            wanted[-1] = 1
        wanted[0] = self._after_token(place, wanted[0])
        if self._begins_block(place) and not gap.spans_lines and not gap.after_comment:
            wanted[next(number for number, count in enumerate(wanted) if count)] = 2
        for number, (comment, count) in enumerate(zip(gap.comments, wanted, strict=False), 1):
            alone = any(wanted[number:])
            lines.end(count, self._comment_indent(place, comment.column, indent) if alone else indent)
            lines.add(comment.text if count or not lines.begun else " " + comment.text)
        if at_end:
            return
        lines.end(wanted[-1], indent)
        if not wanted[-1] and lines.begun:
            lines.add(self._space(place))

    def _after_token(self, place: int, breaks: int) -> int:
        """The ends of lines just after a token: no blank line in an entry, at the ends of a block, or of the text."""
        start = self.starts.get(place)
        at_end = place == len(self.tokens) - 1
        if place == 0:
            return 0
        opened = self._opening(place)
        closed = start is not None and start.closes and not self.gaps[place].comments
        if self.gaps[place].after_comment or not ((start is None and not at_end) or opened or closed):
            return breaks
        return min(breaks, 1)

    def _opening(self, place: int) -> bool:
        """Whether what opens a block or copies, or the condition of a goal, is just before a place."""
        number = bisect_left(self.entries, place)
        return number > 0 and (self.starts[self.entries[number - 1]].opens or self.terminals[place - 1] == "then")

    def _begins_block(self, place: int) -> bool:
        """Whether a block begins after another one, outside of all."""
        return place > 0 and self.terminals[place] == "BEGIN" and self.starts[place].indent == 0

    def _comment_indent(self, place: int, column: int, indent: int) -> int:
        """A comment is indented as what it is about: what follows, or, if it was indented like that, what precedes."""
        start = self.starts.get(place)
        if start is None:
            return indent
        wanted = start.inner if start.closes else indent
        if column <= self.columns[place]:
            return wanted
        found = wanted
        for entry in reversed(self.entries[: bisect_left(self.entries, place)]):
            indent = self.starts[entry].indent
            if indent <= wanted:
                break
            if self.columns[entry] <= column and any(self.gaps[entry].all_breaks):
                found = max(found, indent)
        return found


def _line_columns(tokens: Sequence[Token], between: Sequence[Gap]) -> list[int]:
    """The column at which the line of each token begins, be it with a comment."""
    found = list[int]()
    column = 1
    for token, gap in zip(tokens, between, strict=True):
        for each, breaks_ in zip(
            (*(comment.column for comment in gap.comments), token.column), gap.all_breaks, strict=True
        ):
            column = each if breaks_ or not found else column
        found.append(column)
    return found


class _Lines:
    """Lines that are being written."""

    def __init__(self) -> None:
        self._done: list[str] = []
        self._line = ""

    @property
    def begun(self) -> bool:
        """Whether something stands on the line."""
        return bool(self._line.strip())

    def add(self, text: str) -> None:
        """Go on with the line."""
        self._line += text

    def end(self, count: int, indent: int) -> None:
        """End so many lines, and begin one with an indentation; with 0, go on."""
        if not count:
            return
        self._done += [self._line.rstrip(" \t"), *[""] * (count - 1)]
        self._line = " " * indent

    def text(self) -> str:
        """All of them, each with its end."""
        return "\n".join([*self._done, self._line]).rstrip("\n") + "\n" if self._done or self._line else ""
