"""The door to dd."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise

import pytest

from tumato_symbolic.symbolic import Backend, Manager, TooManyNodesError, available_backend

NODES_OF_A_CHAIN = 15
"""Of `bᵢ₊₁ → bᵢ` for eight bits."""

BACKENDS: list[Backend] = sorted({"autoref", available_backend()})


@pytest.mark.parametrize("backend", BACKENDS)
def test_counts_are_exact_beyond_machine_words(backend: Backend) -> None:
    """A set over 200 bits has exactly as many members as it has, which no float can hold."""
    bits = [f"b{number}" for number in range(200)]
    manager = Manager(bits, backend)
    assert manager.count(manager.true, bits) == 2**200
    assert manager.count(~manager.cube(dict.fromkeys(bits, True)), bits) == 2**200 - 1
    assert manager.count(manager.cube({"b7": True, "b150": False}), bits) == 2**198
    assert manager.count(manager.false, bits) == 0


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_union_is_that_of_all_its_parts(backend: Backend) -> None:
    """Two by two it has what it has one after the other, however many there are, none included."""
    manager = Manager([f"b{number}" for number in range(4)], backend)
    one_by_one = manager.false
    for size in range(10):
        values = ({f"b{place}": bool(number >> place & 1) for place in range(4)} for number in range(size))
        assert manager.balanced_union(map(manager.cube, values)) == one_by_one
        one_by_one = one_by_one | manager.cube({f"b{place}": bool(size >> place & 1) for place in range(4)})


def test_networkx_is_loaded_only_when_dd_draws() -> None:
    """Importing the engine leaves networkx alone, and dd's drawings still find it."""
    program = """
import sys
from itertools import pairwise
from tumato_symbolic.symbolic import available_backend
available_backend()
assert "networkx" not in sys.modules
import dd.bdd
engine = dd.bdd.BDD()
engine.add_var("x")
assert len(dd.bdd.to_nx(engine, {engine.var("x")})) == 2
"""
    subprocess.run([sys.executable, "-c", program], check=True)


@pytest.mark.parametrize("backend", BACKENDS)
def test_large_diagrams_are_refused_where_that_is_asked(backend: Backend) -> None:
    """A diagram with more nodes than allowed is refused, alike on both backends, and only where there is a limit."""
    bits = [f"b{number}" for number in range(8)]
    manager = Manager(bits, backend)
    pairs = [manager.cube({one: True}) | ~manager.cube({other: True}) for one, other in pairwise(bits)]
    found = manager.intersection(pairs)
    nodes = manager.nodes(found)
    assert manager.bounded(found) == found
    with manager.at_most(nodes):
        assert manager.bounded(found) == found
    refused = False
    with manager.at_most(nodes - 1):
        try:  # `pytest.raises` would keep what the frames hold
            manager.intersection(pairs)
        except TooManyNodesError:
            refused = True
    assert refused
    assert nodes == NODES_OF_A_CHAIN
