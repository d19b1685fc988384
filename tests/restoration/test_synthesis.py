"""Synthesis where safety may take several steps to restore, against the explicit meaning and known answers."""

from collections import Counter
from collections.abc import Mapping

import pytest
from msgspec.structs import replace

from tests.restoration.campaign import Tally, examine, specifications
from tests.semantics.test_restoration import EDGE, RETRY, VALVES, restoring
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import as_table
from tumato_symbolic.report.failures import failure_text
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import Effort, Restorations, State, count_states, judge
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import verify_unrealizable

JUMP = """
BEGIN STATE VECTOR state P can be p0, p1, p2, p3, home END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action slide duration: 1 controlled resources: R preconditions: P is p0 nominal effects: P is p1
action jump duration: 9 controlled resources: R preconditions: P is p0 nominal effects: P is home
action go duration: 1 controlled resources: R preconditions: P is p1 nominal effects: P is home
action down duration: 1 controlled resources: R preconditions: P is p3 OR P is p2 nominal effects: P is p1
  alternative effects: P is p2
action wait duration: 0 controlled resources: R preconditions: P is p2 nominal effects: P is p1
END ACTIONS
BEGIN STATE RULES rule: P is home END STATE RULES
"""


def decided(spec: Spec) -> tuple[dict[State, frozenset[int]], Mapping[State, Effort]]:
    """The policy of a specification and its worst efforts, judged by the explicit meaning."""
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    table = as_table(outcome.policy, count_states(spec))
    assert table is not None
    rows = dict(table.rows)
    judgement = judge(spec, rows, spec.ordering)
    assert judgement.sound_and_complete
    assert judgement.minimal
    return rows, dict(Restorations(spec, rows, spec.ordering).worst)


@pytest.mark.parametrize("backend", ["cudd", "autoref"])
@pytest.mark.parametrize("seed", range(4000, 4003))
def test_generated(seed: int, backend: str) -> None:
    """Whether there is a policy, why states fail, and that a policy is right and minimal: as the meaning says."""
    tally = Tally()
    for name, spec in specifications(seed):
        for ordering in ("any", "first"):
            assert not list(examine(spec, ordering, tally, backend)), (name, ordering)  # type: ignore[arg-type]


def test_two_faults_are_mended_one_after_the_other() -> None:
    """The first declared of two valves is closed first: both at once may take effect one at a time, and take longer."""
    rows, worst = decided(restoring(VALVES, "bounded"))
    assert rows[0, 0] == frozenset((0,))
    assert worst == {(0, 0): (2, 2), (0, 1): (1, 1), (1, 0): (1, 1)}


def test_one_step_comes_before_several_and_then_the_duration() -> None:
    """A jump of duration 9 restores in one step what a slide of 1 begins to; then the worst duration decides."""
    rows, worst = decided(restoring(JUMP, "bounded"))
    assert rows[(0,)] == frozenset((1,))
    assert worst[(0,)] == (9, 1)
    assert worst[(3,)] == (2, 3)


def test_what_may_do_nothing_is_repeated_under_fair() -> None:
    """Under `bounded` there is no way back."""
    rows, worst = decided(restoring(RETRY, "fair"))
    assert (rows, worst) == ({(0,): frozenset((0,)), (1,): frozenset()}, {})
    outcome = synthesize(restoring(RETRY, "bounded"), certify=False)
    assert [(each.kind, each.count) for each in getattr(outcome, "failures", ())] == [("no-restoration", 1)]


@pytest.mark.parametrize(("severities", "realizable"), [((1, 2), True), ((2, 1), False), ((1, 1), False)])
def test_severe_rules_first(severities: tuple[int, int], realizable: bool) -> None:
    """The arm may come out on the way off the edge where the edge is more severe."""
    outcome = synthesize(parse(EDGE.format(*severities)), certify=False)
    assert isinstance(outcome, Realizable) == realizable


@pytest.mark.parametrize("name", ["amr", "coin", "concurrent", "grid3"])
def test_what_one_step_restores_is_decided_as_before(name: str, examples: dict[str, str]) -> None:
    """A policy under `one_step` is the policy under `bounded` and under `fair`."""
    spec = parse(examples[name])
    before = synthesize(spec)
    assert isinstance(before, Realizable)
    for restoration in ("bounded", "fair"):
        found = synthesize(replace(spec, restoration=restoration))
        assert isinstance(found, Realizable)
        assert found.policy.decisions == before.policy.decisions


def test_two_robots(examples: dict[str, str]) -> None:
    """112 states take more than one step: the distribution of worst efforts is known."""
    spec = replace(parse(examples["two_robots"]), restoration="bounded")
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    table = as_table(outcome.policy, count_states(spec))
    assert table is not None
    worst = Restorations(spec, table.rows, "any").worst
    assert Counter(worst.values()) == {(1, 1): 352, (2, 1): 64, (2, 2): 48, (3, 2): 48, (4, 3): 16}


def test_a_failure_is_told_with_what_was_meant() -> None:
    """The report says what no set does, under `bounded` and under `fair` (TUM404)."""
    stuck = RETRY.replace("nominal effects: M is off", "nominal effects: none")
    for restoration, told in (("bounded", "some outcomes never lead back"), ("fair", "never lead back to safety")):
        spec = restoring(stuck, restoration)  # type: ignore[arg-type]
        outcome = synthesize(spec, certify=False)
        assert isinstance(outcome, Unrealizable)
        text = failure_text(Place(spec, "spec.tum"), outcome.failures[0], "any")
        assert text.startswith("error[TUM404]: 1 state has no way back to safety")
        assert told in text


@pytest.mark.parametrize("seed", range(4100, 4102))
def test_what_has_a_certificate_is_proved(seed: int) -> None:
    """Traps, and what safe states have no set or no plan for: they are judged as in one step."""
    for name, spec in specifications(seed):
        outcome = synthesize(spec)
        if isinstance(outcome, Unrealizable) and outcome.certificate is not None:
            assert verify_unrealizable(outcome.certificate, spec).verdict == "proved", name


def test_a_reason_about_safe_states_says_nothing_of_unsafe_ones() -> None:
    """A certificate that one step restores nothing is none where several steps may be taken (TUM313)."""
    outcome = synthesize(parse(VALVES))
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    with pytest.raises(UserError, match="does not support"):
        verify_unrealizable(outcome.certificate, restoring(VALVES, "bounded"))
