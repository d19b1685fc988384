"""Functions that matter in some states only are given as small diagrams, in one form whatever way was best."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Reference, rebuild, smallest

SIZES = (2, 3, 2, 3)
STATES = list(product(*map(range, SIZES)))

Table = dict[tuple[int, ...], int]


def drawn(tables: list[Table]) -> tuple[Diagram[int], tuple[Reference, ...]]:
    """One diagram of several functions with the values 0 to 2."""
    builder = DiagramBuilder(range(len(SIZES)), (0, 1, 2))
    roots = [builder.from_table(SIZES, table, 0) for table in tables]
    return builder.finish(), tuple(roots)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 1.0])
def test_the_smallest_of_three_diagrams(share: float) -> None:
    """Right in all states that matter, exact where that is asked for, canonical, and never larger than before."""
    random, smaller = Random(1), 0
    for _ in range(20):
        tables = [{state: random.choice((0, 0, 1, 2)) for state in STATES} for _ in range(3)]
        where = {state: random.random() < share for state in STATES}
        diagram, (fixed, *roots) = drawn(tables)
        sets = DiagramBuilder(range(len(SIZES)), (False, True))
        mask = sets.from_table(SIZES, where, default=False)
        found, (exact, *functions) = smallest(diagram, roots, SIZES, (sets.finish(), mask), [fixed])
        assert all(found.evaluate(exact, state) == tables[0][state] for state in STATES)
        for root, table in zip(functions, tables[1:], strict=True):
            assert all(found.evaluate(root, state) == table[state] for state in STATES if where[state])
        assert rebuild(found, (exact, *functions)) == (found, (exact, *functions))
        before = rebuild(diagram, (fixed, *roots))[0]
        assert len(found.nodes) <= len(before.nodes)
        smaller += len(found.nodes) < len(before.nodes)
    assert (smaller > 10) == (0 < share < 1)
