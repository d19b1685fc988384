"""Changes that are not needed are reverted, in a number of tries that does not grow with the changed states."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from random import Random

import pytest

from benchmarks.families import FAMILIES
from tests.game.test_fixpoints import policies, problems, some_states
from tests.generate import ALL_PROFILES
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.game import Evaluator, build_problem, distances, own_region_policy, route, shortest_decisions
from tumato_symbolic.symbolic import available_backend
from tumato_symbolic.synthesis.overriding import _visited_for_ever, override, revert_unneeded


@pytest.mark.parametrize(("family", "size"), [("loads", 5), ("plant", 1)])
def test_no_change_that_is_left_can_be_reverted_alone(family: str, size: int) -> None:
    """What remains changed serves all states, and a tenth state of it taken back by itself does not."""
    problem = build_problem(parse(FAMILIES[family].text(size, True)), "any", available_backend())
    steps, evaluator, apart = problem.steps, Evaluator(problem), distances(problem)
    before = own_region_policy(problem).policy
    before = route(problem, before, steps.safe & ~steps.states_of(before), steps.safe, problem.targets)
    undecided = steps.safe & ~steps.states_of(before)
    before = before | shortest_decisions(problem, apart, undecided, steps.allowed)
    changed = override(evaluator, evaluator.evaluate(before), apart).closed_loop.policy
    after = revert_unneeded(evaluator, before, changed)
    assert evaluator.evaluate(after).failing == problem.false
    left = steps.states_of(after & ~before)
    assert left != problem.false
    for state in list(problem.encoding.states_in(left))[::10]:
        here = problem.encoding.state_cube(state)
        assert evaluator.evaluate((after & ~here) | (before & here)).failing != problem.false


def test_the_tries_grow_with_what_has_to_stay_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the 2^n states that are sent elsewhere n - 1 stay so, after at most five judgements for each of these."""
    counted: Counter[str] = Counter()

    def counting(name: str, taken: Callable[..., object]) -> Callable[..., object]:
        def count(evaluator: Evaluator, *values: object) -> object:
            counted[name] += 1
            return taken(evaluator, *values)

        return count

    for name in ("evaluate", "serves_all"):
        monkeypatch.setattr(Evaluator, name, counting(name, getattr(Evaluator, name)))
    found = synthesize(parse(FAMILIES["loads"].text(8, True)))
    assert isinstance(found, Realizable)
    assert found.statistics.changed == 7
    assert sum(counted.values()) <= 5 * 7


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_runs_are_followed_to_what_they_come_back_to(profile: str) -> None:
    """Where runs are for ever is where they are after more steps than there are states, from unsafe states as well."""
    for problem in problems(profile):
        random, steps = Random(6), problem.steps
        count = problem.encoding.count_states(steps.valid)
        for policy in policies(problem, random):
            starts = some_states(problem, random) & some_states(problem, random)
            here = (starts & steps.safe) | steps.successors(steps.allowed & steps.unsafe & starts)
            expected = problem.false
            for step in range(2 * count):
                expected = expected | here if step >= count else expected
                here = steps.successors(policy & here)
            assert _visited_for_ever(problem, policy, starts) == expected
