"""Moves that are looked at together."""

from __future__ import annotations

import gc
from collections.abc import Mapping
from random import Random
from weakref import ref

import pytest

from tests.generate import random_spec
from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic import Backend, Bdd, Leading, available_backend, encode
from tumato_symbolic.symbolic.layout import number_bits
from tumato_symbolic.symbolic.manager import Manager
from tumato_symbolic.symbolic.present import FEW_MOVES

BITS = (tuple(f"x{bit}" for bit in range(6)), ("y0", "y1"), ())
"""Three variables: of 64 values, of 4, and of a single one."""


def constants(written: Assignment) -> Mapping[str, bool]:
    """What is written as constants for bits."""
    return {bit: value for variable, number in written for bit, value in number_bits(BITS[variable], number).items()}


def some_set(manager: Manager, random: Random, how_many: int) -> Bdd:
    """Up to so many vectors."""
    vectors = ({bit: random.random() < 0.5 for bit in manager.bits} for _ in range(how_many))
    return manager.union(map(manager.cube, vectors))


@pytest.mark.parametrize("backend", sorted({"autoref", available_backend()}))
@pytest.mark.parametrize("seed", range(20))
def test_moves_lead_where_each_of_them_leads(backend: Backend, seed: int) -> None:
    """Taken together, moves stand for what they stand for one by one, few or many, whatever they write."""
    random = Random(seed)
    manager = Manager([bit for bits in BITS for bit in bits], backend)
    moves: list[tuple[Assignment, Bdd]] = []
    for _ in range(random.choice((1, 8, 3 * FEW_MOVES))):
        variables = [variable for variable in range(len(BITS)) if random.random() < 0.6]
        written = tuple((variable, random.randrange(1 << len(BITS[variable]))) for variable in variables)
        moves.append((written, some_set(manager, random, 20)))
    together = Leading(manager, moves, constants, often=seed % 2 == 0)
    for target in (manager.false, manager.true, some_set(manager, random, 3), some_set(manager, random, 200)):
        each = (pairs & manager.cofactor(target, constants(written)) for written, pairs in moves)
        assert together.into(target) == manager.union(each)


@pytest.mark.parametrize("backend", sorted({"autoref", available_backend()}))
@pytest.mark.parametrize("seed", range(40))
def test_moves_that_are_asked_often_lead_there_as_well(backend: Backend, seed: int) -> None:
    """A relation stands for moves that write values in place of the same one, in place of any, and for both."""
    random = Random(seed)
    manager = Manager([bit for bits in BITS for bit in bits], backend)
    moves: list[tuple[Assignment, Bdd]] = []
    for _ in range(random.choice((3, 6, 20))):
        first: Assignment = ((1, random.randrange(4)),) if random.random() < 0.5 else ()
        before = manager.cube(constants(((0, random.choice((5, 5, 5, 9)) if seed % 2 else 5),)))
        moves.append(((*first, (0, random.randrange(64))), before & some_set(manager, random, 200)))
    often = Leading(manager, moves, constants, often=True)
    for target in (manager.false, manager.true, some_set(manager, random, 3), some_set(manager, random, 200)):
        each = (pairs & manager.cofactor(target, constants(written)) for written, pairs in moves)
        assert often.into(target) == manager.union(each)


def test_an_encoding_goes_with_the_last_that_holds_it() -> None:
    """At once: diagrams that the collector of garbage finds after their manager are complained of."""
    gc.disable()
    try:
        encoding = encode(random_spec(0), available_backend())
        assert encoding.before(encoding.manager.true) != encoding.manager.false
        kept = ref(encoding.manager)
        del encoding
        assert kept() is None
    finally:
        gc.enable()
