"""Section 10 of docs/semantics.md: severities of state rules."""

import pytest

from tests.conformance.asking import efforts, failures, faults, policy, under_both
from tests.conformance.roles import Decider, Judge, Restorer, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, Decisions, text, world
from tumato_symbolic.semantics import all_states

RETREAT = (
    "action retreat duration: 2 preconditions: x is e nominal effects: x is f, y is o"
    " action fold duration: 1 preconditions: x is f, y is o nominal effects: y is i"
)


def edge(place: int, arm: int, restoration: str = "one_step", goals: str = "") -> str:
    """On the edge (e) or the floor (f), with the arm out (o) or in (i); who retreats from the edge puts it out."""
    return text(
        {"x": "ef", "y": "oi"},
        ACTIONS=RETREAT,
        STATE_RULES=f"severity: {place} rule: x is f severity: {arm} rule: y is i",
        CONFIG=f"restoration: {restoration}",
        **({"GOALS": f"goal type: priority {goals}"} if goals else {}),
    )


OFF: Decisions = {"eo": "retreat", "ei": "retreat", "fo": "fold", "fi": ""}


def levels(restorer: Restorer, asked_text: str) -> list[int]:
    """The levels of all states, as declared."""
    asked = world(asked_text)
    return [restorer.level(asked, state) for state in all_states(asked.spec)]


@rule("10.1")
def test_the_level_counts_the_severest_tiers_that_hold(restorer: Restorer) -> None:
    """Only the order of the numbers counts, not the place in the text; equal numbers are one tier."""
    assert levels(restorer, edge(1, 2)) == levels(restorer, edge(3, 9)) == [0, 0, 1, 2]
    assert levels(restorer, edge(2, 1)) == [0, 1, 0, 2]
    assert levels(restorer, edge(2, 2, "bounded")) == [0, 0, 0, 1]


@rule("10.1")
def test_a_severity_holds_for_the_rules_after_it(restorer: Restorer) -> None:
    """Where there is none it is 1."""
    rules = "rule: NOT x is a severity: 2 rule: NOT x is b rule: NOT x is c severity: 1 rule: NOT x is d"
    assert levels(restorer, text({"x": "abcds"}, ACTIONS="action go", STATE_RULES=rules)) == [0, 1, 1, 0, 2]


@rule("10.1")
def test_a_state_is_safe_that_satisfies_all_tiers(stepper: Stepper) -> None:
    """And that is valid."""
    for severities in ((1, 2), (2, 1)):
        assumed = f"{edge(*severities)}\nBEGIN ASSUMPTIONS assume: NOT (x is e AND y is i) END ASSUMPTIONS"
        for asked in under_both(stepper, assumed):
            assert (asked.valid(), asked.safe()) == ("eo fo fi", "fi")


@rule("10.2")
@pytest.mark.parametrize(("place", "arm", "fits"), [(1, 1, False), (1, 2, True), (2, 1, False), (3, 9, True)])
@pytest.mark.parametrize("restoration", ["one_step", "bounded"])
def test_a_milder_rule_may_break_while_a_severer_one_is_broken(
    stepper: Stepper, restoration: str, place: int, arm: int, fits: bool
) -> None:
    """The arm may come out on the way off the edge where the edge is the more severe of the two."""
    for asked in under_both(stepper, edge(place, arm, restoration)):
        assert asked.allows("ei", "retreat") == fits
        assert asked.allows("fo", "fold")


@rule("10.2")
def test_of_the_tier_that_is_broken_the_rules_that_hold_are_kept(stepper: Stepper) -> None:
    """As are those of severer ones; milder ones are not."""
    names = ("severe", "other", "mild")
    actions = " ".join(f"action break_{name} nominal effects: {name} is n" for name in names)
    rules = "severity: 1 rule: severe is y severity: 2 rule: first is y rule: other is y severity: 3 rule: mild is y"
    asked_text = text(
        {"severe": "yn", "first": "yn", "other": "yn", "mild": "yn"},
        ACTIONS=actions,
        STATE_RULES=rules,
        CONFIG="restoration: bounded",
    )
    for asked in under_both(stepper, asked_text):
        for state, broken in (("ynyy", "mild"), ("nyyy", "severe other mild"), ("yyyn", "mild"), ("yyyy", "")):
            assert [name for name in names if asked.allows(state, f"break_{name}")] == broken.split()


@rule("10.3")
def test_in_one_step_the_level_is_raised(judge: Judge) -> None:
    """By one tier at least, whatever happens: the nominal successor has to be there, and all outcomes."""
    assert faults(judge, edge(1, 2), OFF) == set()
    assert faults(judge, edge(1, 2), {**OFF, "fo": ""}) >= {"safe"}
    may_stay = edge(1, 2).replace("x is f, y is o", "x is f alternative effects: y is o")
    assert "safe" in faults(judge, may_stay, OFF)


@rule("10.3")
def test_efforts_belong_to_a_level(restorer: Restorer) -> None:
    """They are counted to where the level is raised, not to where all is safe."""
    for ordering in BOTH:
        assert efforts(restorer, edge(1, 2, "bounded"), OFF, ordering) == {"eo": (2, 1), "ei": (2, 1), "fo": (1, 1)}
        assert efforts(restorer, edge(1, 1, "bounded"), OFF, ordering) == {"eo": (3, 2), "ei": (3, 2), "fo": (1, 1)}


@rule("10.3")
def test_the_severe_rule_comes_first(decider: Decider) -> None:
    """Off the edge, then the arm; which must not come out where it is as severe, in one step or in several."""
    assert policy(decider, edge(1, 2)) == policy(decider, edge(1, 2, "bounded")) == OFF
    for severities in ((2, 1), (1, 1)):
        assert failures(decider, edge(*severities)) == {"no-allowed-set": "eo ei"}
        assert failures(decider, edge(*severities, "bounded")) == {"no-restoration": "ei"}


@rule("10.4")
def test_safe_states_stay_safe_with_respect_to_all_tiers(stepper: Stepper) -> None:
    """A mild rule is no wish."""
    actions = f"{RETREAT} action unfold nominal effects: y is o"
    for restoration in ("one_step", "bounded"):
        for asked in under_both(stepper, edge(1, 2, restoration).replace(RETREAT, actions)):
            assert asked.allowed("fi") == [""]


@rule("10.4")
@pytest.mark.parametrize("restoration", ["one_step", "bounded"])
def test_goals_count_in_safe_states_only(judge: Judge, restoration: str) -> None:
    """Not where the severe rules hold, and a mild one is broken."""
    goals = "when x is e then goal: {}"
    assert faults(judge, edge(1, 2, restoration, goals.format("x is f AND y is i")), OFF) == set()
    assert faults(judge, edge(1, 2, restoration, goals.format("x is f AND y is o")), OFF) == {"goals"}


@rule("10.4")
def test_no_goal_is_planned_where_a_mild_rule_is_broken(decider: Decider) -> None:
    """As above."""
    goals = "when x is e then goal: {}"
    for restoration in ("one_step", "bounded"):
        assert policy(decider, edge(1, 2, restoration, goals.format("x is f"))) == OFF
        assert failures(decider, edge(1, 2, restoration, goals.format("y is o"))) == {"no-plan": "eo ei"}
