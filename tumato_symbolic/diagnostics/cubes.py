"""Sets of states and of actions in words, by names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from tumato_symbolic.diagnostics.wording import quoted

NamedCube: TypeAlias = Iterable[tuple[str, Sequence[str]]]
"""Variables with the values that each may have, by name; of one that is not there, any."""


def named_cube_text(known: Mapping[str, Sequence[str]], cube: NamedCube, between: str = ", ") -> str:
    """`S_Location in {corridor, charger}, S_Conveyor is on`; with another word `between` the variables.

    Empty where it says nothing. `known` are all values of each variable.
    """
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


def actions_text(actions: Sequence[str]) -> str:
    """What is done, by names: `stop, raise`, or `(nothing)`."""
    return ", ".join(map(shown, actions)) or "(nothing)"
