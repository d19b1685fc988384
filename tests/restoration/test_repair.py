"""Decisions in unsafe states that serve each other's runs: repair, deviations, conflicts."""

import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.mutants.unrealizable import examine_text
from tests.printing import print_spec
from tests.restoration.test_synthesis import decided
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import Deviation
from tumato_symbolic.policy.unrealizability import Conflict, dumps, loads
from tumato_symbolic.semantics import follow
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify import verify_unrealizable

Changing = Callable[[dict[str, Any]], None]
"""A change of the reason of a certificate."""

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
    spec = replace(crossing(north="right"), restoration=restoration)
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
    spec = replace(crossing(north="right", south="left"), restoration=restoration)
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


TURNING = """
BEGIN STATE VECTOR state P can be a, b, home, house END STATE VECTOR
BEGIN RESOURCES resource R END RESOURCES
BEGIN ACTIONS
action a_b controlled resources: R preconditions: P is a nominal effects: P is b
action a_home controlled resources: R preconditions: P is a nominal effects: P is home
action b_house controlled resources: R preconditions: P is b nominal effects: P is house alternative effects: P is a
END ACTIONS
BEGIN STATE RULES rule: P in {home, house} END STATE RULES
BEGIN GOALS goal type: priority
when P is a then goal: P is house
END GOALS
BEGIN CONFIG restoration: bounded END CONFIG
"""


def test_outcomes_that_restore_nothing_are_a_conflict() -> None:
    """`a` has to go through `b`, from where nothing else can be done than what may lead back to `a`."""
    spec = parse(TURNING)
    outcome = synthesize(spec)
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    reason = outcome.certificate.reason
    assert isinstance(reason, Conflict)
    assert [cut.kind for cut in reason.cuts if cut.kind == "outcomes"]
    assert verify_unrealizable(outcome.certificate, spec).verdict == "proved"


@pytest.mark.parametrize(
    "spec", [parse(TURNING), crossing(north="right", south="left")], ids=["outcomes", "through the middle"]
)
def test_changed_certificates_of_conflicts(spec: Spec, tmp_path: Path) -> None:
    """`verify` and the stand-alone checker judge them alike, and believe none of what is not so."""
    tally = examine_text(print_spec(spec, Random(0)), "conflict", 40, tmp_path)
    assert tally.kinds
    assert not tally.complaints


def _cut(**fields: Any) -> Changing:
    return lambda reason: reason["Cuts"][0].update(fields)


def _no_outcomes(reason: dict[str, Any]) -> None:
    del reason["Choices"][1]["Outcomes"]


def _false_outcome(reason: dict[str, Any]) -> None:
    reason["Choices"][0]["Outcomes"] = [[{"P": "b"}], [{"P": "b"}]]


def _safe_loop(reason: dict[str, Any]) -> None:
    house = {"State": {"P": "house"}, "Options": [{"Successor": {"P": "house"}, "Goal": 1}]}
    reason["Choices"].append(house)
    reason["Cuts"][0].update(States=[0, 1, 2], Back=2)


def _right(reason: dict[str, Any]) -> None:
    """Longer than need be."""
    reason["Cuts"][0].update(States=[0, 1, 0, 1], Back=2)


WRONG_OUTCOMES = {
    "back to none of its states": (_cut(Back=2), "lead back"),
    "from elsewhere": (_cut(States=[1, 0]), "is not among the starts"),
    "a path that leads there is not one": (_cut(States=[0], Back=0), "respects all cuts"),
    "outcomes that are not listed": (_no_outcomes, "respects all cuts"),
    "outcomes that are none": (_false_outcome, "no option"),
    "safe states": (_safe_loop, "restore something"),
}


@pytest.mark.parametrize("name", ["right", *WRONG_OUTCOMES])
def test_outcomes_that_go_round_are_judged_claim_by_claim(name: str, tmp_path: Path) -> None:
    """By `verify` and by the stand-alone checker, with the claim that fails."""
    change, why = WRONG_OUTCOMES.get(name, (_right, ""))
    outcome = synthesize(parse(TURNING))
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    document = json.loads(dumps(outcome.certificate))
    change(document["Reason"])
    found = verify_unrealizable(loads(json.dumps(document)), parse(TURNING))
    assert found.verdict == ("refuted" if why else "proved")
    assert why in (found.reason or "")
    answer = ask(tmp_path, json.dumps(document), TURNING)
    assert answer.code == (1 if why else 0)
    assert why in answer.out + answer.err


def test_where_nominal_effects_count_outcomes_prove_nothing(tmp_path: Path) -> None:
    """Under `fair` safety comes back in the end."""
    outcome = synthesize(parse(TURNING))
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    document = json.loads(dumps(outcome.certificate))
    for choice, goal in zip(document["Reason"]["Choices"], (0, 1), strict=True):
        choice["Options"].append({"Successor": choice["State"], "Goal": goal})  # nothing is done
        choice["Outcomes"].append([])
    fair = TURNING.replace("restoration: bounded", "restoration: fair")
    found = verify_unrealizable(loads(json.dumps(document)), parse(fair))
    assert "have to restore safety" in (found.reason or "")
    answer = ask(tmp_path, json.dumps(document), fair)
    assert answer.code == 1
    assert "need not restore safety" in answer.out + answer.err


@pytest.mark.parametrize(
    ("outcomes", "why"),
    [([[]], "does not have one entry for every option"), (3, "expected a list"), ([3, []], "a list")],
)
def test_outcomes_have_a_form(outcomes: object, why: str, tmp_path: Path) -> None:
    """What has another is refused by both readers."""
    outcome = synthesize(parse(TURNING))
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    document = json.loads(dumps(outcome.certificate))
    document["Reason"]["Choices"][0]["Outcomes"] = outcomes
    with pytest.raises(UserError, match=why):
        loads(json.dumps(document))
    assert ask(tmp_path, json.dumps(document), TURNING).code == 2
