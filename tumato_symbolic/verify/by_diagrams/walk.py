"""The walk: functions of finitely many variables as ordered diagrams, every function once. Plain Python.

A function is a number. Two functions are equal exactly when their numbers are, so that a violation is impossible
exactly when it is `FALSE`. All that is computed comes from four walks over diagrams, each remembering what it has
done: `select` (cases), `combine` (any operation on two functions), `substitute` (functions for variables; an
effect is a constant for each variable that it writes) and `assign` (values for variables where a predicate holds).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from math import prod
from typing import TypeAlias, TypeVar

from tumato_symbolic.diagrams import Diagram, Leaf

Function: TypeAlias = int
"""A function, by its number."""
Substitution: TypeAlias = tuple[tuple[int, Function], ...]
"""Functions for variables, sorted by variable; every other variable stays."""

Key = TypeVar("Key", bound=Hashable)
Found = TypeVar("Found")
Part = TypeVar("Part")

FALSE: Function = 0
TRUE: Function = 1

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


class Walk:
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
        self._known: dict[tuple[int, tuple[Function, ...]], Function] = {}
        self._selected: dict[tuple[Function, tuple[Function, ...]], Function] = {}
        self._combined: dict[Callable[[int, int], int], dict[tuple[Function, Function], Function]] = {}
        self._substituted: dict[Substitution, dict[Function, Function]] = {}
        self.constant(0)
        self.constant(1)

    @property
    def is_full(self) -> bool:
        """Whether more results were remembered than may be."""
        return self.remembered > self.most

    def make_room(self) -> None:
        """Forget results, and no functions, where half as many are remembered as may be."""
        if self.most < 2 * self.remembered and 2 * len(self._levels) < self.most:
            self._selected.clear()
            self._combined.clear()
            self._substituted.clear()
            self.remembered = 0

    def check_time(self) -> None:
        """Raises `BudgetError` when the deadline has passed, or whoever watches says so."""
        if self.deadline is not None and time.monotonic() >= self.deadline:
            raise BudgetError("the walk did not end within the time limit")
        if self.watch is not None:
            self.watch()

    def constant(self, value: int) -> Function:
        """The function that is `value` everywhere; 0 and 1 are `FALSE` and `TRUE`."""
        found = self._make(self._bottom, (-1, value))
        self._values[found] = value
        return found

    def variable(self, variable: int) -> Function:
        """The value of a variable."""
        return self.by_value(variable, [self.constant(value) for value in range(self.sizes[self.level_of[variable]])])

    def by_value(self, variable: int, below: Sequence[Function]) -> Function:
        """`below[v]` where the variable has the value `v`."""
        level = self.level_of[variable]
        if all(self._levels[each] > level for each in below):
            return self._node(level, tuple(below))
        return self.select(self.variable(variable), below)

    def select(self, number: Function, cases: Sequence[Function]) -> Function:
        """`cases[n]` where `number` is `n`."""
        cases = tuple(cases)
        if number in self._values:
            return cases[self._values[number]]
        if cases.count(cases[0]) == len(cases):
            return cases[0]
        if cases == (FALSE, TRUE):
            return number
        key = (number, cases)
        found = self._selected.get(key)
        if found is None:
            level = min([self._levels[each] for each in (number, *cases)])
            parts = zip(*[self._split(each, level) for each in cases], strict=True)
            below = zip(self._split(number, level), parts, strict=True)
            found = self._node(level, tuple([self.select(part, rest) for part, rest in below]))
            self._remember(self._selected, key, found)
        return found

    def combine(self, operation: Callable[[int, int], int], one: Function, other: Function) -> Function:
        """The function `operation(one, other)`."""
        if one in self._values and other in self._values:
            return self.constant(operation(self._values[one], self._values[other]))
        known = self._combined.setdefault(operation, {})
        found = known.get((one, other))
        if found is None:
            level = min(self._levels[one], self._levels[other])
            pairs = zip(self._split(one, level), self._split(other, level), strict=True)
            found = self._node(level, tuple([self.combine(operation, *pair) for pair in pairs]))
            self._remember(known, (one, other), found)
        return found

    def substitute(self, function: Function, given: Mapping[int, Function]) -> Function:
        """`function` with other functions for some of its variables, all at once."""
        return self._substitute(function, *self._substitution(given))

    def _substitution(self, given: Mapping[int, Function]) -> tuple[dict[int, Function], int, dict[Function, Function]]:
        """What is given by level, the deepest level, and what is known of this substitution."""
        by_level = {self.level_of[variable]: replacement for variable, replacement in given.items()}
        return by_level, max(by_level, default=-1), self._substituted.setdefault(tuple(sorted(given.items())), {})

    def _substitute(
        self, function: Function, given: Mapping[int, Function], deepest: int, known: dict[Function, Function]
    ) -> Function:
        level = self._levels[function]
        if level > deepest:
            return function
        found = known.get(function)
        if found is None:
            number = given.get(level, -1)
            if number in self._values:
                found = self._substitute(self._below[function][self._values[number]], given, deepest, known)
            else:
                below = tuple([self._substitute(part, given, deepest, known) for part in self._below[function]])
                if number < 0 and all(self._levels[part] > level for part in below):
                    found = self._node(level, below)
                else:
                    found = self.select(self._literal(level) if number < 0 else number, below)
            self._remember(known, function, found)
        return found

    def assign(self, where: Function, values: Mapping[int, int], function: Function, otherwise: Function) -> Function:
        """Where a predicate holds, `function` with `values` for some of its variables; elsewhere `otherwise`."""
        given = {self.level_of[variable]: value for variable, value in values.items()}
        everywhere = self._substitution({variable: self.constant(value) for variable, value in values.items()})
        known: dict[tuple[Function, Function, Function], Function] = {}

        def visit(where: Function, function: Function, otherwise: Function) -> Function:
            if where == FALSE:
                return otherwise
            if where == TRUE:
                return self._substitute(function, *everywhere)
            while self._levels[function] in given:
                function = self._below[function][given[self._levels[function]]]
            key = (where, function, otherwise)
            found = known.get(key)
            if found is None:
                level = min([self._levels[each] for each in key])
                parts = zip(*[self._split(each, level) for each in key], strict=True)
                found = self._node(level, tuple([visit(*part) for part in parts]))
                self._remember(known, key, found)
            return found

        return visit(where, function, otherwise)

    def combine_all(self, operation: Callable[[int, int], int], functions: Sequence[Function]) -> Function:
        """All of these functions, of which there are some, by an operation that is associative: neighbours first."""
        while len(functions) > 1:
            pairs = zip(functions[::2], functions[1::2], strict=False)
            functions = [*(self.combine(operation, *pair) for pair in pairs), *functions[len(functions) & ~1 :]]
        return functions[0]

    def all_of(self, functions: Iterable[Function]) -> Function:
        """All of these predicates."""
        found = TRUE
        for each in functions:
            found = self.select(min(found, each), (FALSE, max(found, each)))
        return found

    def any_of(self, functions: Iterable[Function]) -> Function:
        """One of these predicates at least."""
        found = FALSE
        for each in functions:
            found = self.select(min(found, each), (max(found, each), TRUE))
        return found

    def negation(self, function: Function) -> Function:
        """Not this predicate."""
        return self.select(function, (TRUE, FALSE))

    def without(self, one: Function, other: Function) -> Function:
        """`one` and not `other`."""
        return self.select(other, (one, FALSE))

    def taken(self, diagram: Diagram[Leaf], value: Callable[[Leaf], int]) -> list[Function]:
        """The functions of a diagram of the policy, by reference; `value` gives its leaves as integers."""
        found = [self.constant(value(leaf)) for leaf in diagram.leaves]
        for level, below in diagram.nodes:
            found.append(self.by_value(diagram.order[level], [found[each] for each in below]))
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

    def parts(self, function: Function) -> dict[int, Function]:
        """Where a function has which of its values, in ascending order."""
        known: dict[Function, dict[int, Function]] = {}

        def visit(here: Function) -> dict[int, Function]:
            if here in self._values:
                return {self._values[here]: TRUE}
            if here not in known:
                below = [visit(part) for part in self._below[here]]
                found = {
                    value: self._node(self._levels[here], tuple([part.get(value, FALSE) for part in below]))
                    for value in sorted(set[int]().union(*below))
                }
                self._remember(known, here, found)
            return known[here]

        return visit(function)

    def given(self, function: Function, leaf: Callable[[int], Part], node: Callable[[int, list[Part]], Part]) -> Part:
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

    def _literal(self, level: int) -> Function:
        return self._node(level, tuple(self.constant(value) for value in range(self.sizes[level])))

    def _split(self, function: Function, level: int) -> Iterable[Function]:
        """What is left of a function for every value of the variable at `level`, its first one or one above."""
        return self._below[function] if self._levels[function] == level else (function,) * self.sizes[level]

    def _node(self, level: int, below: tuple[Function, ...]) -> Function:
        return below[0] if below.count(below[0]) == len(below) else self._make(level, below)

    def _make(self, level: int, below: tuple[Function, ...]) -> Function:
        found = self._known.setdefault((level, below), len(self._levels))
        if found == len(self._levels):
            self._levels.append(level)
            self._below.append(below)
        return found

    def _remember(self, known: dict[Key, Found], key: Key, found: Found) -> None:
        known[key] = found
        self.remembered += 1
        if self.is_full:
            raise FullError(TOO_LARGE)
        if self.remembered % 1024 == 0:
            self.check_time()
