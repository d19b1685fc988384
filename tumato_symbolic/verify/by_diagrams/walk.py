"""The walk: operations on functions as ordered diagrams, so that a proof is a comparison.

The functions are those of `functions.py`. A violation is impossible exactly when it is `FALSE`. All that is computed
comes from five walks over diagrams, each remembering what it has done: `select` (cases), `apply` (any operation on two
functions), `compose` (functions for variables; an effect is a constant for each variable that it writes),
`cofactor_where` (values for variables where a predicate holds) and `holds_where` (whether what that gives compares).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TypeAlias

from tumato_symbolic.diagrams import Diagram, Leaf, conjoin
from tumato_symbolic.verify.by_diagrams.functions import FALSE, MOST_STEPS, TRUE, Function, Functions

Composition: TypeAlias = tuple[tuple[int, Function], ...]
"""Functions for variables, sorted by variable; every other variable stays."""

Values: TypeAlias = tuple[tuple[int, int], ...]
Triple: TypeAlias = tuple[Function, Function, Function]

UNASKED = -1
"""What a function is where nothing is asked of it."""


class Walk(Functions):
    """Operations on functions, each of which remembers what it has done."""

    def __init__(self, order: Sequence[int], sizes: Sequence[int], most_steps: int = MOST_STEPS) -> None:
        super().__init__(order, sizes, most_steps)
        self._selected: dict[tuple[Function, tuple[Function, ...]], Function] = {}
        self._chosen: dict[Triple, Function] = {}
        self._applied: dict[Callable[[int, int], int], dict[tuple[Function, Function], Function]] = {}
        self._composed: dict[Composition, dict[Function, Function]] = {}
        self._cofactors: dict[Values, dict[Triple, Function]] = {}
        self._related: dict[tuple[Callable[[int, int], bool], Values], dict[Triple, bool]] = {}

    def make_room(self) -> None:
        """Forget results, and no functions, where half as many are remembered as may be."""
        if self.most < 2 * self.remembered and 2 * len(self._levels) < self.most:
            self._selected.clear()
            self._chosen.clear()
            self._applied.clear()
            self._composed.clear()
            self._cofactors.clear()
            self._related.clear()
            self.remembered = 0

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
        if len(cases) == 2:
            return self._either(number, cases[0], cases[1])
        cases = tuple(cases)
        if number in self._values:
            return cases[self._values[number]]
        if cases.count(cases[0]) == len(cases):
            return cases[0]
        key = (number, cases)
        found = self._selected.get(key)
        if found is None:
            level = min([self._levels[each] for each in (number, *cases)])
            parts = zip(*[self._split(each, level) for each in cases], strict=True)
            below = zip(self._split(number, level), parts, strict=True)
            found = self._node(level, tuple([self.select(part, rest) for part, rest in below]))
            self._remember(self._selected, key, found)
        return found

    def _either(self, which: Function, zero: Function, one: Function) -> Function:
        """`select` of two cases, which most are."""
        if which == FALSE or zero == one:
            return zero
        if which == TRUE:
            return one
        if zero == FALSE and one == TRUE:
            return which
        key = (which, zero, one)
        found = self._chosen.get(key)
        if found is None:
            levels, below = self._levels, self._below
            first, second, third = levels[which], levels[zero], levels[one]
            level = min(first, second, third)
            size = self.sizes[level]
            parts = zip(
                below[which] if first == level else (which,) * size,
                below[zero] if second == level else (zero,) * size,
                below[one] if third == level else (one,) * size,
                strict=True,
            )
            found = self._node(level, tuple([self._either(*part) for part in parts]))
            self._remember(self._chosen, key, found)
        return found

    def apply(self, operation: Callable[[int, int], int], one: Function, other: Function) -> Function:
        """The function `operation(one, other)`."""
        return self._apply(operation, self._applied.setdefault(operation, {}), one, other)

    def _apply(
        self,
        operation: Callable[[int, int], int],
        known: dict[tuple[Function, Function], Function],
        one: Function,
        other: Function,
    ) -> Function:
        key = (one, other)
        found = known.get(key)
        if found is None:
            first, second = self._levels[one], self._levels[other]
            level = min(first, second)
            if level == self._bottom:
                return self.constant(operation(self._values[one], self._values[other]))
            pairs = zip(
                self._below[one] if first == level else (one,) * self.sizes[level],
                self._below[other] if second == level else (other,) * self.sizes[level],
                strict=True,
            )
            found = self._node(level, tuple([self._apply(operation, known, *pair) for pair in pairs]))
            self._remember(known, key, found)
        return found

    def compose(self, function: Function, replacements: Mapping[int, Function]) -> Function:
        """`function` with other functions for some of its variables, all at once."""
        return self._compose(function, *self._composition(replacements))

    def _composition(
        self, replacements: Mapping[int, Function]
    ) -> tuple[dict[int, Function], int, dict[Function, Function]]:
        """The replacements by level, the deepest level, and what is known of this composition."""
        by_level = {self.level_of[variable]: replacement for variable, replacement in replacements.items()}
        return by_level, max(by_level, default=-1), self._composed.setdefault(tuple(sorted(replacements.items())), {})

    def _compose(
        self, function: Function, replacements: Mapping[int, Function], deepest: int, known: dict[Function, Function]
    ) -> Function:
        level = self._levels[function]
        if level > deepest:
            return function
        found = known.get(function)
        if found is None:
            number = replacements.get(level, -1)
            if number in self._values:
                found = self._compose(self._below[function][self._values[number]], replacements, deepest, known)
            else:
                below = tuple([self._compose(part, replacements, deepest, known) for part in self._below[function]])
                if number < 0 and all(self._levels[part] > level for part in below):
                    found = self._node(level, below)
                else:
                    found = self.select(self._literal(level) if number < 0 else number, below)
            self._remember(known, function, found)
        return found

    def cofactor_where(
        self, where: Function, values: Mapping[int, int], function: Function, otherwise: Function
    ) -> Function:
        """Where a predicate holds, `function` with `values` for some of its variables; elsewhere `otherwise`."""
        fixed = {self.level_of[variable]: value for variable, value in values.items()}
        everywhere = self._composition({variable: self.constant(value) for variable, value in values.items()})
        known = self._cofactors.setdefault(tuple(sorted(values.items())), {})
        levels, below = self._levels, self._below

        def visit(where: Function, function: Function, otherwise: Function) -> Function:
            if where == FALSE:
                return otherwise
            if where == TRUE:
                return self._compose(function, *everywhere)
            while levels[function] in fixed:
                function = below[function][fixed[levels[function]]]
            key = (where, function, otherwise)
            found = known.get(key)
            if found is None:
                first, second, third = levels[where], levels[function], levels[otherwise]
                level = min(first, second, third)
                size = self.sizes[level]
                parts = zip(
                    below[where] if first == level else (where,) * size,
                    below[function] if second == level else (function,) * size,
                    below[otherwise] if third == level else (otherwise,) * size,
                    strict=True,
                )
                found = self._node(level, tuple([visit(*part) for part in parts]))
                self._remember(known, key, found)
            return found

        return visit(where, function, otherwise)

    def holds_where(
        self,
        where: Function,
        values: Mapping[int, int],
        relation: Callable[[int, int], bool],
        function: Function,
        other: Function,
    ) -> bool:
        """Whether where a predicate holds, `function` with `values` for some of its variables relates to `other`.

        Nothing is asked where `other` is `UNASKED`.
        """
        fixed = {self.level_of[variable]: value for variable, value in values.items()}
        deepest, unasked = max(fixed, default=-1), self.constant(UNASKED)
        known = self._related.setdefault((relation, tuple(sorted(values.items()))), {})
        with_any_values = self._related.setdefault((relation, ()), {})
        levels, below = self._levels, self._below

        def visit(where: Function, function: Function, other: Function) -> bool:
            while levels[function] in fixed:
                function = below[function][fixed[levels[function]]]
            key = (where, function, other)
            first, second, third = levels[where], levels[function], levels[other]
            remembered = known if second <= deepest else with_any_values
            found = remembered.get(key)
            if found is None:
                level = min(first, second, third)
                if level == self._bottom:
                    return relation(self._values[function], self._values[other])
                size = self.sizes[level]
                parts = zip(
                    below[where] if first == level else (where,) * size,
                    below[function] if second == level else (function,) * size,
                    below[other] if third == level else (other,) * size,
                    strict=True,
                )
                asked = [part for part in parts if part[0] != FALSE and part[2] != unasked]
                found = all(visit(*part) for part in asked)
                self._remember(remembered, key, found)
            return found

        return where == FALSE or other == unasked or visit(where, function, other)

    def within(self, care: Function, function: Function) -> Function:
        """A function that is `function` where `care` holds, and elsewhere whatever makes it small."""
        known: dict[tuple[Function, Function], Function] = {}

        def visit(care: Function, function: Function) -> Function:
            if care == TRUE or function in self._values:
                return function
            key = (care, function)
            found = known.get(key)
            if found is None:
                level = self._levels[function]
                if self._levels[care] < level:
                    found = visit(self.any_of(dict.fromkeys(self._below[care])), function)
                else:
                    pairs = list(zip(self._split(care, level), self._below[function], strict=True))
                    parts = [None if part == FALSE else visit(part, rest) for part, rest in pairs]
                    some = next(part for part in parts if part is not None)
                    found = self._node(level, tuple([some if part is None else part for part in parts]))
                self._remember(known, key, found)
            return found

        return function if care == FALSE else visit(care, function)

    def apply_all(self, operation: Callable[[int, int], int], functions: Sequence[Function]) -> Function:
        """All of these functions, of which there are some, by an operation that is associative: neighbours first."""
        while len(functions) > 1:
            pairs = zip(functions[::2], functions[1::2], strict=False)
            functions = [*(self.apply(operation, *pair) for pair in pairs), *functions[len(functions) & ~1 :]]
        return functions[0]

    def all_of(self, functions: Iterable[Function]) -> Function:
        """All of these predicates."""
        return conjoin(functions, self.levels_of, self._both, TRUE)

    def _both(self, one: Function, other: Function) -> Function:
        return self.select(min(one, other), (FALSE, max(one, other)))

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

    def import_diagram(self, diagram: Diagram[Leaf], value: Callable[[Leaf], int]) -> list[Function]:
        """The functions of a diagram of the policy, by reference; `value` gives its leaves as integers."""
        found = [self.constant(value(leaf)) for leaf in diagram.leaves]
        for level, below in diagram.nodes:
            found.append(self.by_value(diagram.order[level], [found[each] for each in below]))
        return found

    def _literal(self, level: int) -> Function:
        return self._node(level, tuple(self.constant(value) for value in range(self.sizes[level])))
