"""What an assumption takes from the environment: values of variables that no action controls."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from msgspec import Struct

from tumato_symbolic.explain.cubes import StateCube, disjoint_cubes
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.symbolic import Bdd

MOST_CUBES = 2
"""A condition of more cubes is not told."""


class Restriction(Struct, frozen=True):
    """Values that an assumption takes from a variable that no action controls.

    `never` are those that it takes away everywhere, `only` is the value that is left where that is a single one. The
    `partly` are taken away in some states: those of the cubes, where these are few.
    """

    variable: int
    never: tuple[int, ...]
    only: int | None
    partly: tuple[tuple[int, tuple[StateCube, ...]], ...]


def restrictions(requirements: Requirements, states: Bdd) -> tuple[Restriction, ...]:
    """How the assumption that only these valid states occur restricts the environment, which may not keep to it.

    With starts: that only these of them do.
    A value is taken away in a state that is left out although the environment, changing alone, leads into it.
    """
    variables = sorted(requirements.spec.environment)
    found = [each for variable in variables if (each := _restriction(requirements, states, variable, (variable,)))]
    if not found:
        found = [each for variable in variables if (each := _restriction(requirements, states, variable, variables))]
    return tuple(found)


def _restriction(
    requirements: Requirements, states: Bdd, variable: int, changing: tuple[int, ...] | list[int]
) -> Restriction | None:
    """What is taken from one variable when some of them may change at once."""
    encoding, manager, false = requirements.encoding, requirements.manager, requirements.false
    bits = chain.from_iterable(encoding.state_bits[each] for each in changing)
    taken = manager.exists(bits, states) & requirements.starts & ~states
    if taken == false:
        return None
    never, partly, left = [], [], []
    for value in range(len(requirements.spec.variables[variable].values)):
        here = encoding.value(variable, value)
        if (requirements.starts & here) == false:
            continue
        if (states & here) == false:
            never.append(value)
            continue
        left.append(value)
        if (taken & here) != false:
            partly.append((value, tuple(_conditions(requirements, taken & here, variable))))
    return Restriction(variable, tuple(never), left[0] if len(left) == 1 else None, tuple(partly))


def _conditions(requirements: Requirements, states: Bdd, variable: int) -> Iterator[StateCube]:
    """The cubes of some states, without what they say of one variable; none where there are too many."""
    encoding = requirements.encoding
    cover = disjoint_cubes(encoding, states, encoding.domain() & ~requirements.valid, MOST_CUBES)
    if cover.rest == requirements.false:
        every = tuple(range(len(requirements.spec.variables[variable].values)))
        yield from ((*cube[:variable], every, *cube[variable + 1 :]) for cube in cover.cubes)
