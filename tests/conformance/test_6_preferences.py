"""Section 6 of docs/semantics.md: which policy."""

from tests.conformance.asking import policy
from tests.conformance.by_engine import Bdd
from tests.conformance.roles import Decider
from tests.conformance.rules import rule
from tests.conformance.test_5_policies import INTERACTING, moves
from tests.conformance.world import text, world
from tumato_symbolic.policy import dumps
from tumato_symbolic.synthesis import Realizable, synthesize

GOAL = "goal type: priority goal: x is d"


@rule("6.1")
def test_in_a_safe_state_the_fewest_steps_come_first(decider: Decider) -> None:
    """Before the number of actions and the order of declaration; durations do not count."""
    actions = f"{moves('ab', 'bc', 'cd')} action jump duration: 90 preconditions: x is a nominal effects: x is d"
    asked = text({"x": "abcd"}, ACTIONS=actions, GOALS=GOAL)
    assert policy(decider, asked) == {"a": "jump", "b": "bc", "c": "cd", "d": ""}
    pair = "action one nominal effects: x is b action two nominal effects: x is b action far nominal effects: y is b"
    tied = "rule: executing one IFONLYIF executing two"
    asked = text({"x": "ab", "y": "ab"}, ACTIONS=pair, REACTION_RULES=tied, GOALS="goal type: priority goal: x is b")
    assert policy(decider, asked)["aa"] == "one two"


@rule("6.1")
def test_then_the_fewest_actions_then_what_is_declared_first(decider: Decider) -> None:
    """Sets are compared as sorted lists of positions."""
    actions = "action one effects: x is b action two effects: x is b action both duration: 9 effects: x is d"
    tied = "rule: executing one IFONLYIF executing two"
    block = "goal type: priority when x is a then goal: NOT x is a"
    assert policy(decider, text({"x": "abd"}, ACTIONS=actions, REACTION_RULES=tied, GOALS=block))["a"] == "both"
    assert policy(decider, text({"x": "abd"}, ACTIONS=actions, GOALS=block))["a"] == "one"
    three = "action p effects: x is b action q effects: x is b action r effects: x is b"
    pairs = "rule: executing p AND executing r OR executing q AND executing r"
    unconditional = "goal type: priority goal: x is b"
    assert policy(decider, text({"x": "ab"}, ACTIONS=three, REACTION_RULES=pairs, GOALS=unconditional))["a"] == "p r"


@rule("6.1")
def test_a_run_in_the_own_region_comes_before_a_shorter_one_through_others(decider: Decider) -> None:
    """Where the state's own goals are active all the way; and where there is none such, the other one is taken."""
    block = "goal type: priority when x is v then goal: NOT x is v when NOT x is g then goal: x is g"
    for steps, taken in ((("sv", "sp"), "sp"), (("sv",), "sv")):
        asked = text({"x": "svpqg"}, ACTIONS=moves(*steps, "vg", "pq", "qg"), GOALS=block)
        assert policy(decider, asked)["s"] == taken


@rule("6.2")
def test_in_an_unsafe_state_the_smallest_duration_comes_first(decider: Decider) -> None:
    """Before the number of steps, the number of actions and the order; then these in turn."""
    start = "preconditions: x is a nominal effects:"
    goal = "goal type: priority goal: x is d"
    for actions, taken in (
        (f"action quick duration: 6 {start} x is b action near duration: 7 {start} x is d", "quick"),
        (f"action far duration: 6 {start} x is b action near duration: 6 {start} x is d", "near"),
        (f"action first duration: 6 {start} x is d action other duration: 6 {start} x is d", "first"),
        (f"action zero duration: 0 {start} x is d action other {start} x is d", "zero"),
    ):
        asked = text(
            {"x": "abcd"}, ACTIONS=f"{actions} {moves('bc', 'cd')}", STATE_RULES="rule: NOT x is a", GOALS=goal
        )
        assert policy(decider, asked)["a"] == taken


@rule("6.2")
def test_in_an_unsafe_state_fewer_actions_come_before_what_is_declared_first(decider: Decider) -> None:
    """Two that last as long together as one alone."""
    actions = (
        "action one duration: 1 effects: x is a action two duration: 1 effects: x is a"
        " action alone duration: 2 effects: x is a"
    )
    asked = text(
        {"x": "ab"},
        ACTIONS=actions,
        STATE_RULES="rule: x is a",
        REACTION_RULES="rule: executing one IFONLYIF executing two",
    )
    assert policy(decider, asked)["b"] == "alone"


@rule("6.2")
def test_in_an_unsafe_state_no_region_is_preferred(decider: Decider) -> None:
    """Of two ways out that are alike but for the goals on the way, the first one declared is taken."""
    actions = " ".join(
        f"action {a}{b} duration: 2 preconditions: x is {a} nominal effects: x is {b}"
        for a, b in ("uv", "uw", "vg", "wg")
    )
    block = "goal type: priority when x is u OR x is w then goal: x is g goal: NOT x is v"
    asked = text({"x": "uvwg"}, ACTIONS=actions, STATE_RULES="rule: NOT x is u", GOALS=block)
    assert policy(decider, asked)["u"] == "uv"


@rule("6.3")
def test_realizability_comes_before_preferences_and_little_deviates(decider: Decider) -> None:
    """A robot with one load would deliver it; one of the two states with one goes on, and the other one does not."""
    found = policy(decider, INTERACTING)
    assert [found[state].partition("_")[0] for state in ("yn", "ny")].count("load") == 1
    assert found["yy"].startswith("drop")


@rule("6.4")
def test_the_same_specification_gives_the_same_policy_byte_for_byte(decider: Decider) -> None:
    """On either backend, and once more."""
    assert isinstance(decider, Bdd)
    documents = set()
    for _ in range(2):
        for backend in (decider.backend, "autoref"):
            outcome = synthesize(world(INTERACTING).spec, backend=backend)
            assert isinstance(outcome, Realizable)
            documents.add(dumps(outcome.policy))
    assert len(documents) == 1
