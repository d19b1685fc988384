"""Sets of states as diagrams, with the operations on them: plain Python, no engine."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import prod
from typing import TypeAlias

from tumato_symbolic.diagrams.diagram import Diagram, Leaf, Reference, UniqueTable, rebuild
from tumato_symbolic.diagrams.recursion import room_for

NOTHING: Reference = 0
"""The empty set."""

EVERYTHING: Reference = 1
"""The set of all states."""

LEAVES = {False: NOTHING, True: EVERYTHING}

MOST_ENDS = 10_000
"""So many values that the last variables may have together are listed once for every set that they end."""

Cube: TypeAlias = tuple[tuple[int, tuple[int, ...]], ...]
"""The states in which the variables at some levels have one of some values: `(level, values)`, all ascending."""


class Sets(UniqueTable):
    """Sets over variables in a fixed order. A set is a reference; equal sets have equal references.

    `sizes` counts the values of every variable; variables that are missing in `order` are never tested. With more
    `leaves` than `NOTHING` and `EVERYTHING`, references are functions of the state too; a set chooses between them.
    """

    def __init__(self, order: Sequence[int], sizes: Sequence[int], leaves: int = 2) -> None:
        super().__init__(leaves, len(order))
        self.order = tuple(order)
        self.sizes = tuple(sizes[variable] for variable in self.order)
        self._untested = prod(sizes) // prod(self.sizes)
        self._depth = len(self.order)
        self._chosen: dict[tuple[Reference, Reference, Reference], Reference] = {}
        self._counts: dict[Reference, int] = {NOTHING: 0, EVERYTHING: 1}

    def take(
        self, diagram: Diagram[Leaf], roots: Iterable[Reference], leaves: Mapping[Leaf, Reference]
    ) -> list[Reference]:
        """What the `roots` of a diagram, which has this order, denote; `leaves` maps its leaves to those here."""
        done = [leaves[leaf] for leaf in diagram.leaves]
        for level, below in diagram.nodes:
            done.append(self.node(level, tuple([done[child] for child in below])))
        return [done[root] for root in roots]

    def give(self, roots: Sequence[Reference], leaves: Sequence[Leaf]) -> tuple[Diagram[Leaf], tuple[Reference, ...]]:
        """A canonical diagram of functions; `leaves` are what the references from 2 on stand for."""
        nodes = self.nodes_from(2 + len(leaves))
        moved = [(level, tuple([child - 2 for child in below])) for level, below in nodes]
        diagram = Diagram(self.order, tuple(leaves), tuple(moved))
        return rebuild(diagram, [root - 2 for root in roots])

    def nodes(self, roots: Iterable[Reference]) -> int:
        """How many nodes the functions of these references have together."""
        seen, pending, count = set[Reference](), list(roots), 0
        while pending:
            here = pending.pop()
            if here not in seen:
                seen.add(here)
                count += not self.is_leaf(here)
                pending += self._below[here]
        return count

    def as_diagram(self, sets: Sequence[Reference]) -> tuple[Diagram[bool], tuple[Reference, ...]]:
        """A canonical diagram of sets, which has the leaf True in their states."""
        return rebuild(Diagram(self.order, (False, True), tuple(self.nodes_from(2))), sets)

    def is_leaf(self, function: Reference) -> bool:
        """Whether a function is the same in every state."""
        return self._levels[function] == self._depth

    def top(self, *sets: Reference) -> int:
        """The first level that one of the sets tests."""
        return min(map(self._levels.__getitem__, sets))

    def below(self, level: int, states: Reference) -> tuple[Reference, ...]:
        """What a set becomes for each value of the variable at `level`, its first or one before it."""
        return self._below[states] if self._levels[states] == level else (states,) * self.sizes[level]

    def choose(self, condition: Reference, then: Reference, otherwise: Reference) -> Reference:
        """The states of `then` in `condition`, and those of `otherwise` outside."""
        if condition == EVERYTHING or then == otherwise:
            return then
        if condition == NOTHING:
            return otherwise
        if then == EVERYTHING and otherwise == NOTHING:
            return condition
        key = (condition, then, otherwise)
        found = self._chosen.get(key)
        if found is None:
            levels = self._levels
            level = min(levels[condition], levels[then], levels[otherwise])
            each = zip(self.below(level, condition), self.below(level, then), self.below(level, otherwise), strict=True)
            found = self._chosen[key] = self.node(level, tuple([self.choose(c, t, o) for c, t, o in each]))
        return found

    def both(self, first: Reference, second: Reference) -> Reference:
        """Intersection."""
        return self.choose(first, second, NOTHING)

    def either(self, first: Reference, second: Reference) -> Reference:
        """Union."""
        return self.choose(first, EVERYTHING, second)

    def without(self, states: Reference, removed: Reference) -> Reference:
        """Difference."""
        return self.choose(removed, NOTHING, states)

    def cube(self, cube: Cube) -> Reference:
        """A cube as a set."""
        found = EVERYTHING
        for level, values in reversed(cube):
            found = self.node(level, tuple([found if v in values else NOTHING for v in range(self.sizes[level])]))
        return found

    def contains(self, states: Reference, cube: Cube) -> bool:
        """Whether all of a cube is in a set."""
        wanted = dict(cube)
        pending, seen = [states], {states}
        while pending:
            here = pending.pop()
            if here == NOTHING:
                return False
            level, below = self._levels[here], self._below[here]
            for value in wanted.get(level, range(len(below))):
                if below[value] not in seen:
                    seen.add(below[value])
                    pending.append(below[value])
        return True

    def states(self, states: Reference) -> Iterator[tuple[int, ...]]:
        """Every state of a set, with a value for every level; in no order that means anything."""
        middle = self._depth
        while middle and prod(self.sizes[middle - 1 :]) <= MOST_ENDS:
            middle -= 1
        ends: dict[Reference, list[tuple[int, ...]]] = {}
        for begun, rest in self._from(0, states, middle):
            if rest not in ends:
                ends[rest] = [end for end, _ in self._from(middle, rest, self._depth)]
            for end in ends[rest]:
                yield begun + end

    def _from(self, level: int, states: Reference, end: int) -> Iterator[tuple[tuple[int, ...], Reference]]:
        """The values from one level to another that lead on to states of a set, and what is left of it after them."""
        pending: list[tuple[Reference, tuple[int, ...]]] = [] if states == NOTHING else [(states, ())]
        while pending:
            rest, values = pending.pop()
            here = level + len(values)
            if here == end:
                yield values, rest
            else:
                parts = enumerate(self.below(here, rest))
                pending += [(part, (*values, value)) for value, part in parts if part != NOTHING]

    def tested(self, states: Reference) -> dict[int, set[int]]:
        """For every level that a set tests somewhere, the values that lead on to some of its states."""
        found: dict[int, set[int]] = {}
        pending, seen = [states], {states}
        while pending:
            here = pending.pop()
            for value, below in enumerate(self._below[here]):
                if below != NOTHING:
                    found.setdefault(self._levels[here], set()).add(value)
                    if below not in seen:
                        seen.add(below)
                        pending.append(below)
        return found

    def count(self, states: Reference) -> int:
        """How many states a set has, exactly."""
        with room_for(self._depth):
            return self._count(states) * prod(self.sizes[: self._levels[states]]) * self._untested

    def _count(self, states: Reference) -> int:
        """How often the variables from a set's first level on can be given values so that the state is in it."""
        found = self._counts.get(states)
        if found is None:
            level = self._levels[states] + 1
            below = self._below[states]
            found = 0
            for child in below:
                found += self._count(child) * prod(self.sizes[level : self._levels[child]])
            self._counts[states] = found
        return found
