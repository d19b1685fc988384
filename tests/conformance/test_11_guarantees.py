"""Section 11 of docs/semantics.md: what a policy guarantees beyond nominal runs."""

from itertools import pairwise

import pytest

from tests.conformance.asking import guaranteed
from tests.conformance.roles import Guarantor
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, Decisions, text

LINE = "abcd"


def way(moves: str, goals: str = "when NOT x is d then goal: x is d", **blocks: str) -> str:
    """Four places; `moves` are actions, each from one place: `ab` from a to b, `abc` to b or else to c, `aba` or not.

    Where nothing else is said, d is to be reached from everywhere.
    """
    actions = (
        f"action {move} preconditions: x is {move[0]} nominal effects: x is {move[1]} "
        + (f"alternative effects: x is {move[2]}" if move[2:] else "")
        for move in moves.split()
    )
    goals = f"goal type: priority {goals}"
    return text({"x": LINE}, ACTIONS=" ".join(actions), GOALS=goals, **blocks)


def moving(moves: str) -> Decisions:
    """Each move in the place from which it is, and nothing elsewhere."""
    return {place: next((move for move in moves.split() if move[0] == place), "") for place in LINE}


def along(guarantor: Guarantor, moves: str, *goals: str, **blocks: str) -> dict[str, str]:
    """What is guaranteed by these moves; the same under both orderings, for one acts at a time."""
    asked = way(moves, *goals, **blocks)
    found, other = (guaranteed(guarantor, asked, moving(moves), ordering) for ordering in BOTH)
    assert found == other
    return found


@rule("11.1")
def test_what_is_not_nominal_is_a_deviation(guarantor: Guarantor) -> None:
    """Another effect, and an action that is still to strike; an alternative that writes the same is none."""
    assert along(guarantor, "adb", "when x is a then goal: x is d")["a"] == "nominal"
    assert along(guarantor, "add", "when x is a then goal: x is d")["a"] == "guaranteed 1"
    both = text(
        {"x": "ab", "y": "ab"},
        ACTIONS="action p nominal effects: x is b action q nominal effects: y is b",
        GOALS="goal type: priority when x is a AND y is a then goal: x is b AND y is b",
    )
    for ordering in BOTH:
        rows: Decisions = {"aa": "p q", "ab": "", "ba": "", "bb": ""}
        assert guaranteed(guarantor, both, rows, ordering)["aa"] == "nominal"
        assert guaranteed(guarantor, both, {**rows, "ba": "q"}, ordering)["aa"] == "nominal"
        assert guaranteed(guarantor, both, {**rows, "ba": "q", "ab": "p"}, ordering)["aa"] == "guaranteed 2"


@rule("11.2")
def test_only_the_goal_of_the_state_counts(guarantor: Guarantor) -> None:
    """Not those of the states on the way: b wants c, and a passes both to come to d."""
    goals = "when x is a then goal: x is d when x is b then goal: x is c"
    found = along(guarantor, "ab bc cd", goals)
    assert found == {"a": "guaranteed 3", "b": "guaranteed 1", "c": "guaranteed 1", "d": "guaranteed 1"}


@rule("11.2")
def test_the_goal_is_met_after_a_step(guarantor: Guarantor) -> None:
    """Where it holds at the beginning, and the policy leaves, it has to be met again."""
    goals = "when x is a then goal: x is a"
    assert along(guarantor, "ab ba", goals)["a"] == "guaranteed 2"
    assert along(guarantor, "aab ba", goals)["a"] == "guaranteed 2"
    assert along(guarantor, "", goals)["a"] == "guaranteed 1"


@rule("11.2")
def test_no_plan_bound_counts(guarantor: Guarantor) -> None:
    """The nominal run is in time, and longer ones are guaranteed."""
    assert along(guarantor, "adb bd cd", CONFIG="max_plan_length: 1")["a"] == "guaranteed 2"
    assert along(guarantor, "ada bd cd", CONFIG="max_plan_length: 1")["a"] == "fair"


@rule("11.2")
@pytest.mark.parametrize(("rules", "steps"), [("rule: x is c OR x is d", 2), ("severity: 1 rule: NOT x is a", 1)])
def test_goals_are_met_in_safe_states(guarantor: Guarantor, rules: str, steps: int) -> None:
    """In b the predicate holds; it counts where b is safe."""
    blocks = {"STATE_RULES": rules, "CONFIG": "restoration: bounded"}
    assert along(guarantor, "adb bd", "when x is a then goal: NOT x is a", **blocks)["a"] == f"guaranteed {steps}"


@rule("11.3")
def test_a_nominal_state_meets_its_goal_if_nothing_deviates(guarantor: Guarantor) -> None:
    """The first deviation ends in c, where nobody goes on."""
    goals = "when x is a OR x is b then goal: x is d"
    found = along(guarantor, "abc bdc", goals)
    assert [found[place] for place in LINE] == ["nominal", "nominal", "guaranteed 1", "guaranteed 1"]


def leaking(*levels: str) -> str:
    """Whoever goes (x from s to g) may lose a level of the tank (y) instead; at the last level there is no goal."""
    actions = (
        f"action go_{here} preconditions: x is s, y is {here} nominal effects: x is g alternative effects: y is {there}"
        for here, there in pairwise(levels)
    )
    wish = f"goal type: priority when NOT y is {levels[-1]} then goal: x is g"
    return text({"x": "sg", "y": "".join(levels)}, ACTIONS=" ".join(actions), GOALS=wish)


@rule("11.4")
def test_deviations_are_counted_over_the_whole_run(guarantor: Guarantor) -> None:
    """From a tank with three levels two leaks are survived, and no third."""
    rows: Decisions = {f"s{level}": f"go_{level}" for level in "abc"} | {"sd": ""} | {f"g{level}": "" for level in LINE}
    for ordering in BOTH:
        found = guaranteed(guarantor, leaking(*LINE), rows, ordering)
        assert [found[f"s{level}"] for level in LINE] == ["survives 2", "survives 1", "nominal", "guaranteed 1"]


@rule("11.4")
def test_deviations_on_the_nominal_run_count(guarantor: Guarantor) -> None:
    """Also after a first step that is sure. From b, c is a dead end."""
    goals = "when x is a OR x is b then goal: x is d"
    assert along(guarantor, "ab bdc", goals)["a"] == "nominal"
    assert along(guarantor, "adb bdc", goals)["a"] == "survives 1"


@rule("11.5")
def test_a_fair_state_meets_its_goal_once_deviations_stop(guarantor: Guarantor) -> None:
    """What may change nothing, and what may lead round in a circle, goes on as long as it deviates."""
    assert along(guarantor, "ada bd cd")["a"] == "fair"
    assert along(guarantor, "abd bca cda") == {"a": "fair", "b": "fair", "c": "fair", "d": "guaranteed 1"}


@rule("11.6")
def test_a_guaranteed_state_meets_its_goal_whatever_happens(guarantor: Guarantor) -> None:
    """All outcomes of all steps lead on; one that may come back is enough for less."""
    assert set(along(guarantor, "abc bdc cd").values()) == {"guaranteed 3", "guaranteed 2", "guaranteed 1"}
    assert along(guarantor, "abc bdc cdc")["a"] == "fair"


@rule("11.7")
def test_the_worst_number_of_steps(guarantor: Guarantor) -> None:
    """Of all outcomes; nominally it is one step."""
    found = along(guarantor, "adb bc cd")
    assert [found[place] for place in LINE] == [f"guaranteed {steps}" for steps in (3, 2, 1, 1)]


@rule("11.8")
@pytest.mark.parametrize(
    ("moves", "wanting", "strongest"),
    [("ad", "a", "guaranteed 1"), ("ada", "a", "fair"), ("adb bdc", "ab", "survives 1"), ("adc", "a", "nominal")],
)
def test_each_guarantee_implies_the_weaker_ones(guarantor: Guarantor, moves: str, wanting: str, strongest: str) -> None:
    """The strongest is told; and there is one wherever the nominal run meets the goal."""
    found = along(guarantor, moves, f"when {' OR '.join(f'x is {each}' for each in wanting)} then goal: x is d")
    assert found["a"] == strongest
    assert "nothing" not in found.values()
