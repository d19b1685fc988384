"""What is shown of a part of a policy is what the policy says there, state by state."""

from collections import Counter
from collections.abc import Iterator
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.policy.strategies import QUICK, amr_like, policies, rows_of
from tumato_symbolic.policy import Policy, minimal_rules
from tumato_symbolic.semantics import State
from tumato_symbolic.views import (
    OTHER,
    Answer,
    Folded,
    Label,
    Question,
    Questions,
    Row,
    Selected,
    Selection,
    Tree,
    rows,
    select,
)

SOME = st.integers(1, 6)


@st.composite
def parts(draw: st.DrawFn) -> tuple[Policy, Selection]:
    """A policy, and values and actions that may be asked for."""
    policy = draw(policies())
    values = [
        (name, tuple(value for value in known if value in draw(st.sets(st.sampled_from(known), min_size=1))))
        for name, known in policy.vocabulary.variables
        if draw(st.booleans())
    ]
    actions = policy.vocabulary.actions
    executing = draw(st.sampled_from([(), (), *((action,) for action in actions)]))
    return policy, Selection(tuple(values), executing)


def truth(policy: Policy, selection: Selection) -> dict[State, Label]:
    """By state, what is to be shown: nothing of states with other values."""
    listed, vocabulary = rows_of(policy), policy.vocabulary
    allowed = dict(selection.values)
    wanted = {vocabulary.actions.index(name) for name in selection.executing}
    found: dict[State, Label] = {}
    for state in product(*map(range, vocabulary.sizes)):
        named = zip(vocabulary.variables, state, strict=True)
        if all(known[value] in allowed.get(name, known) for (name, known), value in named):
            chosen = listed.get(state)
            other = bool(wanted) and (chosen is None or not wanted <= chosen)
            actions = None if other or chosen is None else tuple(sorted(chosen))
            found[state] = Label(actions, other=other)
    return found


def matching(found: list[Row], state: State) -> list[Row]:
    """The rows that are about a state."""
    return [row for row in found if all(state[variable] in values for variable, values in row.condition)]


def joint(selected: Selected) -> Questions:
    """What asks about a part."""
    return Questions(selected.joint())


@QUICK
@given(parts())
def test_rows_say_what_the_policy_says(part: tuple[Policy, Selection]) -> None:
    """Every state that is selected is in one row with its decision, and counted there; others are in none."""
    expected = truth(*part)
    tree = joint(select(*part)).tree(10_000)
    found = [] if tree is None else rows(tree)
    counted = Counter[int]()
    for state, label in expected.items():
        about = matching(found, state)
        if label.other:
            assert not about
        else:
            (row,) = about
            assert isinstance(row.leaf, Answer)
            assert row.leaf.label == label
            counted[found.index(row)] += 1
    assert [row.leaf.states for row in found] == [counted[place] for place in range(len(found))]


@QUICK
@given(parts(), SOME, st.booleans())
def test_what_is_left_out_is_counted(part: tuple[Policy, Selection], most: int, leaves_only: bool) -> None:
    """A tree keeps to its limit; a part that is folded says how many states it has, and with how many decisions."""
    expected = truth(*part)
    tree = joint(select(*part)).tree(most, leaves_only=leaves_only)
    if tree is None:
        assert not expected
        return
    found = rows(tree)
    lines = _lines(tree)
    shown = [line for line in lines if not isinstance(line, Question)] if leaves_only else lines
    assert len(shown) <= most
    for row in found:
        inside = [label for state, label in expected.items() if row in matching(found, state) and not label.other]
        assert row.leaf.states == len(inside)
        if isinstance(row.leaf, Folded):
            assert row.leaf.decisions == len(set(inside))
            assert len(set(inside)) > 1 or part[1].executing


def _lines(tree: Tree) -> list[Tree]:
    if not isinstance(tree, Question):
        return []
    return [line for branch in tree.branches for line in (branch.tree, *_lines(branch.tree))]


def _follow(policy: Policy, state: State, questions: Questions, most: int) -> Iterator[Label | None]:
    boxes = {box.reference: box for box in questions.graph(most)}
    here = next(iter(boxes.values()))
    while here.variable is not None:
        value = state[here.variable]
        here = boxes[next(below for values, below in here.branches if value in values)]
    yield here.label


@QUICK
@given(parts(), SOME)
def test_a_graph_leads_to_what_the_policy_says(part: tuple[Policy, Selection], most: int) -> None:
    """Following the boxes leads from any selected state to its decision, or to a box that is folded."""
    policy, questions, expected = part[0], joint(select(*part)), truth(*part)
    for state, label in expected.items():
        assert [label] == list(_follow(policy, state, questions, 10_000))
        assert next(_follow(policy, state, questions, most)) in (None, label)
    assert len(questions.graph(most)) <= most


@QUICK
@given(parts())
def test_the_rules_of_a_part_say_what_the_policy_says(part: tuple[Policy, Selection]) -> None:
    """Of a part, the first rule that matches decides as the policy does, or says that it does something else."""
    rules, variables = minimal_rules(select(*part).as_policy()), part[0].vocabulary.variables
    for state, label in truth(*part).items():
        named = {name: known[value] for (name, known), value in zip(variables, state, strict=True)}
        matches = (rule for rule in rules if all(named[name] in values for name, values in rule.condition))
        if label.other or label.actions is not None:
            actions = () if label.actions is None else label.actions
            names = (OTHER,) if label.other else tuple(part[0].vocabulary.actions[action] for action in actions)
            assert next(matches).actions == names


@pytest.mark.parametrize("large", [0, 1_500])
def test_large_functions_are_asked_in_their_order(large: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the best question is not looked for, the answers are the same."""
    monkeypatch.setattr("tumato_symbolic.views.questions._SMALL", large)
    policy, selection = amr_like(diagram=True), Selection((("S_Load", ("full", "odd")),))
    tree = joint(select(policy, selection)).tree(100)
    assert tree is not None
    for state, label in truth(policy, selection).items():
        (row,) = matching(rows(tree), state)
        assert isinstance(row.leaf, Answer)
        assert row.leaf.label == label
