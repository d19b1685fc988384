"""The stack of the LALR parser, opened up: what fits is asked before it is fed, and mistakes can be cut off."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias, get_args

from tumato_symbolic.syntax import ast, builder
from tumato_symbolic.syntax.builder import Children, span_of
from tumato_symbolic.syntax.table import START, Rule, Table, is_list
from tumato_symbolic.syntax.tokens import Token

Row: TypeAlias = Mapping[str, int]
"""What a state does with each terminal: go to a state, or, below zero, complete a rule. See `Table.actions`."""


class Stack:
    """One run of the parser. A depth counts the values from the bottom that are kept.

    A value is a token, a node of the tree, or a list of them that becomes part of what stands around it.
    """

    def __init__(self, table: Table) -> None:
        self._table = table
        self._makers = [_maker(rule) for rule in table.rules]
        self._states = [START]
        self.values: list[object] = []

    def row(self, depth: int = -1) -> Row:
        """The row of the state on top, or of the one at a depth."""
        return self._table.actions[self._states[depth]]

    def feed(self, terminal: str, token: Token) -> Any:  # noqa: ANN401 - a tree at the end of the text, None before
        """Take a token that fits, as the terminal that it stands for."""
        states, values = self._states, self.values
        while (action := self._table.actions[states[-1]][terminal]) < 0:
            rule = self._table.rules[-1 - action]
            depth = len(values) - len(rule.parts)
            value = self._makers[-1 - action](values[depth:])
            del values[depth:], states[depth + 1 :]
            values.append(value)
            states.append(self._table.gotos[states[-1]][rule.origin])
            if states[-1] == self._table.end:
                return value
        states.append(action)
        values.append(ast.Name(token.text, span=token.span) if terminal == "NAME" else token)
        return None

    def fits(self, terminal: str) -> bool:
        """Whether a terminal can come next. Nothing is completed by asking."""
        action = self.row().get(terminal)
        if action is None or action >= 0:
            return action is not None
        return self.after(terminal, len(self.values)) is not None

    def accepted(self) -> frozenset[str]:
        """Every terminal that can come next."""
        found = frozenset(each for each in self.row() if self.fits(each))
        special = found & {"FOR_ACTIONS", "FOR_CLAUSES"}
        return found - special | {"for"} if special else found

    def shifts(self, terminal: str, depth: int) -> bool:
        """Whether a terminal is taken at a depth without completing anything first."""
        return self.row(depth).get(terminal, -1) >= 0

    def after(self, terminal: str, depth: int) -> Row | None:
        """The row of the state after a terminal, fed with the stack cut to `depth`; None where it does not fit."""
        table = self._table
        below, above = depth, list[int]()
        while True:
            action = table.actions[above[-1] if above else self._states[below]].get(terminal)
            if action is None:
                return None
            if action >= 0:
                return table.actions[action]
            rule = table.rules[-1 - action]
            size = len(rule.parts)
            below -= max(0, size - len(above))
            del above[max(0, len(above) - size) :]
            state = table.gotos[above[-1] if above else self._states[below]][rule.origin]
            if state == table.end:
                return table.actions[state]
            above.append(state)

    def topmost(self) -> list[int]:
        """The depths at which a state lies that lies nowhere above, from the top down."""
        depths: dict[int, int] = {}
        for depth in range(len(self._states) - 1, -1, -1):
            depths.setdefault(self._states[depth], depth)
        return list(depths.values())

    def outermost(self) -> int:
        """The depth below which there are only complete blocks."""
        return next((depth for depth, value in enumerate(self.values) if isinstance(value, Token)), len(self.values))

    def ends_field(self, depth: int) -> bool:
        """Whether the value below a depth is a list of an action's fields, so that the action may end there."""
        value = self.values[depth - 1] if depth else None
        return isinstance(value, list) and isinstance(next(iter(value), None), get_args(ast.Field))

    def cut(self, depth: int) -> tuple[int, int] | None:
        """Drop everything above a depth; the line and column where that began, if it stood for any text."""
        dropped = self.values[depth:]
        del self._states[depth + 1 :]
        del self.values[depth:]
        return next(_starts(dropped), None)


def _maker(rule: Rule) -> Callable[[Children], Any]:
    """What makes one value of those that a rule completes."""
    whole = getattr(builder, rule.node) if rule.node else _all if is_list(rule.origin) else _only
    if not any(map(is_list, rule.parts)):
        return whole
    return lambda parts: whole(_spliced(parts))


def _all(parts: Children) -> Children:
    return parts


def _only(parts: Children) -> Any:  # noqa: ANN401 - whatever it is
    (part,) = parts
    return part


def _spliced(parts: Children) -> Children:
    """The parts, with the members of lists among them in place of the lists. The first part is extended in place."""
    spliced: Children = parts[0] if isinstance(parts[0], list) else [parts[0]]
    for part in parts[1:]:
        if isinstance(part, list):
            spliced += part
        else:
            spliced.append(part)
    return spliced


def _starts(values: list[object]) -> Iterator[tuple[int, int]]:
    for value in values:
        for part in value[:1] if isinstance(value, list) else [value]:
            span = span_of(part)
            yield span.line, span.column
