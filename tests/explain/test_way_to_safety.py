"""Tests of `why` where safety may take several steps to restore."""

import pytest

from tests.semantics.test_restoration import CLOSED, EDGE, OPEN, RETRY, VALVES, restoring
from tumato_symbolic import parse
from tumato_symbolic.explain.decision import alternative, why
from tumato_symbolic.report.decided import Decided, as_json, as_text
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import NOTHING, ActionSet, Restorations, State, all_states, is_safe
from tumato_symbolic.spec import Spec

CLOSE_A, CLOSE_B, BOTH = frozenset((0,)), frozenset((1,)), frozenset((0, 1))
SINGLY: dict[State, ActionSet] = {
    (OPEN, OPEN): CLOSE_A,
    (OPEN, CLOSED): CLOSE_A,
    (CLOSED, OPEN): CLOSE_B,
    (CLOSED, CLOSED): NOTHING,
}


def text(spec: Spec, policy: dict[State, ActionSet], state: State) -> str:
    """The report of one decision."""
    return as_text(Decided(Place(spec, "spec.tum"), "policy.json", why(spec, policy, state, "any"), None))


def test_the_worst_case_is_told_step_by_step() -> None:
    """The efforts of the way are the worst effort that the explicit meaning gives to the state."""
    spec = restoring(VALVES, "bounded")
    worst = Restorations(spec, SINGLY, "any").worst
    for state in all_states(spec):
        way = why(spec, SINGLY, state, "any").way
        assert (way is None) == is_safe(spec, state)
        assert way is None or (way.effort == worst[state] and way.bounded)
    assert "in at most 2 steps, duration 2, whatever happens" in text(spec, SINGLY, (OPEN, OPEN))


@pytest.mark.parametrize(("other", "verdict"), [(NOTHING, "endless"), (CLOSE_B, "later"), (BOTH, "costlier")])
def test_other_sets_are_judged_by_how_they_restore(other: ActionSet, verdict: str) -> None:
    """Doing nothing restores nothing; both valves at once may take effect one at a time, and then take longer."""
    assert alternative(restoring(VALVES, "bounded"), SINGLY, (OPEN, OPEN), other, "any").verdict == verdict


def test_a_set_that_is_repeated_is_told_as_such() -> None:
    """Under `fair`, what may do nothing is tried again; under `bounded` it may never restore safety."""
    policy: dict[State, ActionSet] = {(0,): CLOSE_A, (1,): NOTHING}
    assert "if every effect is the nominal one; else the policy tries again" in text(
        restoring(RETRY, "fair"), policy, (0,)
    )
    assert "may never restore safety from here" in text(restoring(RETRY, "bounded"), policy, (0,))


def test_levels_are_told() -> None:
    """The level of an unsafe state, and the rules that come first; the way goes on until the state is safe."""
    spec = parse(EDGE.format(1, 2))
    policy: dict[State, ActionSet] = {(0, 0): CLOSE_A, (0, 1): CLOSE_A, (1, 0): CLOSE_B, (1, 1): NOTHING}
    told = text(spec, policy, (0, 1))
    assert "Its level is 0 of 2: rules of severity 1 come first." in told
    assert "2. {fold}: all nominal effects; safe" in told
    found = as_json(Decided(Place(spec, "spec.tum"), "policy.json", why(spec, policy, (0, 1), "any"), None))
    assert found["restoring"] == {
        "level": 0,
        "levels": 2,
        "bounded": True,
        "duration": 3,
        "steps": [
            {"actions": ["retreat"], "state": {"Place": "floor", "Arm": "out"}},
            {"actions": ["fold"], "state": {"Place": "floor", "Arm": "in"}},
        ],
    }
