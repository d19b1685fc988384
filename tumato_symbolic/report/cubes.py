"""Cubes of states, for a person and a program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from tumato_symbolic.diagnostics.cubes import NamedCube, named_cube_text
from tumato_symbolic.spec import Spec, Value, value_of

StateCube: TypeAlias = Sequence[Sequence[int]]
"""For every variable the values that it may have, ascending; all of them where it does not matter."""


def cube_text(spec: Spec, cube: StateCube, between: str = ", ") -> str:
    """`S_Location in {corridor, charger}, S_Conveyor is on`; with another word `between` the variables."""
    named = (
        (variable.name, [variable.values[value] for value in values])
        for variable, values in zip(spec.variables, cube, strict=True)
    )
    known = {variable.name: variable.values for variable in spec.variables}
    return named_cube_text(known, named, between) or "every valid state"


def cube_json(spec: Spec, cube: StateCube) -> dict[str, list[Value]]:
    """The values that each variable may have; a variable that is not there may have any."""
    return named_json(
        (variable.name, [variable.values[value] for value in values])
        for variable, values in zip(spec.variables, cube, strict=True)
        if len(values) < len(variable.values)
    )


def named_json(cube: NamedCube) -> dict[str, list[Value]]:
    """The same by names."""
    return {name: [value_of(value) for value in values] for name, values in cube}
