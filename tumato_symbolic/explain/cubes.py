"""Sets of states as few cubes: what a person can read of a large set.

Greedy, largest first: a state is expanded as far as it goes, along several orders of the variables, and the cube that
covers most is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics import State
from tumato_symbolic.symbolic import Bdd, Encoding

StateCube: TypeAlias = tuple[tuple[int, ...], ...]
"""For every variable the values that it may have, ascending; all of them where it does not matter."""


class Cover(Struct, frozen=True):
    """Cubes, and what they leave uncovered where a limit was met."""

    cubes: tuple[StateCube, ...]
    rest: Bdd


def set_of(encoding: Encoding, cube: StateCube) -> Bdd:
    """The states of a cube."""
    manager = encoding.manager
    parts = [
        manager.union(encoding.value(variable, value) for value in values)
        for variable, values in enumerate(cube)
        if len(values) < len(encoding.spec.variables[variable].values)
    ]
    return encoding.domain() & manager.intersection(parts) if parts else encoding.domain()


def disjoint_cubes(encoding: Encoding, states: Bdd, indifferent: Bdd, limit: int | None = None) -> Cover:
    """Disjoint cubes that contain exactly `states` and some of `indifferent`, largest first, at most `limit`."""
    return _cover(encoding, states, encoding.domain() & ~(states | indifferent), True, limit)


def shortest_cubes(
    encoding: Encoding, states: Bdd, indifferent: Bdd, limit: int | None = None
) -> tuple[StateCube, ...] | None:
    """Cubes, which may overlap, of `states` and some of `indifferent`; none can be left out.

    None where more than `limit` cubes are looked at.
    """
    cover = _cover(encoding, states, encoding.domain() & ~(states | indifferent), False, limit)
    if cover.rest != encoding.manager.false:
        return None
    cubes = cover.cubes
    sets = [set_of(encoding, cube) for cube in cubes]
    kept = list(range(len(cubes)))
    for number in reversed(range(len(cubes))):
        others = encoding.manager.union(sets[other] for other in kept if other != number)
        if (states & sets[number] & ~others) == encoding.manager.false:
            kept.remove(number)
    return tuple(cubes[number] for number in kept)


def _cover(encoding: Encoding, states: Bdd, forbidden: Bdd, disjoint: bool, limit: int | None) -> Cover:
    false = encoding.manager.false
    cubes: list[StateCube] = []
    while states != false and (limit is None or len(cubes) < limit):
        best = max(
            _expanded(encoding, states, forbidden),
            key=lambda cube: (encoding.count_states(set_of(encoding, cube) & states), -_literals(encoding, cube)),
        )
        covered = set_of(encoding, best)
        cubes.append(best)
        states = states & ~covered
        if disjoint:
            forbidden = forbidden | covered
    return Cover(tuple(cubes), states)


def _literals(encoding: Encoding, cube: StateCube) -> int:
    return sum(len(values) < len(encoding.spec.variables[number].values) for number, values in enumerate(cube))


def _expanded(encoding: Encoding, states: Bdd, forbidden: Bdd) -> Iterator[StateCube]:
    """Maximal cubes around the first and the last state of a set, each once."""
    count = len(encoding.spec.variables)
    found: dict[StateCube, None] = {}
    for seed in dict.fromkeys((encoding.first_state(states), last_state(encoding, states))):
        freedom = [_freedom(encoding, seed, forbidden, variable) for variable in range(count)]
        freest = sorted(range(count), key=lambda variable: -freedom[variable])
        for order in (tuple(range(count)), tuple(range(count - 1, -1, -1)), tuple(freest), tuple(reversed(freest))):
            found.setdefault(expanded(encoding, seed, forbidden, order))
    yield from found


def _freedom(encoding: Encoding, seed: State, forbidden: Bdd, variable: int) -> float:
    """The part of a variable's values that it may have while the others keep those of the seed."""
    others = ((place, value) for place, value in enumerate(seed) if place != variable)
    near = encoding.manager.cofactor(forbidden, encoding.assignment_bits(tuple(others)))
    values = range(len(encoding.spec.variables[variable].values))
    free = sum((near & encoding.value(variable, value)) == encoding.manager.false for value in values)
    return free / len(values)


def last_state(encoding: Encoding, states: Bdd) -> State:
    """The last state of a non-empty set, in the order of declaration."""
    found: list[int] = []
    for variable, declared in enumerate(encoding.spec.variables):
        for value in range(len(declared.values) - 1, -1, -1):
            here = states & encoding.value(variable, value)
            if here != encoding.manager.false:
                found.append(value)
                states = here
                break
    return tuple(found)


def expanded(encoding: Encoding, seed: State, forbidden: Bdd, order: Sequence[int]) -> StateCube:
    """The largest cube around a state outside a set: one variable after another is freed as far as can be."""
    manager, spec = encoding.manager, encoding.spec
    cube: list[tuple[int, ...]] = [(value,) for value in seed]
    freed = manager.true
    for variable, blocked in zip(order, _while_later_ones_stay(encoding, seed, forbidden, order), strict=True):
        near = blocked & freed
        everything = range(len(spec.variables[variable].values))
        cube[variable] = tuple(
            value
            for value in everything
            if value == seed[variable] or (near & encoding.value(variable, value)) == manager.false
        )
        if len(cube[variable]) < len(everything):
            freed = freed & manager.union(encoding.value(variable, value) for value in cube[variable])
    return tuple(cube)


def _while_later_ones_stay(encoding: Encoding, seed: State, forbidden: Bdd, order: Sequence[int]) -> list[Bdd]:
    """For every position in `order`, what is forbidden while all later variables have the values of the seed."""
    found: list[Bdd] = []
    for variable in reversed(order):
        found.append(forbidden)
        forbidden = encoding.manager.cofactor(forbidden, encoding.assignment_bits(((variable, seed[variable]),)))
    return found[::-1]
