"""Policies as tables and as graphs: one state at a time, against the explicit meaning."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator
from typing import Any

import pytest

from tests.repo.documents import ROOT
from tumato_symbolic import Policy, Realizable, Spec, UserError, parse, synthesize
from tumato_symbolic.limits import MissingPackageError
from tumato_symbolic.policy import as_table, bind
from tumato_symbolic.semantics import in_json, is_safe, next_states, nominal_agrees, successor

needs_pandas = pytest.mark.skipif(importlib.util.find_spec("pandas") is None, reason="pandas is not installed")
needs_networkx = pytest.mark.skipif(importlib.util.find_spec("networkx") is None, reason="networkx is not installed")

NUMBERS = """
BEGIN STATE VECTOR state N can be 0..2 state B can be open, 7 END STATE VECTOR
BEGIN ACTIONS
  action up preconditions: none nominal effects: N is N + 1 alternative effects: none
  action open preconditions: B is 7 nominal effects: B is open
END ACTIONS
BEGIN GOALS goal type: priority goal: N is 2 END GOALS
"""


def solved(text: str) -> tuple[Spec, Policy]:
    """A specification with its policy."""
    spec = parse(text)
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    return spec, outcome.policy


def small() -> Iterator[tuple[Spec, Policy]]:
    """Examples with few states, and one with numbers as values."""
    yield solved(NUMBERS)
    for name in ("amr", "coin", "concurrent", "brake", "lid"):
        yield solved((ROOT / "examples" / f"{name}.tum").read_text())


@needs_networkx
def test_graphs_are_the_closed_loop() -> None:
    """Nodes are the states that are decided, with their decisions; edges lead where the meaning says."""
    seen = 0
    for spec, policy in small():
        graph = policy.to_networkx(spec)
        table = as_table(bind(policy, spec), 10_000)
        assert table is not None
        nodes = {state: tuple(in_json(spec, state).values()) for state in table.rows}
        assert {node for node, actions in graph.nodes(data="actions") if actions is not None} == {*nodes.values()}
        for state, chosen in table.rows.items():
            node = nodes[state]
            assert graph.nodes[node]["actions"] == policy.decide(in_json(spec, state))
            assert graph.nodes[node]["safe"] == is_safe(spec, state)
            following = next_states(spec, state, chosen, spec.ordering)
            assert {*graph.successors(node)} == {tuple(in_json(spec, there).values()) for there in following}
            assert nominal_agrees(spec, chosen)
            nominal = [there for _, there, kind in graph.edges(node, data="kind") if kind == "nominal"]
            assert nominal == [tuple(in_json(spec, successor(spec, state, chosen)).values())]
            seen += any(kind == "deviation" for _, _, kind in graph.edges(node, data="kind"))
    assert seen > 10


@needs_networkx
def test_an_outcome_that_is_not_decided() -> None:
    """Is a node without a decision."""
    spec, policy = solved(NUMBERS)
    table: Any = policy.decisions
    part = Policy(policy.vocabulary, type(table)({(0, 0): table.rows[0, 0]}))
    graph = part.to_networkx(spec)
    assert dict(graph.nodes(data="actions")) == {(0, "open"): ("up",), (1, "open"): None}


@needs_pandas
def test_rows_are_the_decisions() -> None:
    """Of every state that is decided, in order, and whether it is safe; numbers are numbers."""
    for spec, policy in small():
        frame = policy.to_dataframe(spec)
        table = as_table(bind(policy, spec), 10_000)
        assert table is not None
        assert list(frame.index.names) == [variable.name for variable in spec.variables]
        states = [tuple(in_json(spec, state).values()) for state in table.rows]
        assert list(frame.index) == states
        assert list(frame.actions) == [policy.decide(in_json(spec, state)) for state in table.rows]
        assert list(frame.safe) == [is_safe(spec, state) for state in table.rows]
    spec, policy = solved(NUMBERS)
    assert len(policy.to_dataframe(spec).query("N > 0 and B == 7")) == 2


@pytest.mark.parametrize(
    "method", [pytest.param("to_dataframe", marks=needs_pandas), pytest.param("to_networkx", marks=needs_networkx)]
)
def test_too_many_states(method: str) -> None:
    """Are an error that says how many there are, before any is listed; what is asked for is allowed."""
    spec, policy = solved(NUMBERS)
    with pytest.raises(UserError, match=r"TUM508: the policy decides 6 states, and a (table|graph) holds 5 at most"):
        getattr(policy, method)(spec, max_states=5)
    assert len(getattr(policy, method)(spec, max_states=6)) == 6


@needs_networkx
def test_a_policy_for_something_else() -> None:
    """Is told as everywhere."""
    _, policy = solved(NUMBERS)
    with pytest.raises(UserError, match="TUM503"):
        policy.to_networkx(parse((ROOT / "examples" / "amr.tum").read_text()))


@pytest.mark.parametrize(("method", "package"), [("to_dataframe", "pandas"), ("to_networkx", "networkx")])
def test_a_package_that_is_missing(method: str, package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is named, with the way to install it."""
    spec, policy = solved(NUMBERS)
    monkeypatch.setitem(sys.modules, package, None)
    way_out = r"`pip install 'tumato-symbolic\[notebook\]'`"
    with pytest.raises(MissingPackageError, match=f"{package} is needed .* {way_out}"):
        getattr(policy, method)(spec)
