"""*No plan*: the stand-alone checker accepts layers that are a proof, and nothing that is one step off."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.checker.unrealizable import Document, assert_proved, assert_refuted, judged, spec_text


def line(bound: int | None, steps: str = "ab bc cd") -> str:
    """Four places in a row: it takes three steps from `a` to the goal `d`."""
    return spec_text("abcd", steps, "BEGIN GOALS goal type: priority goal: P is d END GOALS", bound)


def layers(*sets: str, start: str = "a", body: str = "P is d") -> Document:
    """Layers by their places, for one goal."""
    nodes = [[0, [int(place in held) for place in "abcd"]] for held in sets]
    goal = {"Bodies": [body], "Executed": [], "Layers": [2 + number for number in range(len(sets))]}
    state = {"P": start}
    diagram = {"Order": ["P"], "Leaves": [False, True], "Nodes": nodes}
    return {"Kind": "no-plan", "State": state, **diagram, "Goals": [goal]}


RIGHT = [(1, "ab"), (1, "abc"), (2, "ab c"), (2, "ab abc"), (2, "ab bc")]
WRONG = [
    (3, "ab abc", "from layer 2, in (P c), {cd} (duration 0) leads to (P d), which is not in layers 1 to 2"),
    (None, "ab abc", "from layer 2, in (P c)"),
    (2, "ab", "from layer 1, in (P b), {bc} (duration 0) leads to (P c), which is not in layers 1 to 1"),
    (2, "abc abc", "from layer 1, in (P c)"),
    (2, "abc ab", "from layer 1, in (P c)"),
    (2, "c ab", "which is not in layer 1"),
    (2, "b abc", "in (P a), {} (duration 0) leads to (P a), which is not in layer 1"),
    (2, "a abc", "in (P a), {ab} (duration 0) leads to (P b), which is not in layer 1"),
    (2, "ab ab", "from layer 1, in (P b)"),
    (2, "ab b abc", "from layer 1, in (P b)"),
    (2, "ab abc abc", "from layer 2, in (P c)"),
    (3, "ab abc abcd", "the state (P d) of layer 3 meets (P is d)"),
    (1, "abd", "the state (P d) of layer 1 meets (P is d)"),
]


@pytest.mark.parametrize(("bound", "sets"), RIGHT)
def test_layers_that_are_a_proof(bound: int | None, sets: str, tmp_path: Path) -> None:
    """As many layers as steps are allowed, whether they overlap or not."""
    assert_proved(judged(tmp_path, line(bound), layers(*sets.split())))


@pytest.mark.parametrize(("bound", "sets", "why"), WRONG)
def test_layers_that_are_no_proof(bound: int | None, sets: str, why: str, tmp_path: Path) -> None:
    """One step more, a layer less, layers in the wrong order, a state less, a state that meets the goal."""
    assert_refuted(judged(tmp_path, line(bound), layers(*sets.split())), why)


@pytest.mark.parametrize("bound", [None, 2, 9])
def test_a_closed_set_is_a_proof_for_every_bound(bound: int | None, tmp_path: Path) -> None:
    """Where no way leads to the goal, one layer that no step leaves is enough."""
    text = line(bound, "ab ba cd")
    assert_proved(judged(tmp_path, text, layers("ab")))
    assert_proved(judged(tmp_path, text, layers("ab", "ab")))
    assert_refuted(judged(tmp_path, text, layers("ab", start="c")), "which is not in layer 1")
    assert_refuted(judged(tmp_path, text, layers("ab", start="d")), "which is not in layer 1")


def test_every_possible_residual_goal_needs_layers(tmp_path: Path) -> None:
    """Those that depend on the first action, too; an entry twice counts twice."""
    goal = "BEGIN GOALS goal type: priority goal: P is d OR executing ab AND P is c END GOALS"
    text = spec_text("abcd", "ab bc cd", goal, 1)
    reason = layers("ab", body="(P is d) OR ((executing ab) AND (P is c))")
    entry = reason["Goals"][0]

    def judge(*entries: Document) -> None:
        assert_proved(judged(tmp_path, text, {**reason, "Goals": list(entries)}))

    def refute(why: str, *entries: Document) -> None:
        assert_refuted(judged(tmp_path, text, {**reason, "Goals": list(entries)}), why)

    executing = {**entry, "Executed": ["ab"]}
    judge(entry, executing)
    judge(executing, entry, executing)
    judge(executing, {**entry, "Executed": ["bc"]})
    refute("leaves ((P is d) OR ((executing ab) AND (P is c))) while executing ab pending, which is not listed", entry)
    refute("which is not listed", executing)
    refute("which is not listed", executing, {**executing, "Executed": ["ab", "cd"]})
    refute("which is not listed")
    refute("which is not in layer 1", entry, executing, {**entry, "Layers": [0]})
    refute("there is no such goal", entry, executing, {**entry, "Bodies": ["P is c"]})
    refute("of layer 1 meets no goal", entry, executing, {**entry, "Bodies": []})


def test_a_goal_that_the_first_action_met_is_met(tmp_path: Path) -> None:
    """The same layers are no proof where the residual goal holds in one of their states."""
    goal = "BEGIN GOALS goal type: priority goal: P is d OR executing ab AND P is b END GOALS"
    text = spec_text("abcd", "ab bc cd", goal, 1)
    reason = layers("ab", body="(P is d) OR ((executing ab) AND (P is b))")
    reason["Goals"].append({**reason["Goals"][0], "Executed": ["ab"]})
    assert_refuted(judged(tmp_path, text, reason), "the state (P b) of layer 1 meets")


def test_what_layers_say_of_unsafe_states_means_nothing(tmp_path: Path) -> None:
    """No run comes there, so a layer may hold one that meets the goal, or lack one."""
    text = line(None) + "BEGIN STATE RULES rule: NOT P is d END STATE RULES"
    for held in ("abc", "abcd"):
        assert_proved(judged(tmp_path, text, layers(held)))


def test_a_state_that_is_not_valid_proves_nothing(tmp_path: Path) -> None:
    """A policy need not decide there."""
    text = line(1) + "BEGIN ASSUMPTIONS assume: NOT P is a END ASSUMPTIONS"
    assert_refuted(judged(tmp_path, text, layers("ab")), "the state (P a) is not valid")
    nothing = {"Kind": "no-allowed-set", "State": {"P": "a"}, "Cubes": None}
    assert_refuted(judged(tmp_path, text, nothing), "the state (P a) is not valid")
