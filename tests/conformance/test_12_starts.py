"""Section 12 of docs/semantics.md: start states."""

import pytest

from tests.conformance.asking import failures, faults, policy
from tests.conformance.roles import Decider, Judge, Reader
from tests.conformance.rules import rule
from tests.conformance.test_5_policies import moves
from tests.conformance.test_7_none import CONFLICT
from tests.conformance.world import BOTH, text
from tumato_symbolic.spec import Ordering


def begun(asked: str, *conditions: str) -> str:
    """A specification with start conditions."""
    return asked + "\nBEGIN START " + " ".join(f"start: {each}" for each in conditions) + " END START"


FORK = text(
    {"x": "abcd"},
    ACTIONS="action quick preconditions: x is a nominal effects: x is c alternative effects: x is d"
    f" action slow preconditions: x is a nominal effects: x is b {moves('bc')}",
    GOALS="goal type: priority goal: x is c",
)
"""From a there is a quick way to c, which may end in d, and a way by b. Nothing leads out of d."""


@rule("12.1")
def test_start_conditions_that_no_valid_state_satisfies_are_an_error(reader: Reader) -> None:
    """A state that is not valid is no start; one condition that is satisfied will do."""
    block = {"ASSUMPTIONS": "assume: NOT x is b"}
    plain = text({"x": "abc"}, **block)
    assert reader.refuses(begun(plain, "x is b"))
    assert not reader.refuses(begun(plain, "x is b", "x is a"))
    assert not reader.refuses(begun(plain))


@rule("12.1")
def test_without_start_conditions_every_valid_state_is_a_start(judge: Judge) -> None:
    """An empty block has none; two conditions have the starts of either."""
    plain = text({"x": "abc"}, ACTIONS=moves("ab"))
    assert faults(judge, begun(plain), {"a": "", "b": ""}) == {"total"}
    assert faults(judge, begun(plain, "x is a"), {"a": "", "b": ""}) == set()
    assert faults(judge, begun(plain, "x is a", "x is b"), {"b": ""}) == {"total"}
    assert faults(judge, begun(plain, "x is a", "x is b"), {"a": "", "b": ""}) == set()


@rule("12.2")
@pytest.mark.parametrize("ordering", BOTH)
def test_no_outcome_of_a_decision_is_undecided(judge: Judge, ordering: Ordering) -> None:
    """Neither the nominal successor nor any other; what is asked is asked in decided states."""
    asked = begun(FORK, "x is a")
    assert faults(judge, asked, {"a": "slow", "b": "bc", "c": ""}, ordering) == set()
    assert faults(judge, asked, {"a": "quick", "b": "bc", "c": ""}, ordering) == {"safe"}
    assert "safe" in faults(judge, asked, {"a": "slow", "c": ""}, ordering)
    assert faults(judge, asked, {"a": "quick", "b": "bc", "c": "", "d": ""}, ordering) == {"goals"}


@rule("12.2")
@pytest.mark.parametrize("ordering", BOTH)
def test_a_cheaper_set_that_leaves_the_part_is_no_rival(judge: Judge, ordering: Ordering) -> None:
    """Where the state that it may lead to is decided as well, it is one."""
    asked = begun(
        text(
            {"x": "uvwz"},
            ACTIONS="action cheap duration: 1 preconditions: x is u nominal effects: x is v alternative effects: x is w"
            " action dear duration: 2 preconditions: x is u nominal effects: x is v",
            STATE_RULES="rule: NOT x is u",
        ),
        "x is u",
    )
    assert faults(judge, asked, {"u": "dear", "v": ""}, ordering) == set()
    assert faults(judge, asked, {"u": "dear", "v": "", "w": ""}, ordering) == {"minimal"}
    assert faults(judge, asked, {"u": "cheap", "v": "", "w": ""}, ordering) == set()


@rule("12.2")
@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_the_part_is_closed_where_safety_takes_several_steps(judge: Judge, restoration: str) -> None:
    """An unsafe state on the way back is decided too."""
    asked = begun(
        text(
            {"x": "abcd"},
            ACTIONS=moves("ab", "bc"),
            STATE_RULES="rule: x in {c, d}",
            CONFIG=f"restoration: {restoration}",
        ),
        "x is a",
    )
    assert faults(judge, asked, {"a": "ab", "b": "bc", "c": ""}) == set()
    assert "safe" in faults(judge, asked, {"a": "ab", "c": ""})


@rule("12.3")
@pytest.mark.parametrize("ordering", BOTH)
def test_every_start_is_decided_and_only_valid_states_are(judge: Judge, ordering: Ordering) -> None:
    """More than the starts may be."""
    asked = begun(text({"x": "abcd"}, ACTIONS=moves("ab"), ASSUMPTIONS="assume: NOT x is d"), "x in {a, b}")
    assert faults(judge, asked, {"a": "ab", "b": ""}, ordering) == set()
    assert faults(judge, asked, {"a": "", "b": "", "c": ""}, ordering) == set()
    assert faults(judge, asked, {"b": ""}, ordering) == {"total"}
    assert faults(judge, asked, {"a": "ab", "b": "", "d": ""}, ordering) == {"total"}


@rule("12.4")
@pytest.mark.parametrize("ordering", BOTH)
def test_the_greatest_part_is_decided(decider: Decider, ordering: Ordering) -> None:
    """What fails is left out, then what fails without it; what no start leads to is decided all the same."""
    assert failures(decider, FORK, ordering) == {"no-plan": "d"}
    assert policy(decider, begun(FORK, "x is a"), ordering) == {"a": "slow", "b": "bc", "c": ""}
    assert policy(decider, begun(FORK, "x is c"), ordering) == {"a": "slow", "b": "bc", "c": ""}
    only_quick = FORK.replace("nominal effects: x is b", "nominal effects: x is d")
    assert policy(decider, begun(only_quick, "x is b"), ordering) == {"b": "bc", "c": ""}


@rule("12.4")
def test_where_goals_conflict_a_largest_part_is_decided(decider: Decider) -> None:
    """It has all starts."""
    assert policy(decider, begun(CONFLICT, "x is l")).keys() == set("lmLR")
    assert policy(decider, begun(CONFLICT, "x is r"))["m"] == "mL"
    assert policy(decider, begun(CONFLICT, "x is l"))["m"] == "mR"


@rule("12.5")
@pytest.mark.parametrize("ordering", BOTH)
def test_a_start_that_is_left_out_fails(decider: Decider, ordering: Ordering) -> None:
    """For the reason for which it is left out, be it one of its own or that of others."""
    assert failures(decider, begun(FORK, "x in {a, d}"), ordering) == {"no-plan": "d"}
    only_quick = FORK.replace("nominal effects: x is b", "nominal effects: x is d")
    assert failures(decider, begun(only_quick, "NOT x is c"), ordering) == {"no-plan": "a d"}
    assert failures(decider, begun(only_quick, "x is b"), ordering) == {}


@rule("12.5")
def test_goals_of_starts_conflict(decider: Decider) -> None:
    """Of starts that no part with a policy has together; each alone has one."""
    assert failures(decider, begun(CONFLICT, "x in {l, r}")) == {"conflict": "l r"}
    assert failures(decider, begun(CONFLICT, "x in {l, m, L}")) == {}
