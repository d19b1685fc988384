"""What decisions cost is counted right; how long they take is no matter of a test."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from benchmarks.deciding import BAR, Deciding, count_tests, deciding, most_tests
from tests.export.policies import decisions, example, random_request
from tumato_symbolic.export.decisions import MOST_QUESTIONS, Question, tree_of


@pytest.mark.parametrize("seed", range(6))
def test_the_most_tests_are_those_of_some_state(seed: int) -> None:
    """And no variable is looked at twice."""
    made = random_request(seed)
    tree = tree_of(made.policy, MOST_QUESTIONS)
    assert tree is not None
    counted = [count_tests(tree, state) for state, _ in decisions(made)]
    assert most_tests(tree) == max(counted) <= len(made.policy.vocabulary.variables)
    assert isinstance(tree, Question) == (max(counted) > 0)


def test_the_robot_of_the_paper() -> None:
    """What is measured of the AMR is its own policy, in all of its states."""
    measured = deciding("amr", rounds=1)
    tree = tree_of(example("amr").policy, MOST_QUESTIONS)
    assert tree is not None
    counted = [count_tests(tree, state) for state, _ in decisions(example("amr"))]
    assert (measured.variables, measured.most_tests) == (4, max(counted))
    assert measured.mean_tests == sum(counted) / 32


def test_a_bar_that_is_missed_is_told() -> None:
    """Times are the AMR's alone, tests everybody's; where there is no tree, none are counted."""
    good = Deciding("amr", 4, 4, 3.0, BAR, BAR, BAR)
    assert good.kept
    slow = 2 * BAR
    for slower in (replace(good, table=slow), replace(good, diagram=slow), replace(good, export=slow)):
        assert not slower.kept
        assert replace(slower, name="fleet").kept
    assert not replace(good, name="fleet", most_tests=5).kept
    assert replace(good, most_tests=None, mean_tests=None, table=None).kept
