"""A sample of the changed certificates; `python -m tests.ranks` tries many."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import get_args

import pytest

from tests.ranks import campaign, unrealizable
from tests.ranks.campaign import Tally
from tumato_symbolic import parse
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Certificate, RankedGoal, policy_from_rows
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import digest
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.result import ProverName

ONE_STEP_FROM_NONE = """\
BEGIN STATE VECTOR state P can be u0, u1, t3, t2, t1, t0 END STATE VECTOR
BEGIN RESOURCES resource W END RESOURCES
BEGIN ACTIONS
  action cheap0  duration: 1  controlled resources: W  preconditions: P is u0  nominal effects: P is t1
  action dear0   duration: 5  controlled resources: W  preconditions: P is u0  nominal effects: P is t0
  action cheap1  duration: 1  controlled resources: W  preconditions: P is u1  nominal effects: P is t3
  action dear1   duration: 5  controlled resources: W  preconditions: P is u1  nominal effects: P is t0
  action t3t2  controlled resources: W  preconditions: P is t3  nominal effects: P is t2
  action t2t1  controlled resources: W  preconditions: P is t2  nominal effects: P is t1
  action t1t0  controlled resources: W  preconditions: P is t1  nominal effects: P is t0
END ACTIONS
BEGIN STATE RULES rule: NOT (P is u0 OR P is u1) END STATE RULES
BEGIN GOALS
  goal type: priority
  when NOT (P is t3 OR P is t2 OR P is t1) then goal: P is t0
END GOALS
BEGIN CONFIG max_plan_length: 2 END CONFIG
"""
"""In `u0` the cheap way serves, in `u1` it is too long."""


@pytest.mark.parametrize("prover", get_args(ProverName))
def test_none_is_no_number(prover: ProverName) -> None:
    """Ranks that are 0 at the goal and null elsewhere are no proof that a cheaper set is too slow."""
    spec = parse(ONE_STEP_FROM_NONE)
    rows: dict[State, frozenset[int]] = {(state,): frozenset({action}) for state, action in enumerate((1, 3, 4, 5, 6))}
    rows[(5,)] = frozenset()
    builder = DiagramBuilder[int | None]((0,), (0, None))
    root = builder.from_table([6], {(5,): 0}, None)
    certificate = Certificate(builder.finish(), (RankedGoal(("P is t0",), (), root),))
    found = verify(policy_from_rows(spec, rows, "any", digest(spec), certificate), spec, prover=prover)
    assert [result.verdict for result in found.properties] == ["proved", "proved", "proved", "refuted"]


@pytest.mark.parametrize("largest", range(18))
def test_counts_are_compared_as_numbers_with_infinity(largest: int) -> None:
    """Beside powers of two, too: never is larger than everything, and one more than the largest is not never."""
    import z3

    from tumato_symbolic.verify.by_z3.step_counts import StepCounts

    counts = StepCounts(largest, z3.Context())
    every = [None, *range(largest + 1)]
    for one in every:
        for other in every:
            truth = other is not None and (one is None or one > other + 1)
            term = counts.exceeds_by_two(counts.code(one), counts.code(other))
            assert z3.is_true(z3.simplify(term)) == truth


@pytest.mark.parametrize("examine", [campaign.examine, unrealizable.examine])
def test_every_judge_tells_right_numbers_from_wrong_ones(
    examine: Callable[[int, int, Path], Tally], tmp_path: Path
) -> None:
    """Every prover and the checker agree with the explicit meaning, whatever became of the numbers."""
    total = Tally()
    for seed in range(5):
        total.add(examine(seed, 1, tmp_path))
    assert not total.complaints
    assert {right for _, _, right in total.kinds} == {False, True}
