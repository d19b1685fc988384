"""Sets of states as few cubes: an irredundant cover between two bounds.

The method is that of Minato and Morreale (S. Minato, *Fast generation of irredundant sum-of-products forms*, 1992),
for variables with many values: a cube may name several values of one variable.
"""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.diagrams.diagram import Reference
from tumato_symbolic.diagrams.sets import EVERYTHING, NOTHING, Cube, Sets
from tumato_symbolic.limits import Context

MOST_CUBES = 2_000
"""Covers of more cubes are given up, unless another limit is asked for."""


class TooManyCubes(Exception):  # noqa: N818 - no error: some sets have no short cover
    """A cover was given up."""


class Coverer:
    """Finds covers, and remembers those of parts."""

    def __init__(self, sets: Sets, context: Context | None = None) -> None:
        self._sets = sets
        self._context = context or Context()
        self._limit = MOST_CUBES
        self._known: dict[tuple[Reference, Reference], tuple[tuple[Cube, ...], Reference]] = {}

    def cover(self, wanted: Reference, permitted: Reference, limit: int = MOST_CUBES) -> tuple[Cube, ...]:
        """Cubes that hold all of `wanted`, and nothing that is not `permitted`; none of them can be left out.

        Raises `TooManyCubes` where a first cover, which is improved later, has more than `limit`.
        """
        self._limit = limit
        cubes = [self._widened(cube, permitted) for cube in self._between(wanted, permitted)[0]]
        return self._narrowed(self._needed(cubes, wanted), wanted)

    def _between(self, wanted: Reference, permitted: Reference) -> tuple[tuple[Cube, ...], Reference]:
        """The cubes and their union. `wanted` is a part of `permitted`."""
        if wanted == NOTHING:
            return (), NOTHING
        if permitted == EVERYTHING:
            return ((),), EVERYTHING
        key = (wanted, permitted)
        if key not in self._known:
            self._known[key] = self._split(wanted, permitted)
        return self._known[key]

    def _split(self, wanted: Reference, permitted: Reference) -> tuple[tuple[Cube, ...], Reference]:
        """Cubes that name the first variable, for what needs them; then cubes that do not."""
        self._context.check()
        sets = self._sets
        level = sets.top(wanted, permitted)
        rest, bounds = list(sets.below(level, wanted)), sets.below(level, permitted)
        always = EVERYTHING
        for bound in bounds:
            always = sets.both(always, bound)
        cubes: list[Cube] = []
        covered = [NOTHING] * len(bounds)
        for value in range(len(bounds)):
            need = sets.without(rest[value], always)
            if need == NOTHING:
                continue
            values, bound = self._together(value, need, bounds)
            for other in values:
                missing = sets.without(rest[other], always)
                if sets.without(missing, bound) == NOTHING:
                    need = sets.either(need, missing)
            parts, union = self._between(need, bound)
            cubes += [((level, values), *part) for part in parts]
            if len(cubes) > self._limit:
                raise TooManyCubes
            for other in values:
                covered[other] = sets.either(covered[other], union)
                rest[other] = sets.without(rest[other], union)
        left = NOTHING
        for part in rest:
            left = sets.either(left, part)
        parts, union = self._between(left, always)
        both = sets.node(level, tuple([sets.either(part, union) for part in covered]))
        return (*cubes, *parts), both

    def _together(
        self, value: int, need: Reference, bounds: tuple[Reference, ...]
    ) -> tuple[tuple[int, ...], Reference]:
        """The values that may stand beside `value` in cubes that cover `need`, and what such cubes may hold."""
        values, bound = [value], bounds[value]
        for other, permitted in enumerate(bounds):
            if other != value and self._sets.without(need, permitted) == NOTHING:
                values.append(other)
                bound = self._sets.both(bound, permitted)
        return tuple(sorted(values)), bound

    def _widened(self, cube: Cube, permitted: Reference) -> Cube:
        """A cube around `cube` to which nothing can be added that is `permitted`: whole variables first."""
        self._context.check()
        contains = self._sets.contains
        for literal in reversed(cube):
            fewer = tuple([each for each in cube if each != literal])
            if contains(permitted, fewer):
                cube = fewer
        for place, (level, _) in enumerate(cube):
            for value in range(self._sets.sizes[level]):
                values = cube[place][1]
                if value not in values:
                    more = (*cube[:place], (level, tuple(sorted((*values, value)))), *cube[place + 1 :])
                    cube = more if contains(permitted, more) else cube
        return cube

    def _needed(self, cubes: list[Cube], wanted: Reference) -> tuple[Cube, ...]:
        """Those cubes without which `wanted` would not be covered, the simplest first."""
        sets = self._sets
        cubes = sorted(dict.fromkeys(cubes), key=lambda cube: (-len(cube), cube))
        later = self._later(cubes)
        kept: list[Cube] = []
        left = wanted
        for cube in cubes:
            self._context.check()
            if sets.without(left, later.pop()) != NOTHING:
                kept.append(cube)
                left = sets.without(left, sets.cube(cube))
        return tuple(reversed(kept))

    def _narrowed(self, cubes: tuple[Cube, ...], wanted: Reference) -> tuple[Cube, ...]:
        """The cubes without values that add nothing of `wanted` to the rest: what a reader expects to see."""
        sets, later = self._sets, self._later(cubes)
        done: list[Cube] = []
        left = wanted
        for cube in cubes:
            own = sets.tested(sets.both(sets.without(left, later.pop()), sets.cube(cube)))
            done.append(tuple([(level, tuple([v for v in values if v in own[level]])) for level, values in cube]))
            left = sets.without(left, sets.cube(done[-1]))
        return tuple(done)

    def _later(self, cubes: Sequence[Cube]) -> list[Reference]:
        """For every cube the union of those behind it; that of the first cube is the last entry."""
        unions = [NOTHING]
        for cube in reversed(cubes[1:]):
            unions.append(self._sets.either(unions[-1], self._sets.cube(cube)))
        return unions
