"""The walk judges policies for many residual goals, all of them together, as it does where they are few."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from benchmarks.cleaning import errands
from tests.generate import ALL_PROFILES, random_spec
from tests.verify.policies import certified, dressed, exact_ranks, near_policies
from tests.verify.several_steps import RESTORATIONS, near, stepwise_spec
from tests.verify.test_against_semantics import assert_witness
from tests.verify.test_several_steps import judged_by
from tumato_symbolic import parse
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import all_states, judge
from tumato_symbolic.spec import Ordering, Restoration, many_goals
from tumato_symbolic.verify import verify

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


@pytest.fixture(autouse=True)
def _together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_goals, "MOST_APART", 0)


def test_verdicts_are_those_of_the_explicit_meaning() -> None:
    """Right and wrong policies, whatever their goals speak of; the first state that fails is the witness."""
    met = set()
    for profile, seed in product(sorted(ALL_PROFILES), range(500, 503)):
        spec, random, ordering = random_spec(seed, ALL_PROFILES[profile]), Random(seed), ORDERINGS[seed % 2]
        for rows in near_policies(spec, ordering, random):
            judged = judge(spec, rows, ordering)
            wrong = (judged.missing, judged.not_allowed, judged.goal_missed, judged.not_minimal)
            answer = verify(dressed(spec, rows, random), spec, ordering=ordering, prover="walk")
            expected = ["refuted" if each else "proved" for each in wrong]
            assert [result.verdict for result in answer.properties] == expected
            assert answer.certificate.status in ("absent", "stale", "unneeded")
            for result in answer.properties:
                met.add((result.name, result.verdict))
                if result.refutation is not None:
                    assert_witness(spec, rows, judged, ordering, result.refutation)
                    if result.name == "goals":
                        assert (result.refutation.state, result.refutation.run) == judged.goal_missed[0]
    assert {("goals", "proved"), ("goals", "refuted")} <= met


@pytest.mark.parametrize("restoration", RESTORATIONS[1:])
def test_so_they_are_where_safety_takes_several_steps(restoration: Restoration) -> None:
    """A goal counts in safe states only, and unsafe ones come to safety without a goal."""
    for seed in range(2):
        spec, random = stepwise_spec(seed, restoration, 1 + seed % 2), Random(seed)
        for rows in near(spec, "any", random):
            judged_by(spec, rows, "any", policy_from_rows(spec, rows), "walk")


def test_ranks_that_a_policy_brings_are_used() -> None:
    """A certificate that lists its goals is checked goal by goal, however many there may be."""
    met = set()
    for seed in range(6):
        spec, random = random_spec(seed, ALL_PROFILES["interacting"]), Random(seed)
        for rows in near_policies(spec, "any", random, count=0):
            answer = verify(certified(spec, rows, exact_ranks(spec, rows, "any")), spec, prover="walk")
            met.add((answer.verdict, answer.certificate.status))
    assert ("proved", "used") in met


def test_one_wrong_decision_among_many_goals_is_found() -> None:
    """One of sixteen sets of goals is missed: with only the last room left, the robot turns back at its door."""
    spec = parse(errands(4, True))
    count = len(spec.variables) - 1
    names = {action.name: number for number, action in enumerate(spec.actions)}
    rows = {}
    for state in all_states(spec):
        place, dirty = state[0], [i for i in range(count) if state[1 + i] == 0]
        if not dirty:
            rows[state] = frozenset[int]()
        elif place == 1 + dirty[0]:
            rows[state] = frozenset({names[f"clean_{dirty[0]}"]})
        else:
            rows[state] = frozenset({names[f"go_to_{dirty[0]}" if place == 0 else "go_back"]})
    assert verify(policy_from_rows(spec, rows), spec, prover="walk").verdict == "proved"
    astray = (4, 1, 1, 1, 0)
    rows[astray] = frozenset({names["go_back"]})
    refutation = verify(policy_from_rows(spec, rows), spec, prover="walk").properties[2].refutation
    assert refutation is not None
    assert refutation.kind == "goal-missed"
    assert refutation.run is not None
    assert astray in refutation.run.states
