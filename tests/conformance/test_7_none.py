"""Section 7 of docs/semantics.md: when there is no policy."""

import pytest

from tests.conformance.asking import failures, under_both
from tests.conformance.roles import Decider, Refuter, Stepper
from tests.conformance.rules import rule
from tests.conformance.test_5_policies import line, moves
from tests.conformance.world import BOTH, text, world
from tumato_symbolic.spec import Ordering
from tumato_symbolic.synthesis import Unrealizable, synthesize


def stuck(*ways_out: str) -> str:
    """The unsafe state c, which only these moves leave; b is unsafe as well, and is left."""
    rules = "rule: NOT x is b rule: NOT x is c"
    return text({"x": "abc"}, ACTIONS=moves("ba", *ways_out), STATE_RULES=rules)


CONFLICT = text(
    {"x": "lmrLR"},
    ACTIONS=moves("lm", "rm", "mL", "mR", "LL", "RR"),
    GOALS="goal type: priority when x is l then goal: x is R when x is r then goal: x is L",
)
"""From l and from r runs pass m, which can lead to one side only."""


def harmless(conflict: str) -> str:
    """The same where l is content with either side."""
    return conflict.replace("goal: x is R", "goal: x is R OR x is L")


@rule("7.1")
@pytest.mark.parametrize("ordering", BOTH)
def test_no_set_is_allowed(decider: Decider, ordering: Ordering) -> None:
    """Not even the empty one; where one is, a state does not fail for that."""
    assert failures(decider, stuck(), ordering) == {"no-allowed-set": "c"}
    assert failures(decider, stuck("cb"), ordering) == {"no-allowed-set": "c"}
    assert failures(decider, stuck("ca"), ordering) == {}


@rule("7.2")
def test_no_run_of_allowed_steps_reaches_the_goal(decider: Decider) -> None:
    """Though a set is allowed; each state that fails is told once, by its kind."""
    block = "goal type: priority goal: x is d"
    asked = text({"x": "abcd"}, ACTIONS=moves("cd"), STATE_RULES="rule: NOT x is a", GOALS=block)
    assert failures(decider, asked) == {"no-allowed-set": "a", "no-plan": "b"}
    assert failures(decider, line(2)) == {"no-plan": "a"}
    assert failures(decider, line(3)) == {}


@rule("7.3")
def test_goals_conflict_where_no_state_fails(decider: Decider) -> None:
    """A minimal set of states that no policy serves together is named."""
    assert failures(decider, CONFLICT) == {"conflict": "l r"}
    assert failures(decider, harmless(CONFLICT)) == {}


CERTIFIED = {
    "no-allowed-set": (stuck("ca").replace("x is c nominal", "x is c, x is a nominal"), stuck("ca")),
    "no-plan": (line(2), line(3)),
    "conflict": (CONFLICT, harmless(CONFLICT)),
}
"""Of each kind a specification without a policy, and one like it with a policy."""


@rule("7.1", "7.2", "7.3")
@pytest.mark.parametrize("kind", CERTIFIED)
def test_unrealizability_is_proved_where_it_is_so(refuter: Refuter, kind: str) -> None:
    """A certificate is believed of the specification without a policy, and not of the one with a policy."""
    none, some = CERTIFIED[kind]
    outcome = synthesize(world(none).spec)
    assert isinstance(outcome, Unrealizable) and outcome.certificate is not None
    assert [failure.kind for failure in outcome.failures] == [kind]
    assert refuter.believes(world(none), outcome.certificate)
    assert not refuter.believes(world(some), outcome.certificate)


GO = "action go nominal effects: x is b"
DROPS: dict[str, tuple[dict[str, str], str, str]] = {
    "a state rule": ({"ACTIONS": GO, "STATE_RULES": "rule: NOT x is b"}, "rule: NOT x is b", "go"),
    "an assumption": ({"ACTIONS": GO, "ASSUMPTIONS": "assume: NOT x is b"}, "assume: NOT x is b", "go"),
    "a reaction rule": ({"ACTIONS": GO, "REACTION_RULES": "rule: NOT executing go"}, "rule: NOT executing go", "go"),
    "a precondition": ({"ACTIONS": f"{GO} preconditions: x is b"}, "preconditions: x is b", "go"),
    "an alternative": (
        {"ACTIONS": f"{GO} alternative effects: x is c", "STATE_RULES": "rule: NOT x is c"},
        "alternative effects: x is c",
        "go",
    ),
    "a resource": (
        {
            "RESOURCES": "resource ARM",
            "ACTIONS": f"{GO} controlled resources: ARM action also controlled resources: ARM nominal effects: y is b",
        },
        "controlled resources: ARM",
        "go also",
    ),
}
"""What can be dropped: blocks of a specification, a part of them, and the set that this part forbids."""


@rule("7.4")
@pytest.mark.parametrize("dropped", DROPS)
def test_what_is_taken_away_forbids_nothing(stepper: Stepper, dropped: str) -> None:
    """Every set that was allowed still is, and one more; the same set leads to the same state as before."""
    blocks, part, forbidden = DROPS[dropped]
    whole = text({"x": "abc", "y": "ab"}, **blocks)
    for before, after in zip(under_both(stepper, whole), under_both(stepper, whole.replace(part, "")), strict=True):
        allowed = before.allowed("aa")
        assert after.allowed("aa") == [*allowed, forbidden]
        assert before.leads("aa", allowed[-1]) == after.leads("aa", allowed[-1])


@rule("7.4")
@pytest.mark.parametrize("bound", [1, 2, 3])
def test_a_longer_bound_fails_no_further_state(decider: Decider, bound: int) -> None:
    """And none at all fails fewer."""
    now, later, without = (
        failures(decider, line(each)).get("no-plan", "").split() for each in (bound, bound + 1, None)
    )
    assert set(now) >= set(later) >= set(without)
