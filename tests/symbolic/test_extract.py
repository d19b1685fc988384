"""Diagrams over many-valued variables, made from sets of bit vectors."""

from __future__ import annotations

from collections import Counter

import pytest

from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagrams import LEAVES, DiagramBuilder, Sets
from tumato_symbolic.export.decisions import questions, tree_of
from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.spec.names import MAX_VARIABLES
from tumato_symbolic.symbolic import Backend, Bdd, Extractor, Manager, available_backend, encode

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


MANY = f"""
BEGIN STATE VECTOR for N in 1..{MAX_VARIABLES} state X{{N}} can be no, yes end for END STATE VECTOR
BEGIN ACTIONS action act nominal effects: X1 is yes END ACTIONS
BEGIN ASSUMPTIONS for N in 2..{MAX_VARIABLES} assume: X{{N}} is yes end for END ASSUMPTIONS
BEGIN GOALS goal type: priority goal: X1 is yes END GOALS
"""


@pytest.mark.parametrize("backend", ["cudd", "autoref"])
def test_as_many_variables_as_there_may_be(backend: Backend) -> None:
    """What goes down a diagram of all variables has room for that: a policy is made, counted and asked as a tree."""
    outcome = synthesize(parse(MANY), backend=backend, policy_format="diagram")
    assert isinstance(outcome, Realizable)
    policy, decisions = outcome.policy, outcome.policy.decisions
    assert isinstance(decisions, DecisionDiagram)
    sets = Sets(decisions.diagram.order, policy.vocabulary.sizes)
    (defined,) = sets.take(decisions.diagram, (decisions.defined,), LEAVES)
    assert sets.count(defined) == 2
    tree = tree_of(policy, 3 * MAX_VARIABLES)
    assert tree is not None
    assert len(questions(tree)) == 2 * MAX_VARIABLES - 1
