"""Mistakes that a synthesizer may make about restoring safety, each refuted by every prover."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from tests.semantics.test_restoration import EDGE, RETRY, VALVES
from tests.verify.several_steps import Rows, certified, exact
from tests.verify.test_several_steps import PROVERS, judged_by
from tumato_symbolic import parse
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Restoration
from tumato_symbolic.verify import ProverName, verify

NOTHING, FIRST, SECOND = frozenset[int](), frozenset((0,)), frozenset((1,))
SWAP = VALVES.replace("nominal effects: A is closed", "nominal effects: A is closed, B is open")
"""Closing one valve opens the other."""
RISKY = """
BEGIN STATE VECTOR state P can be low, high, ground END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action drop duration: 1 controlled resources: R nominal effects: P is ground alternative effects: P is high
action land duration: 4 controlled resources: R nominal effects: P is ground
action climb_down duration: 9 controlled resources: R preconditions: P is high nominal effects: P is ground
END ACTIONS
BEGIN STATE RULES rule: P is ground END STATE RULES
"""
"""Dropping from low takes 1 step, or 10 where it goes wrong."""

VALVES_ROWS: Rows = {(0, 0): FIRST, (0, 1): FIRST, (1, 0): SECOND, (1, 1): NOTHING}
EDGE_ROWS: Rows = {(0, 0): FIRST, (0, 1): FIRST, (1, 0): SECOND, (1, 1): NOTHING}
DROPS: Rows = {(0,): FIRST, (1,): frozenset((2,)), (2,): NOTHING}
LANDS: Rows = {(0,): SECOND, (1,): SECOND, (2,): NOTHING}
DROPS_LAST: Rows = {(0,): FIRST, (1,): SECOND, (2,): NOTHING}


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize(
    ("text", "restoration", "rows", "refuted"),
    [
        (VALVES, "bounded", VALVES_ROWS, []),
        (VALVES, "bounded", {**VALVES_ROWS, (0, 0): frozenset((0, 1))}, ["minimal"]),
        (VALVES, "bounded", {**VALVES_ROWS, (0, 1): SECOND}, ["restoring", "goals", "minimal"]),
        (RETRY, "bounded", {(0,): FIRST, (1,): NOTHING}, ["restoring"]),
        (RETRY, "fair", {(0,): FIRST, (1,): NOTHING}, []),
        (RETRY, "fair", {(0,): NOTHING, (1,): NOTHING}, ["restoring", "goals", "minimal"]),
        (RISKY, "bounded", LANDS, []),
        (RISKY, "bounded", DROPS, ["minimal"]),
        (RISKY, "bounded", DROPS_LAST, ["minimal"]),
        (SWAP, "bounded", VALVES_ROWS, ["safe"]),
        (EDGE.format(1, 2), "one_step", EDGE_ROWS, []),
        (EDGE.format(2, 1), "one_step", EDGE_ROWS, ["safe"]),
        (EDGE.format(1, 1), "bounded", EDGE_ROWS, ["safe"]),
        (EDGE.format(1, 2), "one_step", {**EDGE_ROWS, (1, 0): NOTHING}, ["safe", "restoring", "goals", "minimal"]),
    ],
)
def test_policies(text: str, restoration: Restoration, rows: Rows, refuted: list[str], prover: ProverName) -> None:
    """Outcomes that are forgotten, rules that break on the way, severities the wrong way round, dear ways."""
    spec = replace(parse(text), restoration=restoration)
    answer = verify(certified(spec, rows, exact(spec, rows, "any")), spec, prover=prover, restoration=restoration)
    found = [result.name for result in answer.properties if result.verdict == "refuted"]
    assert set(refuted) <= set(found)
    assert bool(found) == bool(refuted)
    assert answer.verdict == ("refuted" if refuted else "proved")


DESCENT = """
BEGIN STATE VECTOR state P can be a, b, c, d END STATE VECTOR
BEGIN ACTIONS
action ab duration: 1 preconditions: P is a nominal effects: P is b alternative effects: none
action bc duration: 1 preconditions: P is b nominal effects: P is c alternative effects: none
action cd duration: 1 preconditions: P is c nominal effects: P is d alternative effects: none
END ACTIONS
BEGIN STATE RULES severity: 1 rule: NOT P is b severity: 2 rule: P is d END STATE RULES
"""


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize(("last", "refuted"), [(2, {"safe"}), (None, {"safe", "restoring", "goals", "minimal"})])
def test_runs_through_a_lower_level(last: int | None, refuted: set[str], prover: ProverName) -> None:
    """From a to b a severer rule breaks; what is restored all the same, and what is not, is known."""
    spec = replace(parse(DESCENT), restoration="fair")
    rows: dict[State, ActionSet] = {(place,): frozenset((place,)) for place in range(2)}
    rows |= {(2,): NOTHING if last is None else frozenset((last,)), (3,): NOTHING}
    for said in (policy_from_rows(spec, rows), certified(spec, rows, exact(spec, rows, "any"))):
        answer = judged_by(spec, rows, "any", said, prover)
        assert {result.name for result in answer.properties if result.verdict == "refuted"} == refuted


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize(
    ("state", "effort", "status"),
    [((0,), (1, 1), "wrong"), ((0,), (8, 2), "incomplete"), ((0,), (5, 2), "used"), ((1,), (0, 1), "wrong")],
)
def test_the_worst_outcome_is_not_the_nominal_one(
    state: State, effort: tuple[int, int], status: str, prover: ProverName
) -> None:
    """An effort of dropping that forgets the fall, and right or careful ones."""
    spec = replace(parse(RISKY), restoration="bounded")
    ranks, worst, nominal, deviations = exact(spec, DROPS_LAST, "any")
    policy = certified(spec, DROPS_LAST, (ranks, {**worst, state: effort}, nominal, deviations))
    assert verify(policy, spec, prover=prover, restoration="bounded").certificate.status == status
