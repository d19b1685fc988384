"""Section 5 of docs/semantics.md: when a policy is sound, complete and minimal."""

import pytest

from tests.conformance.asking import failures, faults, policy
from tests.conformance.roles import Decider, Judge, Reader
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, Decisions, text, world
from tumato_symbolic.spec import Ordering


def moves(*steps: str) -> str:
    """Actions from one value of x to another: `ab` leads from a to b."""
    return " ".join(f"action {a}{b} preconditions: x is {a} nominal effects: x is {b}" for a, b in map(tuple, steps))


def line(bound: int | None = None, goal: str = "x is d") -> str:
    """Four places in a row, one step at a time."""
    config = {} if bound is None else {"CONFIG": f"max_plan_length: {bound}"}
    return text({"x": "abcd"}, ACTIONS=moves("ab", "bc", "cd"), GOALS=f"goal type: priority goal: {goal}", **config)


ALONG: Decisions = {"a": "ab", "b": "bc", "c": "cd", "d": ""}


@rule("5.1")
@pytest.mark.parametrize("ordering", BOTH)
def test_a_policy_decides_every_valid_state_and_may_decide_nothing_else(judge: Judge, ordering: Ordering) -> None:
    """What it says of states that are not valid is ignored; the empty set is a decision."""
    asked = text({"x": "abc"}, ACTIONS=moves("ab"), ASSUMPTIONS="assume: NOT x is c")
    assert faults(judge, asked, {"a": "", "b": ""}, ordering) == set()
    assert faults(judge, asked, {"a": "", "b": "", "c": "ab"}, ordering) == set()
    assert faults(judge, asked, {"a": ""}, ordering) == {"total"}
    assert faults(judge, asked, {"b": "", "c": ""}, ordering) == {"total"}


@rule("5.2")
@pytest.mark.parametrize("ordering", BOTH)
def test_every_decision_is_allowed(judge: Judge, ordering: Ordering) -> None:
    """A set that is allowed elsewhere is no excuse, nor is a goal that is reached."""
    asked = text({"x": "abc"}, ACTIONS=moves("ab", "ba", "ca", "cb"), STATE_RULES="rule: NOT x is c")
    assert faults(judge, asked, {"a": "ab", "b": "ba", "c": "ca"}, ordering) == set()
    assert faults(judge, asked, {"a": "ab", "b": "ab", "c": "ca"}, ordering) == {"safe"}
    assert faults(judge, asked, {"a": "ab", "b": "ba", "c": ""}, ordering) == {"safe"}


@rule("5.2")
def test_a_policy_is_found_only_where_every_state_has_an_allowed_set(decider: Decider) -> None:
    """One state without one is enough."""
    for steps, failing in ((("ca",), {}), (("ab",), {"no-allowed-set": "c"})):
        asked = text({"x": "abc"}, ACTIONS=moves(*steps), STATE_RULES="rule: NOT x is c")
        assert failures(decider, asked) == failing


@rule("5.3")
def test_every_run_reaches_its_goal(judge: Judge) -> None:
    """A run that stops on the way, or goes round, never does."""
    assert faults(judge, line(), ALONG) == set()
    assert faults(judge, line(), {**ALONG, "b": ""}) == {"goals"}
    ring = text({"x": "abc"}, ACTIONS=moves("ab", "ba", "bc"), GOALS="goal type: priority goal: x is c")
    assert faults(judge, ring, {"a": "ab", "b": "ba", "c": ""}) == {"goals"}
    assert faults(judge, ring, {"a": "ab", "b": "bc", "c": ""}) == set()


@rule("5.3")
def test_a_goal_takes_one_step_at_least(judge: Judge) -> None:
    """Where it holds already, it has to hold again after a step, or later."""
    asked = text(
        {"x": "abc"}, ACTIONS=moves("ab", "ba", "bc"), GOALS="goal type: priority when x is a then goal: x is a"
    )
    for at_a, at_b, fails in (("", "bc", False), ("ab", "ba", False), ("ab", "bc", True), ("ab", "", True)):
        assert faults(judge, asked, {"a": at_a, "b": at_b, "c": ""}) == ({"goals"} if fails else set())


@rule("5.3")
@pytest.mark.parametrize("there", [True, False])
def test_a_goal_that_holds_already_is_met_after_a_step(decider: Decider, there: bool) -> None:
    """Where the state has to be left, the run has to come back: b serves a, though it has no goal itself."""
    asked = text(
        {"x": "abc"},
        ACTIONS=moves("ab", "ba" if there else "bc"),
        REACTION_RULES="rule: IF x is a THEN executing ab",
        GOALS="goal type: priority when x is a then goal: x is a",
    )
    if there:
        assert policy(decider, asked) == {"a": "ab", "b": "ba", "c": ""}
    else:
        assert failures(decider, asked) == {"no-plan": "a"}


@rule("5.3")
def test_the_goals_are_those_of_the_first_state(judge: Judge) -> None:
    """Those that are active on the way play no part, and neither do actions that are executed later."""
    block = "goal type: priority when x is a then goal: x is c AND NOT executing bc when x is b then goal: executing bc"
    asked = text({"x": "abc"}, ACTIONS=moves("ab", "bc") + " action stay", GOALS=block)
    assert faults(judge, asked, {"a": "ab", "b": "bc", "c": ""}) == set()
    assert faults(judge, asked, {"a": "ab", "b": "bc stay", "c": ""}) == set()
    assert faults(judge, asked, {"a": "ab", "b": "", "c": ""}) == {"goals"}
    assert faults(judge, asked, {"a": "stay", "b": "bc", "c": ""}) == {"goals"}


@rule("5.3")
def test_all_goals_hold_in_one_state_of_the_run(judge: Judge) -> None:
    """One after the other is not enough."""
    block = "goal type: constraint when x is a then goal: NOT x is a when x is a then goal: x is {}"
    for wanted, fails in (("c", False), ("d", True)):
        asked = text({"x": "abcd"}, ACTIONS=moves("ab", "bc"), GOALS=block.format(wanted))
        assert faults(judge, asked, {"a": "ab", "b": "bc", "c": "", "d": ""}) == ({"goals"} if fails else set())
    both = text({"x": "abc"}, ACTIONS=moves("ab", "bc"), GOALS=block.replace("NOT x is a", "x is b").format("c"))
    assert faults(judge, both, {"a": "ab", "b": "bc", "c": ""}) == {"goals"}


@rule("5.4")
@pytest.mark.parametrize(("bound", "fails"), [(None, False), (4, False), (3, False), (2, True), (1, True)])
def test_a_run_has_at_most_as_many_steps_as_the_bound(judge: Judge, bound: int | None, fails: bool) -> None:
    """Exactly as many are in time."""
    assert faults(judge, line(bound), ALONG) == ({"goals"} if fails else set())


@rule("5.4")
@pytest.mark.parametrize(("bound", "failing"), [(None, ""), (3, ""), (2, "a"), (1, "a b")])
def test_a_state_has_a_plan_within_the_bound_or_none(decider: Decider, bound: int | None, failing: str) -> None:
    """The shortest run counts."""
    assert failures(decider, line(bound)) == ({"no-plan": failing} if failing else {})


@rule("5.4")
def test_the_bound_is_one_at_least(reader: Reader) -> None:
    """None is an error."""
    assert reader.refuses(line(0))
    assert not reader.refuses(line(1))


INTERACTING = text(
    {"p": "ny", "q": "ny"},
    RESOURCES="resource ARM",
    ACTIONS=" ".join(
        f"action {verb}_{v} controlled resources: ARM preconditions: {v} is {a} nominal effects: {v} is {b}"
        for verb, a, b in (("load", "n", "y"), ("drop", "y", "n"))
        for v in "pq"
    ),
    GOALS="goal type: priority when p is n AND q is n then goal: p is y AND q is y"
    " when p is y then goal: p is n when q is y then goal: q is n",
)
"""Load both, then deliver: a robot with one load would deliver at once, but then nobody ever has both."""


@rule("5.5")
def test_one_policy_serves_all_states_at_once(decider: Decider) -> None:
    """The run of one state passes where another goal is active, and the decision there serves both."""
    asked = world(INTERACTING)
    answer = decider.answer(asked)
    assert answer.policy is not None
    decisions = asked.decisions(answer.policy)
    loaded = [state for state in ("yn", "ny") if decisions[state].startswith("load")]
    assert len(loaded) == 1, "one half-loaded state goes on loading"
    assert decisions["nn"] == ("load_p" if loaded == ["yn"] else "load_q")


@rule("5.5")
def test_a_run_may_pass_where_other_goals_are_active(judge: Judge) -> None:
    """Where it reaches its own; each state of the policy is judged by its own goals."""
    rows = {"nn": "load_p", "yn": "load_q", "yy": "drop_p", "ny": "drop_q"}
    assert faults(judge, INTERACTING, rows) == set()
    assert faults(judge, INTERACTING, {**rows, "yn": "drop_p"}) == {"goals"}
    assert faults(judge, INTERACTING, {**rows, "ny": "load_p", "yy": "drop_q"}) == {"goals"}


OUT = text(
    {"x": "abcd"},
    ACTIONS="action slow duration: 3 preconditions: x is d nominal effects: x is a"
    " action same duration: 3 preconditions: x is d nominal effects: x is a"
    " action astray duration: 1 preconditions: x is d nominal effects: x is c"
    " action on duration: 7 preconditions: x is a nominal effects: x is b"
    " action free",
    STATE_RULES="rule: NOT x is d",
    GOALS="goal type: priority when x is d OR x is a then goal: x is b",
)
"""Two actions that take equally long lead out of the unsafe state d, and a quick one to where no goal is reached."""


@rule("5.6")
@pytest.mark.parametrize("ordering", BOTH)
def test_no_cheaper_set_would_serve(judge: Judge, ordering: Ordering) -> None:
    """One that takes as long is not cheaper, one that misses the goal does not serve; safe states may waste time."""
    rest = {"a": "on free", "b": "", "c": ""}
    assert faults(judge, OUT, {**rest, "d": "slow"}, ordering) == set()
    assert faults(judge, OUT, {**rest, "d": "same"}, ordering) == set()
    assert faults(judge, OUT, {**rest, "d": "slow same"}, ordering) == {"minimal"}
    assert "goals" in faults(judge, OUT, {**rest, "d": "astray"}, ordering)


@rule("5.6")
@pytest.mark.parametrize(("bound", "minimal"), [(2, False), (1, True)])
def test_a_cheaper_set_has_to_be_in_time(judge: Judge, bound: int, minimal: bool) -> None:
    """Where the cheap way takes a step too many, the dear one is the cheapest that serves."""
    asked = text(
        {"x": "abc"},
        ACTIONS=f"{moves('ba')} action dear duration: 5 preconditions: x is c nominal effects: x is a"
        " action cheap duration: 1 preconditions: x is c nominal effects: x is b",
        STATE_RULES="rule: NOT x is c",
        GOALS="goal type: priority goal: x is a",
        CONFIG=f"max_plan_length: {bound}",
    )
    assert faults(judge, asked, {"a": "", "b": "ba", "c": "dear"}) == (set() if minimal else {"minimal"})


@rule("5.6")
def test_a_cheaper_set_has_to_reach_its_own_residual_goal(judge: Judge) -> None:
    """What `executing` asks for is settled by the cheaper set, not by the decision that it replaces."""
    for body, found in (("executing slow", set()), ("executing quick", {"goals", "minimal"}), ("x is a", {"minimal"})):
        asked = text(
            {"x": "abc"},
            ACTIONS="action slow duration: 2 preconditions: x is c nominal effects: x is a"
            " action quick duration: 1 preconditions: x is c nominal effects: x is a",
            STATE_RULES="rule: NOT x is c",
            GOALS=f"goal type: priority when x is c then goal: {body}",
        )
        assert faults(judge, asked, {"a": "", "b": "", "c": "slow"}) == found


@rule("5.6")
def test_the_cheapest_way_out_is_found(decider: Decider) -> None:
    """Of those that reach the goal."""
    assert policy(decider, OUT)["d"] == "slow"


BOTH_OR_ONE = text(
    {"x": "ab", "y": "ab"},
    ACTIONS="action left duration: 2 nominal effects: x is a action right duration: 3 nominal effects: x is a"
    " action alone duration: {} nominal effects: x is a",
    STATE_RULES="rule: x is a",
    REACTION_RULES="rule: executing left IFONLYIF executing right",
)
"""Either two actions that have to go together, or one."""


@rule("5.7")
@pytest.mark.parametrize(("alone", "fails"), [(4, "left right"), (5, ""), (6, "alone")])
def test_durations_of_a_set_add_up(judge: Judge, alone: int, fails: str) -> None:
    """The longest of them is not what counts."""
    asked = BOTH_OR_ONE.replace("{}", str(alone))
    for decision in ("alone", "left right"):
        found = faults(judge, asked, {"aa": "", "ab": "", "ba": decision, "bb": decision})
        assert found == ({"minimal"} if decision == fails else set())


@rule("5.7")
@pytest.mark.parametrize(("alone", "taken"), [(4, "alone"), (6, "left right")])
def test_the_smallest_sum_is_found(decider: Decider, alone: int, taken: str) -> None:
    """As above."""
    assert policy(decider, BOTH_OR_ONE.replace("{}", str(alone)))["ba"] == taken


@rule("5.8")
@pytest.mark.parametrize(("goal", "longest"), [("x is d", 3), ("NOT x is a", 1), ("x is d OR x is c", 2)])
def test_the_longest_run_is_counted_to_where_the_goal_is_met_first(decider: Decider, goal: str, longest: int) -> None:
    """The largest over the states of the least number of steps."""
    assert decider.answer(world(line(goal=goal))).longest == longest
