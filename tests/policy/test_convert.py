"""Tables and diagrams say the same."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.policy.strategies import QUICK, diagram_of, policies, rows_of, spec_of, tables, vocabularies
from tumato_symbolic.diagrams import Diagram, DiagramBuilder, Sets, rebuild
from tumato_symbolic.policy import (
    DecisionDiagram,
    Policy,
    Table,
    Vocabulary,
    as_diagram,
    as_table,
    count_defined,
    never_executed,
    policy_from_rows,
)


@QUICK
@given(policies(forms=("table",)))
def test_table_to_diagram_to_table(policy: Policy) -> None:
    """A table comes back from its diagram, and both count the same states."""
    diagram = Policy(policy.vocabulary, as_diagram(policy))
    assert count_defined(diagram) == count_defined(policy) == len(rows_of(policy))
    assert as_table(diagram, 1000) == policy.decisions


@QUICK
@given(policies())
def test_what_is_never_executed_is_in_no_row(policy: Policy) -> None:
    """Table or diagram, whatever roots say of states that are not decided."""
    executed = {action for chosen in rows_of(policy).values() for action in chosen}
    names = policy.vocabulary.actions
    assert never_executed(policy) == tuple(name for number, name in enumerate(names) if number not in executed)


@QUICK
@given(policies(forms=("diagram",)))
def test_diagram_to_table_state_by_state(policy: Policy) -> None:
    """The table of a diagram has exactly the defined states, with the actions whose roots lead to True."""
    decisions = diagram_of(policy)
    diagram, roots = decisions.diagram, decisions.roots
    expected = {
        state: frozenset(action for action, root in enumerate(roots) if diagram.evaluate(root, state))
        for state in product(*map(range, policy.vocabulary.sizes))
        if diagram.evaluate(decisions.defined, state)
    }
    found = rows_of(policy)
    assert found == expected
    assert list(found) == sorted(expected)


@QUICK
@given(policies())
def test_the_limit_is_exact(policy: Policy) -> None:
    """As many rows as allowed are given, one more is refused."""
    count = count_defined(policy)
    assert as_table(policy, count) is not None
    assert as_table(policy, count - 1) is None


@QUICK
@given(policies(forms=("diagram",)))
def test_canonical_is_canonical(policy: Policy) -> None:
    """Rebuilding a rebuilt diagram changes nothing: no two equal nodes, none superfluous, children first."""
    decisions = diagram_of(policy)
    roots = (*decisions.roots, decisions.defined)
    assert rebuild(decisions.diagram, roots) == (decisions.diagram, roots)
    nodes = decisions.diagram.nodes
    assert len(set(nodes)) == len(nodes)
    assert all(len(set(below)) > 1 for _, below in nodes)


@QUICK
@given(st.data())
def test_from_table_is_the_function(data: st.DataObject) -> None:
    """A diagram built from a table evaluates to the table, and to the default elsewhere."""
    vocabulary = data.draw(vocabularies())
    table = {state: len(chosen) for state, chosen in data.draw(tables(vocabulary)).rows.items()}
    order = data.draw(st.permutations(range(len(vocabulary.sizes))))
    builder = DiagramBuilder(order, tuple(range(-1, 6)))
    root = builder.from_table(vocabulary.sizes, table, -1)
    for state in product(*map(range, vocabulary.sizes)):
        assert builder.finish().evaluate(root, state) == table.get(state, -1)


def test_counting_does_not_enumerate() -> None:
    """2^200 states are counted exactly, and are too many for a table; variables that no level tests count too."""
    vocabulary = Vocabulary(tuple((f"S{number}", ("a", "b")) for number in range(201)), ())
    diagram = Diagram((0, 5), (False, True), ((1, (0, 1)), (0, (2, 1))))
    policy = Policy(vocabulary, DecisionDiagram(diagram, (), 3))
    assert count_defined(policy) == 3 * 2**199
    assert as_table(policy, 10**6) is None


def test_many_variables_need_no_deep_stack() -> None:
    """Tables over 5,000 variables become diagrams."""
    count = 5000
    vocabulary = Vocabulary(tuple((f"S{number}", ("a", "b")) for number in range(count)), ("go",))
    rows = {(0,) * count: frozenset({0}), (*(0,) * (count - 1), 1): frozenset()}
    policy = Policy(vocabulary, Table(rows))
    diagram = as_diagram(policy)
    assert diagram.diagram.evaluate(diagram.roots[0], (0,) * count)
    assert rows_of(Policy(vocabulary, diagram), 2) == rows


def test_rows_become_a_policy() -> None:
    """`policy_from_rows` takes its names from the specification and puts rows in row-major order."""
    vocabulary = Vocabulary((("S", ("a", "b")),), ("go",))
    policy = policy_from_rows(spec_of(vocabulary), {(1,): frozenset(), (0,): frozenset({0})}, "first", "d", None)
    assert policy == Policy(vocabulary, Table({(0,): frozenset({0}), (1,): frozenset()}), "first", "d")
    assert list(rows_of(policy)) == [(0,), (1,)]


def test_a_table_takes_each_combination_of_nodes_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A diagram that reads the same below many paths is looked at once there: a few nodes a variable, not 2^12."""
    size, made = 12, list[int]()
    rows = {state: frozenset({sum(state) % 2}) for state in product(range(2), repeat=size) if any(state[-3:])}
    vocabulary = Vocabulary(tuple((f"v{number}", ("a", "b")) for number in range(size)), ("even", "odd"))
    node = Sets.node

    def counted(sets: Sets, level: int, below: tuple[int, ...]) -> int:
        made.append(level)
        return node(sets, level, below)

    diagram = Policy(vocabulary, as_diagram(Policy(vocabulary, Table(rows))))
    monkeypatch.setattr(Sets, "node", counted)
    assert rows_of(diagram, 2**size) == rows
    assert size < len(made) < 10 * size
