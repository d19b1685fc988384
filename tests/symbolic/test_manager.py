"""The door to dd."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tumato_symbolic.symbolic import Backend, Manager, available_backend

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


def test_networkx_is_loaded_only_when_dd_draws() -> None:
    """Importing the engine leaves networkx alone, and dd's drawings still find it."""
    program = """
import sys
from tumato_symbolic.symbolic import available_backend
available_backend()
assert "networkx" not in sys.modules
import dd.bdd
engine = dd.bdd.BDD()
engine.add_var("x")
assert len(dd.bdd.to_nx(engine, {engine.var("x")})) == 2
"""
    subprocess.run([sys.executable, "-c", program], check=True)
