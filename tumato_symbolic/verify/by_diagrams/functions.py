"""Functions of finitely many variables as ordered diagrams, every function once. Plain Python.

A function is a number. Two functions are equal exactly when their numbers are.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterable, Sequence
from math import prod
from typing import TypeAlias, TypeVar

Function: TypeAlias = int
"""A function, by its number."""

Key = TypeVar("Key", bound=Hashable)
Found = TypeVar("Found")
Part = TypeVar("Part")

FALSE: Function = 0
"""The function that is 0 everywhere: what never holds."""

TRUE: Function = 1
"""The function that is 1 everywhere: what always holds."""

MOST_STEPS = 3_000_000
"""How many results are remembered at most, up to 1 GB; a proof that needs more is given up."""


TOO_LARGE = "the diagrams of the walk grow too large"


class BudgetError(Exception):
    """The walk was given up: it took too many steps or too much time."""


class FullError(BudgetError):
    """It remembered more than it may."""


def given_up(error: BudgetError | RecursionError) -> str:
    """Why the walk was given up."""
    return str(error) if isinstance(error, BudgetError) else "there are too many variables for the walk"


class Functions:
    """Diagrams over variables of these `sizes`, which are tested in this `order`. Leaves are integers.

    Every operation raises `BudgetError` when `deadline` (monotonic) has passed or more than `most` results are
    `remembered`. From time to time `watch` is called, which may raise it as well.
    """

    def __init__(self, order: Sequence[int], sizes: Sequence[int], most_steps: int = MOST_STEPS) -> None:
        self.sizes = [sizes[variable] for variable in order]
        self.level_of = {variable: level for level, variable in enumerate(order)}
        self.deadline: float | None = None
        self.watch: Callable[[], None] | None = None
        self.most = most_steps
        self.remembered = 0
        self._bottom = len(order)
        self._levels: list[int] = []  # of every function, the level that it tests first; `_bottom` for a constant
        self._below: list[tuple[Function, ...]] = []  # what is left of it for every value of that variable
        self._values: dict[Function, int] = {}
        self._constants: dict[int, Function] = {}
        self._known: dict[tuple[int, tuple[Function, ...]], Function] = {}
        self.constant(0)
        self.constant(1)

    def sizes_after(self, variable: int) -> list[int]:
        """How many values this variable and those with larger numbers have."""
        return [self.sizes[level] for each, level in self.level_of.items() if each >= variable]

    @property
    def is_full(self) -> bool:
        """Whether more results were remembered than may be."""
        return self.remembered > self.most

    def check_time(self) -> None:
        """Raises `BudgetError` when the deadline has passed, or the context says so."""
        if self.deadline is not None and time.monotonic() >= self.deadline:
            raise BudgetError("the walk did not end within the time limit")
        if self.watch is not None:
            self.watch()

    def constant(self, value: int) -> Function:
        """The function that is `value` everywhere; 0 and 1 are `FALSE` and `TRUE`."""
        found = self._constants.get(value)
        if found is None:
            found = self._constants[value] = len(self._levels)
            self._levels.append(self._bottom)
            self._below.append(())
            self._values[found] = value
        return found

    def values_of(self, function: Function) -> list[int]:
        """All values that a function takes, in ascending order."""
        seen, pending, found = {function}, [function], set()
        while pending:
            here = pending.pop()
            if here in self._values:
                found.add(self._values[here])
            else:
                fresh = set(self._below[here]) - seen
                seen |= fresh
                pending += fresh
        return sorted(found)

    def levels_of(self, function: Function) -> list[int]:
        """The levels of the variables that a function tests, in ascending order."""
        seen, pending = {function}, [function]
        while pending:
            here = pending.pop()
            if here not in self._values:
                fresh = set(self._below[here]) - seen
                seen |= fresh
                pending += fresh
        return sorted({self._levels[each] for each in seen if each not in self._values})

    def fold(self, function: Function, leaf: Callable[[int], Part], node: Callable[[int, list[Part]], Part]) -> Part:
        """A function handed on: what `leaf` makes of its values, and `node` of a variable and a part for each value."""
        variables = {level: variable for variable, level in self.level_of.items()}
        known: dict[Function, Part] = {}

        def visit(here: Function) -> Part:
            if here not in known:
                if here in self._values:
                    known[here] = leaf(self._values[here])
                else:
                    known[here] = node(variables[self._levels[here]], [visit(part) for part in self._below[here]])
            return known[here]

        return visit(function)

    def count(self, predicate: Function) -> int:
        """For how many values of all variables together a predicate holds."""
        counts = {FALSE: 0, TRUE: 1}
        below = [prod(self.sizes[level:]) for level in range(self._bottom + 1)]

        def visit(function: Function) -> int:
            if function not in counts:
                level = self._levels[function]
                counts[function] = sum(
                    visit(part) * (below[level + 1] // below[self._levels[part]]) for part in self._below[function]
                )
            return counts[function]

        return visit(predicate) * (below[0] // below[self._levels[predicate]])

    def _split(self, function: Function, level: int) -> Iterable[Function]:
        """What is left of a function for every value of the variable at `level`, its first one or one above."""
        return self._below[function] if self._levels[function] == level else (function,) * self.sizes[level]

    def _node(self, level: int, below: tuple[Function, ...]) -> Function:
        if below.count(below[0]) == len(below):
            return below[0]
        fresh = len(self._levels)
        found = self._known.setdefault((level, below), fresh)
        if found == fresh:
            self._levels.append(level)
            self._below.append(below)
        return found

    def _remember(self, known: dict[Key, Found], key: Key, found: Found) -> None:
        known[key] = found
        self.remembered += 1
        if self.remembered > self.most:
            raise FullError(TOO_LARGE)
        if self.remembered & 1023 == 0:
            self.check_time()
