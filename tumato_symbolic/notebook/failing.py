"""States in which something fails, as the output of a cell: in groups, by names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import prod
from typing import TypeAlias

from tumato_symbolic.diagnostics.cubes import named_cube_text
from tumato_symbolic.notebook.markup import table
from tumato_symbolic.semantics import State, state_text
from tumato_symbolic.spec import Spec

_MOST_STATES = 2_000
"""So many states of a kind are put into groups; of more, the first ones."""

_MOST_GROUPS = 8
"""So many groups of states are shown, the largest first."""

_Cube: TypeAlias = tuple[tuple[int, ...], ...]


def failing_html(spec: Spec, kinds: Iterable[tuple[str, int, Sequence[State]]]) -> str:
    """What is said of states, how many these are, and which: in few groups, with one of them."""
    rows = list[tuple[str, str, str]]()
    for said, count, states in kinds:
        cubes = sorted(merged(states[:_MOST_STATES]), key=lambda cube: -_size(cube))[:_MOST_GROUPS]
        found = [(f"{_size(cube):,}", _text(spec, cube)) for cube in cubes]
        left = count - sum(map(_size, cubes))
        found += [(f"{left:,}", "others")] if left else []
        found.append(("", f"for example {state_text(spec, states[0])}"))
        rows += [("" if number else said, *row) for number, row in enumerate(found)]
    return table(("", "states", "where"), rows)


def merged(states: Iterable[State]) -> list[_Cube]:
    """Disjoint cubes that hold exactly these states: those that differ in one variable become one."""
    cubes: list[_Cube] = [tuple((value,) for value in state) for state in dict.fromkeys(states)]
    before = None
    while before != len(cubes):
        before = len(cubes)
        for variable in range(len(cubes[0]) if cubes else 0):
            alike = dict[_Cube, list[int]]()
            for cube in cubes:
                alike.setdefault((*cube[:variable], *cube[variable + 1 :]), []).extend(cube[variable])
            cubes = [
                (*others[:variable], tuple(sorted(values)), *others[variable:]) for others, values in alike.items()
            ]
    return cubes


def _size(cube: _Cube) -> int:
    return prod(map(len, cube))


def _text(spec: Spec, cube: _Cube) -> str:
    known = {variable.name: variable.values for variable in spec.variables}
    named = (
        (variable.name, [variable.values[value] for value in values])
        for variable, values in zip(spec.variables, cube, strict=True)
    )
    return named_cube_text(known, named, " AND ") or "everywhere"
