"""Cubes of states, for a person and a program."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec import Spec, Value, value_of

StateCube: TypeAlias = Sequence[Sequence[int]]
"""For every variable the values that it may have, ascending; all of them where it does not matter."""

NamedCube: TypeAlias = Iterable[tuple[str, Sequence[str]]]
"""Variables with the values that each may have, by name; of one that is not there, any."""


def cube_text(spec: Spec, cube: StateCube, between: str = ", ") -> str:
    """`S_Location in {corridor, charger}, S_Conveyor is on`; with another word `between` the variables."""
    named = (
        (variable.name, [variable.values[value] for value in values])
        for variable, values in zip(spec.variables, cube, strict=True)
    )
    known = {variable.name: variable.values for variable in spec.variables}
    return named_cube_text(known, named, between) or "every valid state"


def named_cube_text(known: Mapping[str, Sequence[str]], cube: NamedCube, between: str = ", ") -> str:
    """The same by names, empty where it says nothing; `known` are all values of each variable."""
    literals = (_literal(name, values, known[name]) for name, values in cube)
    return between.join(each for each in literals if each)


def _literal(name: str, values: Sequence[str], known: Sequence[str]) -> str:
    others = [value for value in known if value not in values]
    if len(values) == 1 and others:
        return f"{shown(name)} is {shown(values[0])}"
    if len(others) == 1:
        return f"{shown(name)} is not {shown(others[0])}"
    if others and 2 * len(others) < len(values):
        return f"{shown(name)} not in {_set(others)}"
    return f"{shown(name)} in {_set(values)}" if others else ""


def _set(values: Sequence[str]) -> str:
    return f"{{{', '.join(map(shown, values))}}}"


def shown(name: str) -> str:
    """A name out of a policy, which may be any text, as a person can read it."""
    return quoted(name)[1:-1]


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


def actions_text(actions: Sequence[str]) -> str:
    """What is done, by names: `stop, raise`, or `(nothing)`."""
    return ", ".join(map(shown, actions)) or "(nothing)"
