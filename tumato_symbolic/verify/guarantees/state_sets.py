"""Sets of states as numbers, examples and cubes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

from tumato_symbolic.diagrams import EVERYTHING, LEAVES, NOTHING, Coverer, Reference, Sets, TooManyCubes, room_for
from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_diagrams.functions import Function
from tumato_symbolic.verify.by_diagrams.walk import Walk
from tumato_symbolic.verify.guarantees.result import StateCube

MOST_CUBES = 200
"""So many cubes of a set are listed: a longer list helps no reader."""


class StateSets:
    """Sets of states, with the variables in this order."""

    def __init__(self, spec: Spec, order: Sequence[int], context: Context) -> None:
        self._sizes = [len(variable.values) for variable in spec.variables]
        self._sets = Sets(order, self._sizes)
        self._coverer = Coverer(self._sets, context)
        self._level = {variable: level for level, variable in enumerate(order)}

    def of_walk(self, walk: Walk, states: Function) -> Reference:
        """A predicate of the walk over states."""
        return walk.fold(
            states,
            lambda value: LEAVES[bool(value)],
            lambda variable, below: self._sets.node(self._level[variable], tuple(below)),
        )

    def union(self, parts: Sequence[Reference]) -> Reference:
        """All of these sets together."""
        with room_for(len(self._sizes)):
            return reduce(self._sets.either, parts, NOTHING)

    def count(self, states: Reference) -> int:
        """How many there are."""
        with room_for(len(self._sizes)):
            return self._sets.count(states)

    def first(self, states: Reference) -> State:
        """The first one as declared; there is one."""
        found = list[int]()
        with room_for(len(self._sizes)):
            for variable, size in enumerate(self._sizes):
                cubes = (self._sets.cube(((self._level[variable], (value,)),)) for value in range(size))
                parts = enumerate(self._sets.both(states, cube) for cube in cubes)
                value, states = next((value, part) for value, part in parts if part != NOTHING)
                found.append(value)
        return tuple(found)

    def cubes(self, states: Reference, valid: Reference) -> tuple[StateCube, ...] | None:
        """Cubes that hold these states, and no other valid ones; None where they are too many."""
        sets = self._sets
        with room_for(len(self._sizes)):
            others = sets.without(valid, states)
            try:
                found = self._coverer.cover(states, sets.without(EVERYTHING, others), MOST_CUBES)
            except TooManyCubes:
                return None
        listed = [{sets.order[level]: values for level, values in cube} for cube in found]
        full = [tuple(range(size)) for size in self._sizes]
        cubes = (tuple(cube.get(variable, values) for variable, values in enumerate(full)) for cube in listed)
        return tuple(sorted(cubes))
