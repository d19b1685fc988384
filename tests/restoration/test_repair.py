"""Decisions in unsafe states that serve each other's runs: repair, deviations, conflicts."""

from dataclasses import replace

import pytest

from tests.restoration.test_synthesis import decided
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import follow
from tumato_symbolic.spec import Spec

CROSSING = """
BEGIN STATE VECTOR state P can be {} END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
{}
action left duration: 1 controlled resources: R preconditions: P is middle nominal effects: P is left
action right duration: 2 controlled resources: R preconditions: P is middle nominal effects: P is right
END ACTIONS
BEGIN STATE RULES rule: P is left OR P is right END STATE RULES
BEGIN GOALS goal type: priority
{}
END GOALS
BEGIN CONFIG restoration: bounded END CONFIG
"""
IN = "action {0}_in duration: 1 controlled resources: R preconditions: P is {0} nominal effects: P is middle"


def crossing(**wanted: str) -> Spec:
    """States that lead into the middle, each with the side that it has to reach."""
    names = ", ".join([*wanted, "middle", "left", "right"])
    goals = "\n".join(f"when P is {name} then goal: P is {side}" for name, side in wanted.items())
    return parse(CROSSING.format(names, "\n".join(IN.format(name) for name in wanted), goals))


def test_a_worse_decision_serves_another_state() -> None:
    """The middle goes right, which takes longer, because the one state that passes through it has to get there."""
    rows, worst = decided(crossing(north="right"))
    assert worst == {(0,): (3, 2), (1,): (2, 1)}
    assert rows[(1,)] == frozenset((2,))


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_the_deviation_is_listed_with_the_run_that_would_miss(restoration: str) -> None:
    """With the better set in the middle, the run of the state that needs the other side misses its goal."""
    spec = replace(crossing(north="right"), restoration=restoration)  # type: ignore[arg-type]
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert outcome.policy.certificate is not None
    assert outcome.policy.certificate.restoring is not None
    deviations = outcome.policy.certificate.restoring.deviations
    assert deviations == (Deviation((1,), frozenset((1,)), (0,)),)
    rows, _ = decided(spec)
    changed = {**rows, (1,): frozenset((1,))}
    assert follow(spec, changed, (0,), rows[(0,)]).end != "goal"


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_states_that_no_policy_serves_together(restoration: str) -> None:
    """One has to pass through the middle to the left, the other to the right."""
    spec = replace(crossing(north="right", south="left"), restoration=restoration)  # type: ignore[arg-type]
    outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert [(each.kind, each.states) for each in outcome.failures] == [("conflict", ((0,), (1,)))]


LOOP = """
BEGIN STATE VECTOR state P can be a, b, c, home state Q can be no, yes END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action a_b controlled resources: R preconditions: P is a nominal effects: P is b, Q is yes alternative effects: P is c
action a_home duration: 5 controlled resources: R preconditions: P is a nominal effects: P is home
action b_a controlled resources: R preconditions: P is b nominal effects: P is home alternative effects: P is a
action b_home duration: 5 controlled resources: R preconditions: P is b nominal effects: P is home
action c_home controlled resources: R preconditions: P is c nominal effects: P is home
END ACTIONS
BEGIN STATE RULES rule: P is home END STATE RULES
BEGIN GOALS goal type: priority
when P is a AND Q is no then goal: Q is yes
END GOALS
BEGIN CONFIG restoration: bounded END CONFIG
"""


def test_a_loop_of_outcomes_is_avoided() -> None:
    """`a` has to go through `b` for its goal; so `b` must not risk to come back to it."""
    rows, _ = decided(parse(LOOP))
    assert rows[0, 0] == frozenset((0,))
    assert rows[1, 1] == frozenset((3,))
