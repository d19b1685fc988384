"""Restoring in several steps, and by severity, by the stand-alone checker: known answers, files, digests."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any

import pytest
from msgspec.structs import replace

from tests.checker.standalone import Answer, ask, checker
from tests.checker.stepwise import claiming, stepwise_spec, true_claims
from tests.checker.unrealizable import assert_proved, assert_refuted, certificate, spec_text
from tests.printing import print_spec
from tests.semantics.test_restoration import EDGE, OVERRIDE, RETRY, VALVES
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps, policy_from_rows
from tumato_symbolic.semantics import NOTHING, ActionSet, State
from tumato_symbolic.spec import Spec, digest

BOUNDED_OVERRIDE = f"{OVERRIDE}BEGIN CONFIG restoration: bounded END CONFIG\n"
TO_T, TO_X, TO_Y = (frozenset((number,)) for number in range(3))
TO_EACH = {(0,): TO_T, (1,): TO_Y, (2,): NOTHING, (3,): NOTHING}
CLOSE_A, CLOSE_B = frozenset((0,)), frozenset((1,))
SINGLY: dict[State, ActionSet] = {(0, 0): CLOSE_A, (0, 1): CLOSE_A, (1, 0): CLOSE_B, (1, 1): NOTHING}


def with_truth(text: str, rows: Any) -> str:
    """A policy with all that is true of it."""
    spec = parse(text)
    return dumps(claiming(spec, rows, true_claims(spec, rows, "any"), "any"))


def verdict(answer: Answer, name: str) -> str:
    """The line about a property, or about something else."""
    return next(line for line in answer.out.splitlines() if line.startswith(name))


def test_a_state_that_is_restored_worse_for_another_one(tmp_path: Path) -> None:
    """(t) goes to y for the sake of (s); the set that would be better is the one deviation."""
    policy = with_truth(BOUNDED_OVERRIDE, TO_EACH)
    assert json.loads(policy)["Certificate"]["Restoring"]["Deviations"] == [
        {"State": {"P": "t"}, "Better": ["to_x"], "Missed": {"P": "s"}}
    ]
    answer = ask(tmp_path, policy, BOUNDED_OVERRIDE, "--strict")
    assert (answer.code, verdict(answer, "certificate")) == (0, "certificate: right"), answer
    assert "; restoration bounded\n" in answer.out
    answer = ask(tmp_path, with_truth(BOUNDED_OVERRIDE, {**TO_EACH, (1,): TO_X}), BOUNDED_OVERRIDE)
    assert answer.failing == {"goals": 1}
    free = BOUNDED_OVERRIDE.replace("goal: P is y", "goal: P is x OR P is y")
    answer = ask(tmp_path, with_truth(free, TO_EACH), free)
    assert answer.failing == {"minimal": 1}
    assert verdict(answer, "certificate") == "certificate: right"


def test_one_valve_after_the_other(tmp_path: Path) -> None:
    """Several steps where they are meant, or asked for; one otherwise."""
    bounded = VALVES + "BEGIN CONFIG restoration: bounded END CONFIG"
    assert ask(tmp_path, with_truth(bounded, SINGLY), bounded, "--strict").code == 0
    both: dict[State, ActionSet] = {**SINGLY, (0, 0): CLOSE_A | CLOSE_B}
    assert ask(tmp_path, with_truth(bounded, both), bounded).failing == {"minimal": 1}
    policy = dumps(policy_from_rows(parse(VALVES), SINGLY))
    assert ask(tmp_path, policy, bounded).code == 0
    assert ask(tmp_path, policy, VALVES, "--restoration", "fair").code == 0
    answer = ask(tmp_path, policy, VALVES)
    assert answer.failing == {"safe": 1}


def test_what_never_ends(tmp_path: Path) -> None:
    """A stop that may do nothing restores nothing whatever happens; nothing at all does not nominally either."""
    stop: dict[State, ActionSet] = {(0,): CLOSE_A, (1,): NOTHING}
    policy = dumps(policy_from_rows(parse(RETRY), stop))
    answer = ask(tmp_path, policy, RETRY, "--restoration", "bounded")
    assert answer.failing == {"restoring": 1}
    assert verdict(answer, "restoring").endswith("it need never be restored; it may lead to (M on)")
    assert ask(tmp_path, policy, RETRY, "--restoration", "fair").code == 0
    idle = dumps(policy_from_rows(parse(RETRY), {**stop, (0,): NOTHING}))
    answer = ask(tmp_path, idle, RETRY, "--restoration", "fair")
    assert answer.failing == {"restoring": 1, "goals": 1, "minimal": 1}


@pytest.mark.parametrize(("place", "arm", "fits"), [(1, 1, False), (1, 2, True), (2, 1, False), (3, 9, True)])
def test_severe_rules_first(place: int, arm: int, fits: bool, tmp_path: Path) -> None:
    """Off the edge with the arm out, where the edge is the more severe of the two."""
    text = EDGE.format(place, arm)
    rows: dict[State, ActionSet] = {(0, 0): CLOSE_A, (0, 1): CLOSE_A, (1, 0): CLOSE_B, (1, 1): NOTHING}
    answer = ask(tmp_path, dumps(policy_from_rows(parse(text), rows)), text)
    assert (answer.code == 0) == fits, answer
    assert ("restoring" in answer.out) == (place != arm)


def test_digests() -> None:
    """The same as the package's, whatever the severities and the restoration."""
    found = set()
    for seed in range(30):
        spec = stepwise_spec(seed, "fair", 1 + seed % 3)
        own = checker.read_specification(print_spec(spec, Random(seed)).encode())
        assert checker.digest(own) == digest(spec)
        found.add(len(spec.tiers))
    assert found == {1, 2, 3}
    for severities in ((1, 1), (1, 2), (3, 9), (2, 1)):
        text = EDGE.format(*severities)
        assert checker.digest(checker.read_specification(text.encode())) == digest(parse(text))


@pytest.mark.parametrize("made_for", ["one_step", "bounded", "fair"])
@pytest.mark.parametrize("meant", ["one_step", "bounded", "fair"])
def test_what_a_policy_was_made_for(made_for: str, meant: str, tmp_path: Path) -> None:
    """A weaker restoration than is meant is refused for that alone, unless the command line says what to judge by."""
    text = VALVES.replace("rule: B is closed", "")
    rows: dict[State, ActionSet] = {state: NOTHING if state[0] else CLOSE_A for state in SINGLY}
    policy = policy_from_rows(parse(text), rows)
    restoration = checker.Parser(f"BEGIN CONFIG restoration: {made_for} END CONFIG").specification().restoration
    written = dumps(replace(policy, restoration=restoration))
    strengths = ("fair", "bounded", "one_step")
    answer = ask(tmp_path, written, f"{text} BEGIN CONFIG restoration: {meant} END CONFIG")
    refused = strengths.index(made_for) < strengths.index(meant)
    assert answer.code == int(refused), answer
    wanted = f"restoration FAILS: the policy was made for `{made_for}`, but the specification means `{meant}`\n"
    assert (wanted in answer.out) == refused == ("FAILS" in answer.out)
    assert ask(tmp_path, written, text, "--restoration", meant).code == 0


def test_recorded_restorations_are_known_words(tmp_path: Path) -> None:
    """Anything else is no policy file."""
    policy = with_truth(BOUNDED_OVERRIDE, TO_EACH)
    for wrong in ('"any"', "null", "1", "[]"):
        answer = ask(tmp_path, policy.replace('"Restoration": "bounded"', f'"Restoration": {wrong}'), BOUNDED_OVERRIDE)
        assert (answer.code, answer.out) == (2, ""), wrong


def set_at(*path: Any) -> Callable[[dict[str, Any]], None]:
    """A change of a section: the last of these becomes the value to which the others lead."""

    def change(section: Any) -> None:
        for key in path[:-2]:
            section = section[key]
        section[path[-2]] = path[-1]

    return change


WRONG_FORMS = {
    "no root": set_at("Worst", 99),
    "a root that is no number": set_at("Nominal", None),
    "a leaf that is no pair": set_at("Leaves", 1, [1]),
    "a leaf of texts": set_at("Leaves", 1, ["1", 1]),
    "a negative leaf": set_at("Leaves", 1, [-1, 1]),
    "a leaf of truth values": set_at("Leaves", 1, [True, 1]),
    "a leaf that is a number": set_at("Leaves", 1, 7),
    "a leaf twice": set_at("Leaves", 1, None),
    "no list of deviations": set_at("Deviations", {}),
    "no deviation": set_at("Deviations", [[]]),
    "an unknown action": set_at("Deviations", 0, "Better", ["to_z"]),
    "an unknown value": set_at("Deviations", 0, "State", "P", "z"),
    "no state": set_at("Deviations", 0, "Missed", {}),
}


@pytest.mark.parametrize("name", WRONG_FORMS)
def test_sections_that_have_not_the_form(name: str, tmp_path: Path) -> None:
    """The certificate is wrong, also where the section is not looked at; the policy is judged all the same."""
    document = json.loads(with_truth(BOUNDED_OVERRIDE, TO_EACH))
    WRONG_FORMS[name](document["Certificate"]["Restoring"])
    for restoration, code in (("bounded", 0), ("one_step", 1)):
        answer = ask(tmp_path, json.dumps(document), BOUNDED_OVERRIDE, "--restoration", restoration)
        assert answer.code == code
        assert "certificate: WRONG" in answer.out, answer


def test_without_the_section(tmp_path: Path) -> None:
    """Incomplete: what the ranks say of unsafe states is then nothing. In one step nothing is missing."""
    document = json.loads(with_truth(BOUNDED_OVERRIDE, TO_EACH))
    del document["Certificate"]["Restoring"]
    answer = ask(tmp_path, json.dumps(document), BOUNDED_OVERRIDE, "--strict")
    assert answer.code == 0
    assert verdict(answer, "certificate").startswith("certificate: incomplete: ")
    document["Certificate"]["Leaves"] = [number + 5 for number in range(len(document["Certificate"]["Leaves"]))]
    document["Certificate"]["Goals"] = []
    assert "certificate: incomplete" in ask(tmp_path, json.dumps(document), BOUNDED_OVERRIDE).out


def no_set(state: Any, *cubes: Any) -> dict[str, Any]:
    """A certificate that no set is allowed in a state; cubes are (executed, idle, violation)."""
    entries = [{"Executed": list(x), "Idle": list(i), "Violation": v} for x, i, v in cubes]
    return {"Kind": "no-allowed-set", "State": state, "Cubes": entries or None}


def asked_no(folder: Path, text: str, reason: dict[str, Any], *options: str, made_for: str = "one_step") -> Answer:
    """What is said of a certificate that there is no policy, made for a restoration."""
    document = json.loads(certificate(text, reason)) | {"Restoration": made_for}
    return ask(folder, json.dumps(document), text, *options)


def test_no_allowed_set_by_severity(tmp_path: Path) -> None:
    """In one step from the edge with the arm in: nothing is allowed if the arm counts as much."""
    retreat = {"Kind": "unsafe", "Outcome": [{"Action": "retreat", "Effect": {"Place": "floor", "Arm": "out"}}]}
    fold = {"Kind": "precondition", "Actions": ["fold"]}
    idle = {"Kind": "idle"}
    cubes: tuple[tuple[list[str], list[str], dict[str, Any]], ...] = (
        (["fold"], [], fold),
        (["retreat"], ["fold"], retreat),
        ([], ["fold", "retreat"], idle),
    )
    reason = no_set({"Place": "edge", "Arm": "in"}, *cubes)
    for each in (reason, no_set(reason["State"])):
        assert_proved(asked_no(tmp_path, EDGE.format(1, 1), each))
        assert asked_no(tmp_path, EDGE.format(1, 2), each).code == 1
    assert_refuted(asked_no(tmp_path, EDGE.format(1, 2), reason), "is safe")
    answer = asked_no(tmp_path, EDGE.format(1, 1), reason, "--restoration", "bounded")
    assert_refuted(answer, "doing nothing may be allowed")


def test_unrealizability_is_judged_by_what_is_meant(tmp_path: Path) -> None:
    """Whatever it was made for: no set keeps both reaction rules, and doing nothing keeps all others."""
    text = VALVES + "BEGIN REACTION RULES rule: executing close_a rule: NOT executing close_a END REACTION RULES "
    reason = no_set({"A": "open", "B": "open"})
    for made_for in ("one_step", "bounded", "fair"):
        for meant in ("one_step", "bounded", "fair"):
            answer = asked_no(
                tmp_path, f"{text} BEGIN CONFIG restoration: {meant} END CONFIG", reason, made_for=made_for
            )
            assert_proved(answer)
            assert (f"restoration {meant}" in answer.out) == (meant != "one_step")
            answer = asked_no(tmp_path, VALVES, reason, "--restoration", meant, made_for=made_for)
            assert (answer.code == 0) == (meant == "one_step"), answer
    answer = asked_no(tmp_path, text, reason, made_for="never")
    assert (answer.code, answer.out) == (2, "")


TRAP = """
BEGIN STATE VECTOR state P can be a, b, c, d, x END STATE VECTOR
BEGIN RESOURCES resource LEGS END RESOURCES
BEGIN ACTIONS
action ab controlled resources: LEGS preconditions: P is a nominal effects: P is b alternative effects: none
action bc controlled resources: LEGS preconditions: P is b nominal effects: P is c alternative effects: P is a
action bx controlled resources: LEGS preconditions: P is b nominal effects: P is x alternative effects: P is a
action dc controlled resources: LEGS preconditions: P is d nominal effects: P is c
END ACTIONS
BEGIN STATE RULES severity: {} rule: NOT P is c severity: 2 rule: P is x END STATE RULES
"""


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
@pytest.mark.parametrize(
    ("start", "trap", "proved"),
    [
        ("a", "ab", "bounded"),  # from b nominally to x; but back to a for ever
        ("b", "ab", "bounded"),
        ("a", "abx", "bounded"),  # x does not count: it has another level
        ("a", "a", "bounded"),  # a may stay where it is
        ("b", "b", ""),  # nothing leads back to b itself
        ("d", "d", "bounded fair"),  # c is worse, and d does nothing
        ("d", "bd", ""),
        ("d", "abd", "bounded"),
        ("c", "c", "bounded fair"),
        ("a", "b", ""),  # not in it
        ("x", "x", ""),  # safe
    ],
)
def test_traps(restoration: str, start: str, trap: str, proved: str, tmp_path: Path) -> None:
    """No restoration: of which sets it is proved that nothing surely leads out."""
    below = [int(place in trap) for place in "abcdx"]
    reason = {"Kind": "no-restoration", "State": {"P": start}, "Order": ["P"], "Leaves": [False, True], "Root": 2}
    answer = asked_no(tmp_path, TRAP.format(1), {**reason, "Nodes": [[0, below]]}, "--restoration", restoration)
    assert (answer.code == 0) == (restoration in proved), answer
    assert ("unrealizable holds: safety is never surely restored from" in answer.out) == (answer.code == 0)


@pytest.mark.parametrize("change", [{"Root": 9}, {"Root": None}, {"Leaves": [0, 1]}, {"State": {}}, {"Nodes": {}}])
def test_traps_that_have_not_the_form(change: dict[str, Any], tmp_path: Path) -> None:
    """They cannot be judged."""
    reason = {"Kind": "no-restoration", "State": {"P": "a"}, "Order": ["P"], "Leaves": [False, True], "Root": 2}
    answer = asked_no(tmp_path, TRAP.format(1), {**reason, "Nodes": [[0, [1, 1, 0, 0, 0]]], **change})
    assert (answer.code, answer.out.count("unrealizable")) == (2, 0), answer


@pytest.mark.parametrize(
    ("start", "held", "code"),
    [("a", "bc", 3), ("a", "abc", 0), ("b", "bc", 0), ("c", "bc", 0), ("b", "b", 1), ("a", "abcd", 3), ("d", "bc", 1)],
)
def test_no_plan_of_unsafe_states(start: str, held: str, code: int, tmp_path: Path) -> None:
    """All sets that keep the rules are looked at in unsafe states, also where they restore nothing: no verdict then."""
    rules = "BEGIN STATE RULES rule: NOT P is a END STATE RULES BEGIN GOALS goal type: priority goal: P is d END GOALS"
    text = spec_text("abcd", "ab bc cb", rules)
    below = [int(place in held) for place in "abcd"]
    diagram = {"Order": ["P"], "Leaves": [False, True], "Nodes": [[0, below]]}
    goals = [{"Bodies": ["P is d"], "Executed": [], "Layers": [2]}]
    reason = {"Kind": "no-plan", "State": {"P": start}, **diagram, "Goals": goals}
    for restoration in ("bounded", "fair"):
        answer = asked_no(tmp_path, text, reason, "--restoration", restoration)
        assert answer.code == code, answer
        assert ("no verdict: of runs through unsafe states" in answer.err) == (code == 3)


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_a_conflict_of_unsafe_states(restoration: str, tmp_path: Path) -> None:
    """Two unsafe states want different ends of the one way through a third."""
    text = """
    BEGIN STATE VECTOR state P can be s, r, t, x, y END STATE VECTOR
    BEGIN RESOURCES resource LEGS END RESOURCES
    BEGIN ACTIONS
    action st controlled resources: LEGS preconditions: P is s nominal effects: P is t
    action rt controlled resources: LEGS preconditions: P is r nominal effects: P is t
    action tx controlled resources: LEGS preconditions: P is t nominal effects: P is x
    action ty controlled resources: LEGS preconditions: P is t nominal effects: P is y
    END ACTIONS
    BEGIN REACTION RULES rule: NOT (P is s) OR executing st rule: NOT (P is r) OR executing rt END REACTION RULES
    BEGIN STATE RULES rule: P is x OR P is y END STATE RULES
    BEGIN GOALS goal type: priority when P is s then goal: P is x when P is r then goal: P is y END GOALS
    """
    s, r, t, x, y = ({"P": place} for place in "srtxy")
    to_x, to_y, none = ({"Bodies": bodies, "Executed": []} for bodies in (["P is x"], ["P is y"], []))
    reason = {
        "Kind": "conflict",
        "Order": ["P"],
        "Leaves": [None, 0, 1, 2],
        "Nodes": [[0, [3, 3, 2, 1, 0]], [0, [3, 3, 2, 0, 1]], [0, [3, 3, 2, 1, 1]]],
        "Goals": [{**to_x, "Root": 4}, {**to_y, "Root": 5}, {**none, "Root": 6}],
        "Choices": [
            {"State": s, "Options": [{"Successor": t, "Goal": 0}]},
            {"State": r, "Options": [{"Successor": t, "Goal": 1}]},
            {"State": t, "Options": [{"Successor": each, "Goal": 2} for each in (x, y, t)]},
        ],
        "Starts": [0, 1, 2],
        "Cuts": [
            {"Kind": "path", "Goal": 0, "States": [0, 2], "End": y},
            {"Kind": "path", "Goal": 1, "States": [1, 2], "End": x},
            {"Kind": "loop", "Goal": 2, "States": [2]},
        ],
    }
    answer = asked_no(tmp_path, text, reason, "--restoration", restoration)
    assert_proved(answer)
    free = text.replace("when P is r then goal: P is y", "")
    answer = asked_no(
        tmp_path, free, {**reason, "Goals": [reason["Goals"][0], reason["Goals"][2]]}, "--restoration", restoration
    )
    assert answer.code == 2, answer
    for change in ({"Cuts": reason["Cuts"][:2]}, {"Nodes": [[0, [3, 3, 3, 1, 0]], *reason["Nodes"][1:]]}):
        answer = asked_no(tmp_path, text, {**reason, **change}, "--restoration", restoration)
        assert (answer.code, answer.out.count("holds")) == (1, 0), answer


def test_worlds_know_levels(tmp_path: Path) -> None:
    """Levels, and what a step has to keep: of milder rules nothing while a severe one is broken."""
    spec: Spec = parse(EDGE.format(1, 2))
    for restoration, required in (("one_step", (0,)), ("bounded", ())):
        world = checker.World(checker.read_specification(EDGE.format(1, 2).encode()), "any", restoration)
        assert [world.level(state) for state in (("edge", "in"), ("floor", "out"), ("floor", "in"))] == [0, 1, 2]
        assert world.required(("edge", "in")) == required
        assert world.required(("floor", "in")) == (0, 1)
        assert world.required(("floor", "out")) == ((0, 1) if restoration == "one_step" else (0,))
    assert len(spec.tiers) == 2
