"""Smaller diagrams for functions that matter in some states only."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagrams.diagram import Diagram, Leaf, Reference, rebuild
from tumato_symbolic.diagrams.recursion import room_for
from tumato_symbolic.diagrams.sets import EVERYTHING, LEAVES, NOTHING, Sets

MOST_MERGED = 30_000
"""Nodes of a diagram: in a larger one values with compatible rests do not share one."""


def smallest(
    diagram: Diagram[Leaf],
    roots: Sequence[Reference],
    sizes: Sequence[int],
    states: tuple[Diagram[bool], Reference],
    fixed: Sequence[Reference] = (),
) -> tuple[Diagram[Leaf], tuple[Reference, ...]]:
    """`fixed`, and functions that equal those of `roots` in `states`: of three diagrams the one with fewest nodes.

    Of two where the diagram is large: merging would take longer than all that the diagram is for.
    """
    with room_for(len(diagram.order)):
        sets = Sets(diagram.order, sizes, 2 + len(diagram.leaves))
        (needed,) = sets.take(states[0], states[1:], LEAVES)
        if needed in (NOTHING, EVERYTHING):
            return rebuild(diagram, (*fixed, *roots))
        leaves = {leaf: number for number, leaf in enumerate(diagram.leaves, 2)}
        exact, functions = sets.take(diagram, fixed, leaves), sets.take(diagram, roots, leaves)
        found = [functions]
        for merging in (False, True) if len(diagram.nodes) <= MOST_MERGED else (False,):
            ours = _Minimizer(sets, merging)
            found.append([ours.simplest(each, needed) for each in functions])
        fewest = min(found, key=lambda each: sets.nodes([*exact, *each]))
        return sets.give([*exact, *fewest], diagram.leaves)


class _Minimizer:
    """The method of Coudert and Madre (*restrict*, 1990); `merging` lets values with compatible rests share one."""

    def __init__(self, sets: Sets, merging: bool) -> None:
        self._sets = sets
        self._merging = merging
        self._known: dict[tuple[Reference, Reference], Reference] = {}
        self._agreeing: dict[tuple[Reference, Reference, Reference], bool] = {}

    def simplest(self, function: Reference, needed: Reference) -> Reference:
        """A function that equals `function` in the states of `needed`, of which there are some."""
        if needed == EVERYTHING or self._sets.is_leaf(function):
            return function
        key = (function, needed)
        if key not in self._known:
            self._known[key] = self._simplest(function, needed)
        return self._known[key]

    def _simplest(self, function: Reference, needed: Reference) -> Reference:
        sets = self._sets
        level = sets.top(function, needed)
        wanted = sets.below(level, needed)
        if level < sets.top(function):
            every = NOTHING
            for part in wanted:
                every = sets.either(every, part)
            return self.simplest(function, every)
        rests = list(zip(sets.below(level, function), wanted, strict=True))
        if not self._merging:
            some = next(self.simplest(*rest) for rest in rests if rest[1] != NOTHING)
            return sets.node(level, tuple([some if part[1] == NOTHING else self.simplest(*part) for part in rests]))
        groups: list[tuple[Reference, Reference]] = []
        member = [self._join(groups, rest) for rest in rests]
        done = [self.simplest(function, needed) for function, needed in groups]
        return sets.node(level, tuple([done[place] for place in member]))

    def _join(self, groups: list[tuple[Reference, Reference]], rest: tuple[Reference, Reference]) -> int:
        """Put what is left for one value into a group that it agrees with; a new one where there is none."""
        sets = self._sets
        function, needed = rest
        for place, (theirs, where) in enumerate(groups):
            if needed == NOTHING:
                return place
            if where == NOTHING:
                groups[place] = rest
                return place
            if rest == groups[place] or self._agree(function, theirs, sets.both(needed, where)):
                groups[place] = sets.choose(needed, function, theirs), sets.either(needed, where)
                return place
        groups.append(rest)
        return len(groups) - 1

    def _agree(self, first: Reference, second: Reference, where: Reference) -> bool:
        sets = self._sets
        if first == second or where == NOTHING:
            return True
        if sets.is_leaf(first) and sets.is_leaf(second):
            return False
        key = (first, second, where)
        found = self._agreeing.get(key)
        if found is None:
            level = sets.top(first, second, where)
            found = True
            for a, b, care in zip(*(sets.below(level, each) for each in key), strict=True):
                if not self._agree(a, b, care):
                    found = False
                    break
            self._agreeing[key] = found
        return found
