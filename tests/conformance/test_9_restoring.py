"""Section 9 of docs/semantics.md: restoring safety in more than one step."""

import pytest

from tests.conformance.asking import efforts, failures, faults, following, policy, under_both
from tests.conformance.roles import Decider, Judge, Refuter, Restorer, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, Decisions, text, world
from tumato_symbolic.spec import Ordering
from tumato_symbolic.synthesis import Unrealizable, synthesize


def ways(*steps: str) -> str:
    """Actions that share a resource: `ab` leads from a to b, `ab2` takes 2, `ab|c` may lead to c instead."""
    found = []
    for step in steps:
        here, there = step[0], step[1]
        duration, _, other = step[2:].partition("|")
        also = f" alternative effects: x is {other}" if other else ""
        found.append(
            f"action {here}{there}{other} duration: {duration or 1} controlled resources: R"
            f" preconditions: x is {here} nominal effects: x is {there}{also}"
        )
    return " ".join(found)


def places(
    values: str, *steps: str, safe: str = "s", goals: str = "", bound: int = 0, restoration: str = "bounded"
) -> str:
    """Places that are left one step at a time, of which some are safe."""
    blocks = {
        "RESOURCES": "resource R",
        "ACTIONS": ways(*steps),
        "STATE_RULES": f"rule: {' OR '.join(f'x is {each}' for each in safe)}",
        "CONFIG": f"restoration: {restoration}" + (f" max_plan_length: {bound}" if bound else ""),
    }
    return text({"x": values}, **blocks, **({"GOALS": f"goal type: priority {goals}"} if goals else {}))


SHUT = "action shut_x duration: 1 nominal effects: x is c action shut_y duration: 1 nominal effects: y is c"
VALVES = text(
    {"x": "oc", "y": "oc"}, ACTIONS=SHUT, STATE_RULES="rule: x is c rule: y is c", CONFIG="restoration: bounded"
)
"""Two valves that are to be closed."""

SINGLY: Decisions = {"oo": "shut_x", "oc": "shut_x", "co": "shut_y", "cc": ""}


@rule("9.1")
def test_a_step_leads_to_all_outcomes_and_the_nominal_successor(restorer: Restorer) -> None:
    """Under `first` effects come alone, and the nominal successor is no outcome."""
    actions = "action left nominal effects: x is b alternative effects: x is c action right nominal effects: y is b"
    asked = text({"x": "abc", "y": "ab"}, ACTIONS=actions, STATE_RULES="rule: x is a", CONFIG="restoration: bounded")
    assert following(restorer, asked, "aa", "left right", "first") == "ab ba bb ca"
    assert following(restorer, asked, "aa", "left right", "any") == "ab ba bb ca cb"
    assert following(restorer, asked, "ba", "left", "any") == "ba ca"


@rule("9.1")
@pytest.mark.parametrize("ordering", BOTH)
def test_what_has_no_effects_leads_nowhere_else(restorer: Restorer, ordering: Ordering) -> None:
    """The state stays where no action has effects, or one may leave it as it is."""
    actions = "action beep action stop nominal effects: x is b alternative effects: none"
    asked = text({"x": "ab"}, ACTIONS=actions, STATE_RULES="rule: x is b", CONFIG="restoration: fair")
    assert following(restorer, asked, "a", "", ordering) == "a"
    assert following(restorer, asked, "a", "beep", ordering) == "a"
    assert following(restorer, asked, "a", "stop beep", ordering) == "a b"


@rule("9.2")
def test_no_rule_is_broken_that_was_not_broken_before(stepper: Stepper) -> None:
    """Two rules count apart, and one that says the same in one line may be broken further."""
    actions = f"{SHUT} action open_x nominal effects: x is o"
    for rules, also in (("rule: x is c rule: y is c", False), ("rule: x is c AND y is c", True)):
        asked_text = VALVES.replace(SHUT, actions).replace("rule: x is c rule: y is c", rules)
        singly = ["", "shut_x", "shut_y", "shut_x shut_y"]
        for asked in under_both(stepper, asked_text):
            assert asked.allowed("cc") == singly
            assert sorted(asked.allowed("co")) == sorted([*singly, *(["open_x", "shut_y open_x"] if also else [])])
            assert sorted(asked.allowed("oo")) == sorted([*singly, "open_x", "shut_y open_x"])


@rule("9.2")
def test_all_that_a_step_leads_to_keeps_the_rules_and_is_valid(stepper: Stepper) -> None:
    """An alternative counts as the nominal effect does, and so does an assumption."""
    actions = (
        "action mend nominal effects: x is a action risk nominal effects: x is a alternative effects: y is b"
        " action lose nominal effects: x is a alternative effects: y is c action spoil nominal effects: y is b"
    )
    asked_text = text(
        {"x": "ab", "y": "abc"},
        ACTIONS=actions,
        STATE_RULES="rule: x is a rule: y is a",
        ASSUMPTIONS="assume: NOT y is c",
        CONFIG="restoration: bounded",
    )
    for asked in under_both(stepper, asked_text):
        assert asked.allowed("ba") == ["", "mend"]
        assert [each for each in ("mend", "risk", "lose", "spoil") if asked.allows("bb", each)] == [
            "mend",
            "risk",
            "spoil",
        ]


@rule("9.3")
def test_the_worst_effort_is_that_of_the_worst_outcome(restorer: Restorer) -> None:
    """Both valves at once may be closed one after the other, which takes longer than one at a time."""
    one = {"oc": (1, 1), "co": (1, 1)}
    for ordering in BOTH:
        assert efforts(restorer, VALVES, SINGLY, ordering) == {**one, "oo": (2, 2)}
        assert efforts(restorer, VALVES, {**SINGLY, "oo": "shut_x shut_y"}, ordering) == {**one, "oo": (3, 2)}


@rule("9.3")
@pytest.mark.parametrize(("duration", "worst"), [(5, (6, 2)), (2, (3, 3)), (1, (3, 3))])
def test_efforts_are_compared_by_duration_first(restorer: Restorer, duration: int, worst: tuple[int, int]) -> None:
    """One long step outweighs two short ones; of equally long ways the one with more steps is worse."""
    asked = places("abcds", "ab1|c", f"bs{duration}", "cd1", "ds1")
    found = efforts(restorer, asked, {"a": "abc", "b": "bs", "c": "cd", "d": "ds", "s": ""})
    assert found == {"a": worst, "b": (duration, 1), "c": (2, 2), "d": (1, 1)}


@rule("9.3")
def test_an_effort_may_be_infinite(restorer: Restorer) -> None:
    """Where some outcome comes back, or nothing is done; and where what comes after has none."""
    asked = places("abcs", "as1|a", "ba1", "bs1", "cb1|a")
    decisions = {"a": "asa", "b": "bs", "c": "cba", "s": ""}
    assert efforts(restorer, asked, decisions) == {"b": (1, 1)}
    assert efforts(restorer, asked, {**decisions, "b": ""}) == {}


CHAIN = places("abs", "ab", "bs", goals="when x is a then goal: x is s", bound=2)
IN_TWO: Decisions = {"a": "ab", "b": "bs", "s": ""}


@rule("9.4")
def test_restoring_steps_count_and_the_goal_is_met_in_safe_states(judge: Judge) -> None:
    """The bound leaves room for both steps or not; what holds on the way is no goal met."""
    assert faults(judge, CHAIN, IN_TWO) == set()
    assert faults(judge, CHAIN.replace("length: 2", "length: 1"), IN_TWO) == {"goals"}
    assert faults(judge, CHAIN.replace("goal: x is s", "goal: x is b"), IN_TWO) == {"goals"}
    assert faults(judge, CHAIN.replace("goal: x is s", "goal: x is b OR x is s"), IN_TWO) == set()


@rule("9.4")
def test_a_policy_is_found_where_two_steps_are_in_time(decider: Decider) -> None:
    """As above."""
    assert policy(decider, CHAIN) == IN_TWO
    assert failures(decider, CHAIN.replace("length: 2", "length: 1")) == {"no-plan": "a"}
    assert failures(decider, CHAIN.replace("goal: x is s", "goal: x is b")) == {"no-plan": "a"}


@rule("9.4")
@pytest.mark.parametrize(("restoration", "found"), [("bounded", {"restoring"}), ("fair", set[str]())])
def test_every_outcome_or_the_nominal_one_leads_back(judge: Judge, restoration: str, found: set[str]) -> None:
    """An alternative that goes round is a fault under `bounded` only; a nominal effect that does, under both."""
    asked = places("abs", "ab1|a", "bs1", restoration=restoration)
    assert faults(judge, asked, {"a": "aba", "b": "bs", "s": ""}) == found
    back = places("abs", "ab1", "bs1", "ba1|s", restoration=restoration)
    assert faults(judge, back, {"a": "ab", "b": "bas", "s": ""}) >= {"restoring"}
    assert faults(judge, back, IN_TWO) == set()


@rule("9.4")
def test_every_decision_keeps_the_rules(judge: Judge) -> None:
    """Also in an unsafe state."""
    spoil = VALVES.replace(SHUT, f"{SHUT} action swap duration: 1 nominal effects: x is c, y is o")
    assert faults(judge, spoil, SINGLY) == set()
    assert faults(judge, spoil, {**SINGLY, "oo": "swap"}) == set()
    assert "safe" in faults(judge, spoil, {**SINGLY, "oc": "swap"})


@rule("9.5")
def test_safe_states_lead_to_safe_states(stepper: Stepper) -> None:
    """However safety is restored."""
    for restoration in ("bounded", "fair"):
        asked_text = places("rst", "rs", "rt", "ts", "tr", safe="rs", restoration=restoration)
        for asked in under_both(stepper, asked_text):
            assert asked.allowed("r") == ["", "rs"]
            assert asked.allowed("t") == ["", "ts", "tr"]


@rule("9.5")
def test_each_way_to_restore_safety_allows_what_the_stricter_ones_do(judge: Judge) -> None:
    """What may change nothing restores under `fair` only, and doing nothing never does."""
    serving = {}
    for restoration in ("one_step", "bounded", "fair"):
        asked = places("abs", "as", "ab", "as|a", "bs", restoration=restoration)
        chosen = ("as", "ab", "asa", "")
        serving[restoration] = [
            each for each in chosen if faults(judge, asked, {"a": each, "b": "bs", "s": ""}) <= {"minimal"}
        ]
    assert serving == {"one_step": ["as"], "bounded": ["as", "ab"], "fair": ["as", "ab", "asa"]}


@rule("9.5")
def test_what_may_change_nothing_is_repeated_under_fair(decider: Decider) -> None:
    """Under `bounded` it is no way back."""
    assert policy(decider, places("as", "as|a", restoration="fair")) == {"a": "asa", "s": ""}
    assert failures(decider, places("as", "as|a")) == {"no-restoration": "a"}


def fork(*durations: int, restoration: str = "bounded") -> str:
    """From a by b or by c to s."""
    first, second, third, fourth = durations
    steps = f"ab{first}", f"bs{second}", f"ac{third}", f"cs{fourth}"
    return places("abcs", *steps, restoration=restoration)


JUMP = places("abs", "as9", "ab1", "bs1")
FINITE = places("abs", "as1|a", "ab9", "bs9", restoration="fair")
NOMINAL = places("abs", "as{}|a", "ab1|a", "bs2|b", restoration="fair")
BETTER = {
    "one step before more": (JUMP, "as", "ab"),
    "the smaller duration": (fork(1, 5, 2, 3), "ac", "ab"),
    "what comes after": (fork(1, 5, 2, 5), "ab", "ac"),
    "a finite effort": (FINITE, "ab", "asa"),
    "the sum of the nominal run": (NOMINAL.replace("duration: {}", "duration: 4"), "aba", "asa"),
    "fewer steps of equal duration": (NOMINAL.replace("duration: {}", "duration: 3"), "asa", "aba"),
}
"""Of two decisions in a the better one, and the other; in all else there is one way only."""


def rest(asked: str) -> dict[str, str]:
    """The decisions in the other states."""
    other = {"b": "bsb" if "action bsb" in asked else "bs", "s": ""}
    return {**other, "c": "cs"} if "a, b, c, s" in asked else other


@rule("9.6")
@pytest.mark.parametrize("kind", BETTER)
def test_the_better_set_is_the_minimum(judge: Judge, kind: str) -> None:
    """The other one is not minimal."""
    asked, better, other = BETTER[kind]
    assert faults(judge, asked, {"a": better, **rest(asked)}) == set()
    assert faults(judge, asked, {"a": other, **rest(asked)}) == {"minimal"}


@rule("9.6")
def test_of_equally_good_sets_both_are_minimal(judge: Judge) -> None:
    """And a set has to be better by what it leads to, not by its own duration."""
    asked = fork(1, 5, 2, 4)
    for each in ("ab", "ac"):
        assert faults(judge, asked, {"a": each, **rest(asked)}) == set()


@rule("9.6")
@pytest.mark.parametrize("kind", BETTER)
def test_the_better_set_is_found(decider: Decider, kind: str) -> None:
    """As above."""
    asked, better, _ = BETTER[kind]
    assert policy(decider, asked) == {"a": better, **rest(asked)}


def crossing(*wanted: str) -> str:
    """From n and from o runs pass the unsafe m, from where it is quicker to l than to r; both are safe."""
    goals = " ".join(f"when x is {each[0]} then goal: x is {each[1]}" for each in wanted)
    return places("nomlr", "nm1", "om1", "ml1", "mr2", safe="lr", goals=goals)


ASIDE: Decisions = {"n": "nm", "o": "om", "m": "mr", "l": "", "r": ""}


@rule("9.7")
def test_a_worse_decision_may_serve_another_state(judge: Judge) -> None:
    """Where the run of n has to come to r the longer way is taken in m, and is minimal; else it is not."""
    assert faults(judge, crossing("nr"), ASIDE) == set()
    assert faults(judge, crossing("nr"), {**ASIDE, "m": "ml"}) == {"goals"}
    assert faults(judge, crossing("nl"), {**ASIDE, "m": "ml"}) == set()
    assert faults(judge, crossing("nl", "or"), {**ASIDE, "m": "ml"}) == {"goals"}


@rule("9.7")
def test_realizability_comes_before_the_better_decision(decider: Decider) -> None:
    """And the better decision before the shorter run."""
    assert policy(decider, crossing("nr")) == ASIDE
    assert policy(decider, crossing("nl")) == {**ASIDE, "m": "ml"}


@rule("9.7")
def test_of_equally_good_decisions_section_6_decides(decider: Decider) -> None:
    """The first declared of two valves; what one step restores is decided as under `one_step`."""
    assert policy(decider, VALVES) == SINGLY
    for restoration in ("one_step", "bounded", "fair"):
        asked = places("abs", "as2", "as3|s", "ab1", "bs1", restoration=restoration)
        assert policy(decider, asked) == {"a": "as", "b": "bs", "s": ""}
        assert policy(decider, asked.replace("duration: 2", "duration: 4")) == {"a": "ass", "b": "bs", "s": ""}


@rule("9.8")
@pytest.mark.parametrize(("restoration", "lost"), [("bounded", "a b"), ("fair", "b")])
def test_states_from_where_nothing_leads_back(decider: Decider, restoration: str, lost: str) -> None:
    """Every outcome has to, or the nominal one; a state that leads to such a state is lost with it."""
    asked = places("abcs", "as|b", "bb", "ca", "cs", restoration=restoration)
    assert failures(decider, asked) == {"no-restoration": lost}
    assert failures(decider, asked.replace("x is b ", "x is s ")) == {"no-restoration": "b"}


AROUND = places("ags", "as", "ag|a", safe="gs", goals="when x is a then goal: x is g")


@rule("9.8")
def test_a_state_has_no_plan_taken_alone(decider: Decider) -> None:
    """Under `bounded` no step of the run may stay where it is; under `fair` it may."""
    assert failures(decider, AROUND) == {"no-plan": "a"}
    assert policy(decider, AROUND.replace("bounded", "fair"))["a"] == "aga"
    assert policy(decider, AROUND.replace("goal: x is g", "goal: x is s"))["a"] == "as"


@rule("9.8")
def test_a_safe_state_fails_as_before(decider: Decider) -> None:
    """With `no-allowed-set`, where rules forbid even to do nothing."""
    forbidden = "BEGIN REACTION RULES rule: IF x is s THEN executing ba END REACTION RULES"
    assert failures(decider, f"{places('as', 'as')}\n{forbidden.replace('ba', 'as')}") == {"no-allowed-set": "s"}


@rule("9.8")
def test_goals_of_unsafe_states_conflict(decider: Decider) -> None:
    """Each of two has a plan through m, and no policy serves both."""
    assert failures(decider, crossing("nr", "ol")) == {"conflict": "n o"}
    assert failures(decider, crossing("nr", "or")) == {}


@rule("9.8")
@pytest.mark.parametrize(("restoration", "step"), [("bounded", "as|a"), ("fair", "aa|s")])
def test_that_nothing_leads_back_is_believed_where_it_is_so(refuter: Refuter, restoration: str, step: str) -> None:
    """By a trap; where an action surely leads out of it, it is none."""
    some = places("as", step, "as3", restoration=restoration)
    never = some.replace("duration: 3 controlled resources: R preconditions: x is a", "preconditions: x is s")
    outcome = synthesize(world(never).spec)
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert [failure.kind for failure in outcome.failures] == ["no-restoration"]
    assert refuter.believes(world(never), outcome.certificate)
    assert not refuter.believes(world(some), outcome.certificate)
