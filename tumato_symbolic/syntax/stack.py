"""The stack of the LALR parser, opened up: what fits is asked before it is fed, and mistakes can be cut off."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeAlias, get_args

from lark import Lark, Token, Tree
from lark.parsers.lalr_analysis import Shift

from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.builder import span_of

Row: TypeAlias = Mapping[str, tuple[Any, Any]]
"""What a state of the parser does with each terminal: shift to another state, or reduce by a rule."""


class Stack:
    """One run of the parser. A depth counts the values from the bottom that are kept."""

    def __init__(self, parser: Lark) -> None:
        self._machine = parser.parse_interactive()
        state = self._machine.parser_state
        self._states: list[Any] = state.state_stack
        self._rows: Mapping[Any, Row] = state.parse_conf.parse_table.states
        self._end_state = state.parse_conf.end_state
        self.values: list[object] = state.value_stack

    def row(self, depth: int | None = None) -> Row:
        """The row of the state on top, or of the one at a depth."""
        return self._rows[self._states[-1 if depth is None else depth]]

    def feed(self, token: Token) -> Any:  # noqa: ANN401 - a tree at the end of the text, None before
        """Take a token that fits."""
        return self._machine.feed_token(token)

    def fits(self, terminal: str) -> bool:
        """Whether a terminal can come next. Nothing is reduced by asking."""
        action = self.row().get(terminal)
        if action is None or action[0] is Shift:
            return action is not None
        return self.after(terminal, len(self._states) - 1) is not None

    def accepted(self) -> frozenset[str]:
        """Every terminal that can come next."""
        return frozenset(each for each in self.row() if (each.isupper() or each == "$END") and self.fits(each))

    def shifts(self, terminal: str, depth: int) -> bool:
        """Whether a terminal is taken at a depth without completing anything first."""
        return terminal in self.row(depth) and self.row(depth)[terminal][0] is Shift

    def after(self, terminal: str, depth: int) -> Row | None:
        """The row of the state after a terminal, fed with the stack cut to `depth`; None where it does not fit."""
        below, above = depth, list[Any]()
        while True:
            action, target = self._rows[above[-1] if above else self._states[below]].get(terminal, (None, None))
            if action is None:
                return None
            if action is Shift:
                return self._rows[target]
            size = len(target.expansion)
            below -= max(0, size - len(above))
            del above[max(0, len(above) - size) :]
            state = self._rows[above[-1] if above else self._states[below]][target.origin.name][1]
            if state == self._end_state:
                return self._rows[state]
            above.append(state)

    def topmost(self) -> list[int]:
        """The depths at which a state lies that lies nowhere above, from the top down."""
        depths: dict[Any, int] = {}
        for depth in range(len(self._states) - 1, -1, -1):
            depths.setdefault(self._states[depth], depth)
        return list(depths.values())

    def outermost(self) -> int:
        """The depth below which there are only complete blocks."""
        return next((depth for depth, value in enumerate(self.values) if isinstance(value, Token)), len(self.values))

    def ends_field(self, depth: int) -> bool:
        """Whether the value below a depth is a list of an action's fields, so that the action may end there."""
        value = self.values[depth - 1] if depth else None
        return isinstance(value, Tree) and isinstance(next(iter(value.children), None), get_args(ast.Field))

    def cut(self, depth: int) -> tuple[int, int] | None:
        """Drop everything above a depth; the line and column where that began, if it stood for any text."""
        dropped = self.values[depth:]
        del self._states[depth + 1 :]
        del self.values[depth:]
        return next(_starts(dropped), None)


def _starts(values: list[object]) -> Iterator[tuple[int, int]]:
    for value in values:
        for part in value.children[:1] if isinstance(value, Tree) else [value]:
            span = span_of(part)
            yield span.line, span.column
