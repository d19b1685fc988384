"""Numbers of variables, values and actions by hand: each renumbering is a cycle of three, so that no one is its own
inverse."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tests.policy.strategies import spec_of
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import Diagram, DiagramBuilder, count_true, rebuild
from tumato_symbolic.policy import Certificate, Policy, RankedGoal, Table, Vocabulary, as_diagram, bind
from tumato_symbolic.policy.decisions import Renumbering
from tumato_symbolic.semantics import State

THERE = Vocabulary((("x", ("a", "b", "c")), ("y", ("p", "q")), ("z", ("u", "v", "w", "t"))), ("go", "eat", "nap"))
HERE = Vocabulary((("z", ("w", "u", "t", "v")), ("x", ("c", "a", "b")), ("y", ("q", "p"))), ("eat", "nap", "go"))
STATES = list(product(range(3), range(2), range(4)))


def names(vocabulary: Vocabulary, state: tuple[int, ...]) -> dict[str, str]:
    """A state by names."""
    return {name: values[value] for (name, values), value in zip(vocabulary.variables, state, strict=True)}


def there_and_here() -> Renumbering:
    """From the one vocabulary to the other."""
    return Renumbering.between(THERE, HERE, "policy")


def test_states_and_effects_keep_their_names() -> None:
    """Every state and assignment says the same before and after, and comes in the order of the variables."""
    renumbering = there_and_here()
    for state in STATES:
        assert names(HERE, renumbering.state(state)) == names(THERE, state)
    assert renumbering.state((0, 0, 0)) == (1, 1, 1)
    assert renumbering.state((1, 0, 2)) == (0, 2, 1)
    assert renumbering.assignment([(0, 2), (2, 1)]) == ((0, 3), (1, 0))
    assert renumbering.action_set([0]) == {2}
    assert renumbering.action_set([1, 2]) == {0, 1}


def rows() -> dict[tuple[int, ...], frozenset[int]]:
    """A different set in every state, some states left out."""
    sets = [frozenset(number for number in range(3) if code >> number & 1) for code in range(8)]
    return {state: sets[(5 * number + number // 8) % 8] for number, state in enumerate(STATES) if number % 7}


@pytest.mark.parametrize("diagram", [False, True])
def test_decisions_keep_their_names(diagram: bool) -> None:
    """Tables and diagrams decide the same actions in the same states, and nothing where nothing was decided."""
    policy = Policy(THERE, Table(rows()))
    if diagram:
        policy = Policy(THERE, as_diagram(policy))
    bound = bind(policy, spec_of(HERE))
    renumbering = there_and_here()
    for state in STATES:
        after = renumbering.state(state)
        chosen = rows().get(state)
        if isinstance(bound.decisions, Table):
            found = bound.decisions.rows.get(after)
        else:
            decisions = bound.decisions
            acting = [number for number, root in enumerate(decisions.roots) if decisions.diagram.evaluate(root, after)]
            found = frozenset(acting) if decisions.diagram.evaluate(decisions.defined, after) else None
        assert found == (None if chosen is None else {HERE.actions.index(THERE.actions[action]) for action in chosen})
    if isinstance(bound.decisions, Table):
        assert list(bound.decisions.rows) == sorted(bound.decisions.rows)


def test_ranks_keep_their_states() -> None:
    """The rank of a state is the rank of the same state, goal by goal."""
    builder = DiagramBuilder[int | None]((2, 0, 1), (None, *range(24)))
    one = builder.from_table((3, 2, 4), {state: number for number, state in enumerate(STATES)}, None)
    two = builder.from_table((3, 2, 4), {state: 23 - number for number, state in enumerate(STATES) if number % 2}, None)
    goals = (RankedGoal(("body",), ("nap",), one), RankedGoal(("other",), (), two))
    certificate = Certificate(builder.finish(), goals)
    policy = Policy(THERE, Table(rows()), certificate=certificate)
    bound = bind(policy, spec_of(HERE)).certificate
    assert bound is not None
    assert [(goal.bodies, goal.executed) for goal in bound.goals] == [(("body",), ("nap",)), (("other",), ())]
    for number, state in enumerate(STATES):
        after = there_and_here().state(state)
        assert bound.ranks.evaluate(bound.goals[0].root, after) == number
        assert bound.ranks.evaluate(bound.goals[1].root, after) == (23 - number if number % 2 else None)


def test_actions_that_the_certificate_names_must_exist() -> None:
    """One unknown name sets the certificate aside, with the reason; known ones do not, and an older reason stays."""
    ranks = DiagramBuilder[int | None]((0, 1, 2), (None,)).finish()
    for executed, kept in ((("nap", "go"), True), (("nap", "fly"), False), ((), True)):
        certificate = Certificate(ranks, (RankedGoal((), executed, 0),))
        bound = bind(Policy(THERE, Table(rows()), certificate=certificate), spec_of(HERE))
        assert (bound.certificate is not None) == kept
        assert (bound.certificate_problem is None) == kept
    assert bind(Policy(THERE, Table(rows()), certificate_problem="torn"), spec_of(HERE)).certificate_problem == "torn"


def test_at_most_twenty_differences_are_told() -> None:
    """All differences up to the limit, of every kind."""
    many = Vocabulary((), tuple(f"act{number}" for number in range(30)))
    with pytest.raises(UserError) as raised:
        Renumbering.between(many, Vocabulary((), ()), "policy")
    assert len(raised.value.diagnostics) == 20
    assert {diagnostic.code.name for diagnostic in raised.value.diagnostics} == {"TUM505"}


def drawn(random: Random, order: tuple[int, ...], sizes: tuple[int, ...]) -> tuple[Diagram[bool], int, set[State]]:
    """A diagram, its root, and the states that it leads to True."""
    inside = {state for state in product(*map(range, sizes)) if random.random() < 0.4}
    builder = DiagramBuilder(order, (False, True))
    root = builder.from_table(sizes, dict.fromkeys(inside, True), False)
    return builder.finish(), root, inside


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1)])
def test_diagrams_are_the_functions_they_are_made_of(order: tuple[int, ...]) -> None:
    """Evaluation, counting and renumbering agree with the table, state by state; nothing is kept twice."""
    random, sizes = Random(3), (3, 2, 4)
    for _ in range(20):
        diagram, root, inside = drawn(random, order, sizes)
        states = list(product(*map(range, sizes)))
        assert {state for state in states if diagram.evaluate(root, state)} == inside
        assert count_true(diagram, root, sizes) == len(inside)
        assert count_true(diagram, 0, sizes) == 0
        assert count_true(diagram, 1, sizes) == len(states)
        assert len(set(diagram.nodes)) == len(diagram.nodes)
        assert all(len(set(below)) > 1 for _, below in diagram.nodes)
        values = [random.sample(range(sizes[variable]), sizes[variable]) for variable in order]
        turned, (new,) = rebuild(diagram, [root], None, values)
        for state in states:
            old = list(state)
            for level, variable in enumerate(order):
                old[variable] = values[level][state[variable]]
            assert turned.evaluate(new, state) == (tuple(old) in inside)
        assert len(turned.nodes) <= len(diagram.nodes)
        assert len(set(turned.nodes)) == len(turned.nodes)


def test_variables_that_are_not_tested_count_all_their_values() -> None:
    """The count is over all variables, wherever a diagram begins and ends."""
    builder = DiagramBuilder((1, 3), (False, True))
    root = builder.node(0, (0, builder.node(1, (1, 0, 0))))
    diagram = builder.finish()
    assert count_true(diagram, root, (5, 2, 7, 3)) == 5 * 7
    lower = builder.node(1, (1, 0, 1))
    assert count_true(builder.finish(), lower, (5, 2, 7, 3)) == 5 * 7 * 2 * 2
    assert builder.node(0, (lower, lower)) == lower


def test_only_what_is_needed_is_rebuilt() -> None:
    """Nodes that no root needs are left out, and several roots share the rest."""
    builder = DiagramBuilder((0, 1), (False, True))
    low = builder.node(1, (0, 1))
    builder.node(1, (1, 0))
    top, other = builder.node(0, (low, 0)), builder.node(0, (low, 1))
    diagram, roots = rebuild(builder.finish(), [other, top, low, 1], [1, 0])
    assert len(diagram.nodes) == 3
    assert diagram.order == (1, 0)
    assert [diagram.evaluate(root, (1, 0)) for root in roots] == [True, True, True, True]
    assert [diagram.evaluate(root, (0, 1)) for root in roots] == [True, False, False, True]
    assert [diagram.evaluate(root, (1, 1)) for root in roots] == [True, False, True, True]


def test_a_variable_with_one_value_is_never_tested() -> None:
    """A node with one child is that child."""
    builder = DiagramBuilder((0, 1), (False, True))
    low = builder.node(1, (0, 1))
    assert builder.node(0, (low,)) == low
    assert builder.from_table((1, 2), {(0, 1): True}, False) == low
    assert count_true(builder.finish(), low, (1, 2)) == 1
