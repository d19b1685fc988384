"""Diagrams become smaller, and say the same where it matters."""

from itertools import product
from unittest.mock import patch

from hypothesis import given
from hypothesis import strategies as st

from tests.policy.strategies import QUICK, diagram_of, policies
from tumato_symbolic.diagrams import DiagramBuilder, restrict
from tumato_symbolic.policy import (
    Certificate,
    DecisionDiagram,
    Policy,
    RankedGoal,
    as_table,
    minimized,
    minimized_decisions,
)
from tumato_symbolic.policy.unrealizability import Layers, NoPlan


@QUICK
@given(policies(forms=("diagram",)), st.sampled_from([0, 10_000]))
def test_decisions_stay_and_nothing_grows(policy: Policy, most: int) -> None:
    """Every defined state keeps its decision, no other becomes defined, and there are no more nodes; large or not."""
    with patch.object(restrict, "MOST_MERGED", most):
        found = minimized_decisions(diagram_of(policy), policy.vocabulary.sizes)
    assert as_table(Policy(policy.vocabulary, found), 10_000) == as_table(policy, 10_000)
    assert len(found.diagram.nodes) <= len(diagram_of(policy).diagram.nodes)


@QUICK
@given(policies(forms=("diagram",)), st.data())
def test_ranks_stay_where_they_matter(policy: Policy, data: st.DataObject) -> None:
    """Every state of the given set keeps the rank of every goal, and there are no more nodes."""
    sizes, decisions = policy.vocabulary.sizes, diagram_of(policy)
    states = list(product(*map(range, sizes)))
    builder = DiagramBuilder(decisions.diagram.order, (None, 0, 1, 2))
    tables = data.draw(st.lists(st.dictionaries(st.sampled_from(states), st.sampled_from([None, 0, 1, 2])), max_size=3))
    goals = [RankedGoal((str(n),), (), builder.from_table(sizes, table, None)) for n, table in enumerate(tables)]
    given_ranks = Certificate(builder.finish(), tuple(goals))
    care = (decisions.diagram, decisions.defined)
    found = minimized(given_ranks, sizes, care)
    for before, after in zip(given_ranks.goals, found.goals, strict=True):
        for state in states:
            if care[0].evaluate(care[1], state):
                assert found.ranks.evaluate(after.root, state) == given_ranks.ranks.evaluate(before.root, state)
    assert len(found.ranks.nodes) <= len(given_ranks.ranks.nodes)


@QUICK
@given(st.lists(st.frozensets(st.sampled_from(list(product(range(2), range(3), range(2))))), min_size=2, max_size=5))
def test_layers_stay_where_they_matter(sets: list[frozenset[tuple[int, ...]]]) -> None:
    """Every layer keeps the states of the first set that it has, and there are no more nodes."""
    sizes, builder = (2, 3, 2), DiagramBuilder((2, 0, 1), (False, True))
    care, *roots = [builder.from_table(sizes, dict.fromkeys(sorted(each), True), False) for each in sets]
    goals = (Layers(("a",), (), tuple(roots[:2])), Layers(("b",), ("go",), tuple(roots[2:])))
    reason = NoPlan((0, 0, 0), builder.finish(), goals)
    found = minimized(reason, sizes, (reason.diagram, care))
    assert [(goal.bodies, len(goal.roots)) for goal in found.goals] == [(g.bodies, len(g.roots)) for g in goals]
    for before, after in zip(reason.drawing[1], found.drawing[1], strict=True):
        assert all(found.diagram.evaluate(after, s) == reason.diagram.evaluate(before, s) for s in sets[0])
    assert len(found.diagram.nodes) <= len(reason.diagram.nodes)


def test_undefined_states_are_used() -> None:
    """An action that is executed in every state that is defined needs no node, whatever it looked like elsewhere."""
    builder = DiagramBuilder((0, 1), (False, True))
    executed = builder.from_table((2, 2), dict.fromkeys([(0, 0), (0, 1), (1, 1)], True), False)
    defined = builder.from_table((2, 2), dict.fromkeys([(0, 0), (1, 1)], True), False)
    decisions = DecisionDiagram(builder.finish(), (executed,), defined)
    assert minimized_decisions(decisions, (2, 2)).roots == (1,)


def test_values_with_compatible_rests_share_one() -> None:
    """A variable is not tested when its values do not contradict each other where it matters."""
    builder = DiagramBuilder((0, 1, 2), (False, True))
    executed = builder.from_table((2, 2, 2), {(0, 0, 0): True}, False)
    defined = builder.from_table((2, 2, 2), dict.fromkeys([(1, 1, 0), (0, 0, 0), (0, 1, 0)], True), False)
    found = minimized_decisions(DecisionDiagram(builder.finish(), (executed,), defined), (2, 2, 2))
    for rest in product(range(2), range(2)):
        low, high = (found.diagram.evaluate(found.roots[0], (first, *rest)) for first in range(2))
        assert low == high
