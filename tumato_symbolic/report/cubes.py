"""Cubes of states, for a person and a program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from tumato_symbolic.spec import Spec

StateCube: TypeAlias = Sequence[Sequence[int]]
"""For every variable the values that it may have, ascending; all of them where it does not matter."""


def cube_text(spec: Spec, cube: StateCube, between: str = ", ") -> str:
    """`S_Location in {corridor, charger}, S_Conveyor is on`; with another word `between` the variables."""
    parts = []
    for variable, values in zip(spec.variables, cube, strict=True):
        others = [value for value in range(len(variable.values)) if value not in values]
        if len(values) == 1 and others:
            parts.append(f"{variable.name} is {variable.values[values[0]]}")
        elif len(others) == 1:
            parts.append(f"{variable.name} is not {variable.values[others[0]]}")
        elif others:
            parts.append(f"{variable.name} in {{{', '.join(variable.values[value] for value in values)}}}")
    return between.join(parts) or "every valid state"


def cube_json(spec: Spec, cube: StateCube) -> dict[str, list[str]]:
    """The values that each variable may have; a variable that is not there may have any."""
    return {
        variable.name: [variable.values[value] for value in values]
        for variable, values in zip(spec.variables, cube, strict=True)
        if len(values) < len(variable.values)
    }
