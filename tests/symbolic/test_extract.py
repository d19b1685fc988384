"""Diagrams over many-valued variables, made from sets of bit vectors."""

from __future__ import annotations

from collections import Counter

import pytest

from tumato_symbolic import parse
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.symbolic import Bdd, Extractor, Manager, available_backend, encode

VALUES = 1_000
TEXT = f"BEGIN STATE VECTOR state X can be 0..{VALUES - 1} state Y can be no, yes END STATE VECTOR"


def test_every_value_leads_where_it_is() -> None:
    """A function of a variable with many values, whose number is no power of two, has each of them in its place."""
    encoding = encode(parse(TEXT), available_backend())
    builder: DiagramBuilder[int] = DiagramBuilder(encoding.order, range(4))
    extract = Extractor(encoding, builder, default=0)
    parts = {1: range(3, 400, 7), 2: range(500, VALUES, 3), 3: [VALUES - 1 - 1]}
    taken = {value: rank for rank, values in parts.items() for value in values}
    union, value = encoding.manager.union, encoding.value
    root = extract.function(
        [(rank, union(value(0, v) & value(1, 1) for v, its in taken.items() if its == rank)) for rank in parts]
    )
    diagram = builder.finish()
    for x in range(VALUES):
        for y in range(2):
            assert diagram.evaluate(root, (x, y)) == (taken.get(x, 0) if y else 0)


def test_a_single_value_is_found_by_its_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two steps for each bit, not one for each value: a thousand actions with a value each take no million."""
    encoding = encode(parse(TEXT), available_backend())
    counted: Counter[str] = Counter()
    halves = Manager.halves

    def count(manager: Manager, u: Bdd, level: int) -> tuple[Bdd, Bdd]:
        counted["halves"] += 1
        return halves(manager, u, level)

    monkeypatch.setattr(Manager, "halves", count)
    builder: DiagramBuilder[bool] = DiagramBuilder(encoding.order, (False, True))
    Extractor(encoding, builder, default=False).function([(True, encoding.value(0, 617))])
    assert counted["halves"] <= 2 * len(encoding.state_bits[0])
