"""Restoring safety in several steps, by severity, on small specifications (`docs/semantics.md`, sections 9 and 10)."""

import pytest
from msgspec.structs import replace

from tumato_symbolic import parse
from tumato_symbolic.semantics import (
    NOTHING,
    ActionSet,
    Restorations,
    State,
    allowed,
    is_safe,
    judge,
    level,
    required_rules,
)
from tumato_symbolic.spec import Restoration, Spec, digest

VALVES = """
BEGIN STATE VECTOR state A can be open, closed state B can be open, closed END STATE VECTOR
BEGIN ACTIONS
action close_a duration: 1 nominal effects: A is closed
action close_b duration: 1 nominal effects: B is closed
END ACTIONS
BEGIN STATE RULES rule: A is closed rule: B is closed END STATE RULES
"""
RETRY = """
BEGIN STATE VECTOR state M can be on, off END STATE VECTOR
BEGIN ACTIONS action stop duration: 1 nominal effects: M is off alternative effects: none END ACTIONS
BEGIN STATE RULES rule: M is off END STATE RULES
"""
EDGE = """
BEGIN STATE VECTOR state Place can be edge, floor state Arm can be out, in END STATE VECTOR
BEGIN ACTIONS
action retreat duration: 2 preconditions: Place is edge nominal effects: Place is floor, Arm is out
action fold duration: 1 preconditions: Place is floor, Arm is out nominal effects: Arm is in
END ACTIONS
BEGIN STATE RULES severity: {} rule: NOT Place is edge severity: {} rule: Arm is in END STATE RULES
"""
OVERRIDE = """
BEGIN STATE VECTOR state P can be s, t, x, y END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action to_t duration: 1 controlled resources: R preconditions: P is s nominal effects: P is t
action to_x duration: 1 controlled resources: R preconditions: P is t nominal effects: P is x
action to_y duration: 2 controlled resources: R preconditions: P is t nominal effects: P is y
END ACTIONS
BEGIN STATE RULES rule: P is x OR P is y END STATE RULES
BEGIN GOALS goal type: priority when P is s then goal: P is y END GOALS
"""
"""In `t`, `to_x` restores better than `to_y`; but the run from `s`, which passes through `t`, has to reach `y`."""
OPEN, CLOSED = 0, 1


def restoring(text: str, restoration: Restoration) -> Spec:
    """The specification of a text, with another way to restore safety."""
    return replace(parse(text), restoration=restoration)


def test_no_rule_breaks_that_was_not_broken() -> None:
    """`Keep`: one broken rule may stay broken while the other is mended; in one step both have to be."""
    one_step, bounded = restoring(VALVES, "one_step"), restoring(VALVES, "bounded")
    assert not allowed(one_step, (OPEN, OPEN), frozenset((0,)), "any")
    assert allowed(bounded, (OPEN, OPEN), frozenset((0,)), "any")
    assert allowed(bounded, (OPEN, OPEN), NOTHING, "any")
    assert not allowed(one_step, (OPEN, OPEN), NOTHING, "any")


def test_the_worst_effort_is_over_all_outcomes_in_any_order() -> None:
    """One valve after the other takes (2, 2); both at once may take effect one at a time, which makes (3, 2)."""
    spec = restoring(VALVES, "bounded")
    singly: dict[State, ActionSet] = {
        (0, 0): frozenset((0,)),
        (0, 1): frozenset((0,)),
        (1, 0): frozenset((1,)),
        (1, 1): NOTHING,
    }
    both: dict[State, ActionSet] = {**singly, (0, 0): frozenset((0, 1))}
    assert Restorations(spec, singly, "any").worst == {(0, 0): (2, 2), (0, 1): (1, 1), (1, 0): (1, 1)}
    assert Restorations(spec, both, "any").worst[0, 0] == (3, 2)
    assert judge(spec, singly, "any").sound_and_complete
    assert judge(spec, singly, "any").minimal
    assert judge(spec, both, "any").sound_and_complete
    assert judge(spec, both, "any").not_minimal == (((0, 0), frozenset((0,))),)


def test_what_may_change_nothing_restores_under_fair_only() -> None:
    """A stop that may do nothing is repeated: no number of steps is enough, and the nominal effect ends it."""
    policy: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): NOTHING}
    assert judge(restoring(RETRY, "bounded"), policy, "any").not_restored == ((0,),)
    assert judge(restoring(RETRY, "fair"), policy, "any").sound_and_complete
    idle: dict[State, ActionSet] = {(0,): NOTHING, (1,): NOTHING}
    assert judge(restoring(RETRY, "fair"), idle, "any").not_restored == ((0,),)


@pytest.mark.parametrize(("place", "arm", "fits"), [(1, 1, False), (1, 2, True), (2, 1, False), (3, 9, True)])
def test_a_milder_rule_may_break_while_a_severe_one_is_broken(place: int, arm: int, fits: bool) -> None:
    """Off the edge with the arm out: only where the edge is the more severe of the two."""
    spec = parse(EDGE.format(place, arm))
    assert allowed(spec, (0, 1), frozenset((0,)), "any") == fits


def test_levels() -> None:
    """The level of a state counts the tiers that it satisfies, the most severe first."""
    spec = parse(EDGE.format(1, 2))
    assert [level(spec, state) for state in [(0, 0), (0, 1), (1, 0), (1, 1)]] == [0, 0, 1, 2]
    assert [is_safe(spec, state) for state in [(0, 1), (1, 0), (1, 1)]] == [False, False, True]
    assert [rule.text for rule in required_rules(spec, (0, 1))] == ["NOT Place is edge"]
    assert len(required_rules(spec, (1, 1))) == 2


def test_only_the_order_of_severities_is_part_of_the_meaning() -> None:
    """`restoration` is recorded beside the digest, as the effect ordering is."""
    assert digest(parse(EDGE.format(1, 2))) == digest(parse(EDGE.format(3, 9)))
    assert digest(parse(EDGE.format(1, 2))) != digest(parse(EDGE.format(2, 1)))
    assert digest(restoring(VALVES, "fair")) == digest(parse(VALVES))
