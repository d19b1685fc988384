"""Policy files, certificates and exit codes of the stand-alone checker."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.checker.standalone import CHECKER, ask, checker
from tests.generate import random_text
from tests.profiles import PROFILES
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.policy import dumps
from tumato_symbolic.spec import digest

EXAMPLES = CHECKER.parents[1] / "examples"
AMR = (EXAMPLES / "amr.tum").read_text(encoding="utf-8")
WRITES_ANY = AMR.replace("max_plan_length: 5", "max_plan_length: 5\neffect_ordering: any")
WRITES_FIRST = WRITES_ANY.replace("effect_ordering: any", "effect_ordering: first")

Document = dict[str, Any]
Change = Callable[[Document], object]


@cache
def amr_policy() -> str:
    """The policy of the AMR."""
    outcome = synthesize(parse(AMR))
    assert isinstance(outcome, Realizable)
    return dumps(outcome.policy)


@cache
def amr_diagram() -> str:
    """The policy of the AMR as a diagram."""
    outcome = synthesize(parse(AMR), policy_format="diagram")
    assert isinstance(outcome, Realizable)
    return dumps(outcome.policy)


def changed(change: Change, policy: Callable[[], str] = amr_policy) -> str:
    """The policy of the AMR after a change."""
    document = json.loads(policy())
    change(document)
    return json.dumps(document)


def row_of(document: Document, location: str, conveyor: str) -> Document:
    """The row of an ordinary state: battery ok, loaded."""
    wanted = {"S_Location": location, "S_Battery": "ok", "S_Load": "loaded", "S_Conveyor": conveyor}
    return next(row for row in document["Policy"] if {**row, "Actions": []} == {**wanted, "Actions": []})


def decide(location: str, conveyor: str, *actions: str) -> str:
    """The policy of the AMR with another decision in one state."""
    return changed(lambda document: row_of(document, location, conveyor).update(Actions=list(actions)))


HARMLESS: dict[str, Change] = {
    "nothing": lambda document: None,
    "only what Tumato 2.0 writes": lambda document: [
        document.pop(key) for key in ("FormatVersion", "SpecificationDigest", "EffectOrdering", "Certificate")
    ],
    "rows in another order": lambda document: document["Policy"].reverse(),
    "a row twice": lambda document: document["Policy"].append(document["Policy"][0]),
    "an action twice in a row": lambda document: row_of(document, "corridor", "on")["Actions"].append("stop_conveyor"),
    "actions in another order": lambda document: document["Actions"].reverse(),
    "variables in another order": lambda document: document.update(States=dict(reversed(document["States"].items()))),
    "an unknown section": lambda document: document.update(Remarks=[1]),
}

BROKEN: dict[str, Change] = {
    "a diagram": lambda document: document.update(Type="policy-diagram"),
    "no type": lambda document: document.pop("Type"),
    "table and diagram": lambda document: document.update(Diagram={}),
    "no actions": lambda document: document.pop("Actions"),
    "an unknown action": lambda document: document["Actions"].append("fly"),
    "an action without declaration": lambda document: document["Actions"].remove("stop_conveyor"),
    "no variables": lambda document: document.pop("States"),
    "a missing variable": lambda document: document["States"].pop("S_Load"),
    "an unknown variable": lambda document: document["States"].update(S_Door={"open": 0}),
    "an unknown value": lambda document: document["States"]["S_Load"].update(half=2),
    "a missing value": lambda document: document["States"]["S_Load"].pop("free"),
    "an index twice": lambda document: document["States"]["S_Load"].update(free=0),
    "no rows": lambda document: document.pop("Policy"),
    "a row without a variable": lambda document: document["Policy"][0].pop("S_Load"),
    "a row with another variable": lambda document: document["Policy"][0].update(S_Door="open"),
    "a row with an unknown value": lambda document: document["Policy"][0].update(S_Load="half"),
    "a row with a number": lambda document: document["Policy"][0].update(S_Load=0),
    "a row with a list": lambda document: document["Policy"][0].update(S_Load=["free"]),
    "a row without actions": lambda document: document["Policy"][0].pop("Actions"),
    "a row with an object of actions": lambda document: document["Policy"][0].update(Actions={}),
    "a row with a text of actions": lambda document: document["Policy"][0].update(Actions=""),
    "a row with a list of lists": lambda document: document["Policy"][0].update(Actions=[["charge"]]),
    "a row with an unknown action": lambda document: document["Policy"][0]["Actions"].append("fly"),
    "contradictory rows": lambda document: document["Policy"].append({**document["Policy"][0], "Actions": ["charge"]}),
    "another version": lambda document: document.update(FormatVersion=2),
    "version nought": lambda document: document.update(FormatVersion=0),
    "an unknown ordering": lambda document: document.update(EffectOrdering="last"),
}


def _diagram(**sections: object) -> Change:
    """Sections of the diagram exchanged."""
    return lambda document: document["Diagram"].update(sections)


def _first_node(node: object) -> Change:
    return lambda document: document["Diagram"]["Nodes"].__setitem__(0, node)


def _repeat_last(document: Document) -> None:
    """A node that leads to another one that tests the same variable."""
    nodes = document["Diagram"]["Nodes"]
    level, below = nodes[-1]
    nodes.append([level, [len(document["Diagram"]["Leaves"]) + len(nodes) - 1, *below[1:]]])


BROKEN_DIAGRAMS: dict[str, Change] = {
    "a table": lambda document: document.update(Type="policy"),
    "diagram and table": lambda document: document.update(Policy=[]),
    "no diagram": lambda document: document.pop("Diagram"),
    "a list": lambda document: document.update(Diagram=[]),
    "no order": lambda document: document["Diagram"].pop("Order"),
    "an unknown variable": lambda document: document["Diagram"]["Order"].append("S_Door"),
    "a variable twice": lambda document: document["Diagram"]["Order"].append(document["Diagram"]["Order"][0]),
    "leaves the other way round": _diagram(Leaves=[True, False]),
    "leaves that are numbers": _diagram(Leaves=[0, 1]),
    "three leaves": _diagram(Leaves=[False, True, True]),
    "no leaves": _diagram(Leaves=[]),
    "an action without a root": lambda document: document["Diagram"]["Roots"].pop("charge"),
    "a root of an unknown action": lambda document: document["Diagram"]["Roots"].update(fly=0),
    "a root too large": lambda document: document["Diagram"]["Roots"].update(
        charge=2 + len(document["Diagram"]["Nodes"])
    ),
    "roots in a list": lambda document: document["Diagram"].update(Roots=document["Actions"]),
    "a root that is true": lambda document: document["Diagram"]["Roots"].update(charge=True),
    "a root below 0": lambda document: document["Diagram"]["Roots"].update(charge=-1),
    "no word on what is decided": lambda document: document["Diagram"].pop("Defined"),
    "a node that leads to itself": _first_node([3, [0, 2]]),
    "a node above one of its own variable": _repeat_last,
    "a node of no level": _first_node([9, [0, 1]]),
    "a node with a child too many": _first_node([3, [0, 1, 1, 1, 1, 1, 1]]),
    "a node that is no pair": _first_node([3, [0, 1], 0]),
    "a node with a child that is a text": _first_node([3, ["0", "1"]]),
}


@pytest.mark.parametrize("name", HARMLESS)
def test_right_policies_hold(name: str, tmp_path: Path) -> None:
    """What does not matter does not change the verdict."""
    answer = ask(tmp_path, changed(HARMLESS[name]), AMR)
    assert (answer.code, answer.failing, answer.states) == (0, {}, (32, 24))


@pytest.mark.parametrize("name", BROKEN)
def test_broken_policies_are_refused(name: str, tmp_path: Path) -> None:
    """A policy that does not fit the format or the specification is not judged."""
    answer = ask(tmp_path, changed(BROKEN[name]), AMR)
    assert (answer.code, answer.out) == (2, "")
    assert answer.err.startswith("cannot be judged: ")


@pytest.mark.parametrize("name", BROKEN_DIAGRAMS)
def test_broken_diagrams_are_refused(name: str, tmp_path: Path) -> None:
    """So is a diagram that does not fit."""
    answer = ask(tmp_path, changed(BROKEN_DIAGRAMS[name], amr_diagram), AMR)
    assert (answer.code, answer.out) == (2, "")
    assert answer.err.startswith("cannot be judged: ")


def test_a_diagram_is_judged_as_the_table_is(tmp_path: Path) -> None:
    """The same verdict with the same certificate; one action more by its root, one state less by `Defined`."""
    assert ask(tmp_path, amr_diagram(), AMR, "--strict").out == ask(tmp_path, amr_policy(), AMR, "--strict").out
    eager = changed(lambda document: document["Diagram"]["Roots"].update(charge=1), amr_diagram)
    assert ask(tmp_path, eager, AMR).failing["safe"] > 0
    silent = changed(_diagram(Defined=0), amr_diagram)
    assert ask(tmp_path, silent, AMR).failing == {"total": 32}


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"Type": "policy", "Type": "policy"}', '{"Type": NaN}', "[" * 100_000]
)
def test_what_is_no_json_object_is_refused(text: str, tmp_path: Path) -> None:
    """Texts that are not one JSON object with distinct keys are not judged."""
    assert ask(tmp_path, text, AMR).code == 2


def test_rows_for_invalid_states_play_no_part(tmp_path: Path) -> None:
    """A decision in a state that is not valid may be anything, or missing."""
    spec = AMR + "BEGIN ASSUMPTIONS assume: NOT (S_Location is charger AND S_Conveyor is on) END ASSUMPTIONS"
    assert ask(tmp_path, decide("charger", "on", "receive_workpiece"), spec).failing == {}


def test_missing_row_fails_total(tmp_path: Path) -> None:
    """A valid state without a row is named."""
    answer = ask(tmp_path, changed(lambda document: document["Policy"].pop(0)), AMR)
    assert (answer.code, answer.failing) == (1, {"total": 1})
    assert "no decision in (S_Location corridor, S_Battery low, S_Load loaded, S_Conveyor on)" in answer.out


def test_an_undecided_outcome_is_named_with_its_decision(tmp_path: Path) -> None:
    """Of the states without a decision, one that a decision leads to is told first, and which decision that is."""
    document = json.loads(amr_policy())
    rows = document["Policy"]
    gone = {"S_Location": "charger", "S_Battery": "ok", "S_Load": "free", "S_Conveyor": "off"}
    document["Policy"] = [row for row in rows if any(row[name] != value for name, value in gone.items())]
    answer = ask(tmp_path, json.dumps(document), AMR)
    assert answer.failing == {"total": 1} or "goals" in answer.failing
    assert "which is an outcome of a decision: in (S_Location charger, S_Battery low" in answer.out


def test_too_many_outcomes_are_no_witness(monkeypatch: pytest.MonkeyPatch) -> None:
    """A policy that is not total is refuted all the same."""
    world = checker.World(checker.read_specification(AMR.encode()), "any")
    start = world.valid[0]
    monkeypatch.setattr(checker, "LARGEST", 0)
    monkeypatch.setattr(checker.World, "objection", lambda *_: None)
    judge = checker.Judge(world, lambda state: None if state == start else frozenset(("move_to_charger",)))
    assert (judge.missing, judge.departure()) == ([start], None)
    assert judge.undecided(start) == f"no decision in {world.show(start)}"


def test_the_first_undecided_outcome_is_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other one is looked for: only one is told."""
    world = checker.World(checker.read_specification(AMR.encode()), "any")
    *decided, last = world.valid
    judge = checker.Judge(world, lambda state: frozenset(("charge",)) if state in decided else None)
    asked = []

    def outcomes(_: object, state: object, __: object) -> list[object]:
        asked.append(state)
        return [(last if len(asked) > 1 else state, [])]

    monkeypatch.setattr(checker.World, "outcomes", outcomes)
    assert judge.departure() == (decided[1], last)
    assert asked == decided[:2]


def test_unsafe_decision_names_the_rule(tmp_path: Path) -> None:
    """Where an outcome breaks a state rule, the outcome and the line of the rule are told."""
    answer = ask(tmp_path, decide("workstation_1", "on", "move_to_corridor"), AMR)
    line = 1 + AMR.split("\n").index("rule: IF S_Location is corridor OR S_Location is charger THEN S_Conveyor is off")
    assert answer.code == 1
    assert "safe" in answer.failing
    assert f"breaks the state rule at line {line}: `rule: IF S_Location is corridor" in answer.out


def test_waiting_for_ever_misses_the_goal(tmp_path: Path) -> None:
    """A run that comes back to where it was is shown."""
    answer = ask(tmp_path, decide("corridor", "off"), AMR)
    assert answer.code == 1
    assert set(answer.failing) == {"goals"}
    assert "its goal is S_Load is free" in answer.out
    assert "round again" in answer.out


def test_too_short_a_bound_misses_the_goal(tmp_path: Path) -> None:
    """A run that is longer than `max_plan_length` fails."""
    answer = ask(tmp_path, amr_policy(), AMR.replace("max_plan_length: 5", "max_plan_length: 3"))
    assert (answer.code, set(answer.failing)) == (1, {"goals"})
    assert "after 4 steps, more than 3" in answer.out


def test_dearer_restoration_is_not_minimal(tmp_path: Path) -> None:
    """The decision of Tumato 2.0 in (corridor, ok, loaded, on) is refuted by a cheaper one."""
    answer = ask(tmp_path, decide("corridor", "on", "move_to_workstation_2"), AMR)
    assert (answer.code, answer.failing) == (1, {"minimal": 1})
    assert "{move_to_workstation_2} (duration 10): {stop_conveyor} (duration 1) would serve as well" in answer.out


def recording(ordering: str | None) -> str:
    """The policy of the AMR, made under an ordering, or without a word about it."""
    if ordering is None:
        return changed(lambda document: document.pop("EffectOrdering"))
    return changed(lambda document: document.update(EffectOrdering=ordering))


@pytest.mark.parametrize(
    ("spec", "recorded", "asked", "used"),
    [
        (AMR, None, None, "any"),
        (WRITES_FIRST, None, None, "first"),
        (WRITES_FIRST, "any", None, "first"),
        (AMR, "any", None, "any"),
        (AMR, "first", "any", "any"),
        (AMR, "first", "first", "first"),
        (WRITES_FIRST, "first", "any", "any"),
        (WRITES_ANY, "any", "first", "first"),
        (WRITES_ANY, "first", "first", "first"),
    ],
)
def test_ordering(spec: str, recorded: str | None, asked: str | None, used: str, tmp_path: Path) -> None:
    """The ordering is the command line's, else the specification's, else `any`; what a policy records is not asked."""
    answer = ask(tmp_path, recording(recorded), spec, *(["--effect-ordering", asked] if asked else []))
    assert answer.code == 0
    assert f"effect ordering {used}\n" in answer.out


@pytest.mark.parametrize("spec", [AMR, WRITES_ANY])
def test_first_does_not_pass_for_any(spec: str, tmp_path: Path) -> None:
    """A policy made for `first` fails where the specification means `any` and nobody asks for `first`."""
    answer = ask(tmp_path, recording("first"), spec)
    assert (answer.code, answer.failing) == (1, {})
    assert "ordering FAILS" in answer.out


def _goal(document: Document, number: int) -> Document:
    found: Document = document["Certificate"]["Goals"][number]
    return found


WRONG_CERTIFICATES: dict[str, Change] = {
    "null": lambda document: document.update(Certificate=None),
    "empty": lambda document: document.update(Certificate={}),
    "another goal": lambda document: _goal(document, 0).update(Bodies=["S_Battery is low"]),
    "no predicate": lambda document: _goal(document, 0).update(Bodies=["what ever"]),
    "an action that is not mentioned": lambda document: _goal(document, 0).update(Executed=["charge"]),
    "a goal twice": lambda document: document["Certificate"]["Goals"].append(_goal(document, 0)),
    "always reached": lambda document: _goal(document, 0).update(Root=1),
    "the ranks of another goal": lambda document: _goal(document, 0).update(Root=_goal(document, 1)["Root"]),
    "a root that is not there": lambda document: _goal(document, 0).update(Root=10_000),
    "a rank below nothing": lambda document: document["Certificate"]["Leaves"].__setitem__(1, -1),
    "a rank that rises": lambda document: document["Certificate"]["Leaves"].__setitem__(2, 50),
    "ranks beyond the bound": lambda document: document["Certificate"].update(
        Leaves=[rank and 3 * rank for rank in document["Certificate"]["Leaves"]]
    ),
    "variables in another order": lambda document: document["Certificate"]["Order"].reverse(),
    "a node that leads to itself": lambda document: document["Certificate"]["Nodes"][0][1].__setitem__(
        0, len(document["Certificate"]["Leaves"])
    ),
}


INCOMPLETE_CERTIFICATES: dict[str, Change] = {
    "a goal is missing": lambda document: document["Certificate"]["Goals"].pop(),
    "no rank at all": lambda document: _goal(document, 0).update(Root=0),
}

STALE_CERTIFICATES: dict[str, Change] = {
    "no digest": lambda document: document.pop("SpecificationDigest"),
    "another digest": lambda document: document.update(SpecificationDigest="sha256:0"),
    "another digest and false ranks": lambda document: document.update(SpecificationDigest="", Certificate=None),
}


@pytest.mark.parametrize("name", INCOMPLETE_CERTIFICATES)
def test_incomplete_certificates_hold(name: str, tmp_path: Path) -> None:
    """A rank that is missing claims nothing false: it is reported, and no more, also with `--strict`."""
    answer = ask(tmp_path, changed(INCOMPLETE_CERTIFICATES[name]), AMR, "--strict")
    assert answer.code == 0
    assert "certificate: incomplete: " in answer.out


@pytest.mark.parametrize("name", STALE_CERTIFICATES)
def test_stale_certificates_count_when_strict(name: str, tmp_path: Path) -> None:
    """A certificate for another meaning is not looked at, and fails with `--strict` only."""
    policy = changed(STALE_CERTIFICATES[name])
    lenient, strict = ask(tmp_path, policy, AMR), ask(tmp_path, policy, AMR, "--strict")
    assert (lenient.code, strict.code) == (0, 1)
    assert "certificate: STALE" in lenient.out


def test_the_digest_is_the_package_s(tmp_path: Path) -> None:
    """The same meaning has the same digest in the checker and in the package, whatever the text looks like."""
    for profile in PROFILES.values():
        for seed in range(20):
            text = random_text(seed, profile)
            own = checker.digest(checker.resolve(checker.Parser(text).specification()))
            assert own == digest(parse(text)), (seed, text)


@pytest.mark.parametrize("name", WRONG_CERTIFICATES)
def test_wrong_certificates_count_when_strict(name: str, tmp_path: Path) -> None:
    """A wrong certificate is reported, and spoils a right policy with `--strict` only."""
    policy = changed(WRONG_CERTIFICATES[name])
    lenient, strict = ask(tmp_path, policy, AMR), ask(tmp_path, policy, AMR, "--strict")
    assert (lenient.code, strict.code) == (0, 1)
    assert "certificate: WRONG" in lenient.out
    assert lenient.out == strict.out


@pytest.mark.parametrize("change", [HARMLESS["nothing"], HARMLESS["only what Tumato 2.0 writes"]])
def test_right_or_absent_certificates_hold(change: Change, tmp_path: Path) -> None:
    """A right certificate passes `--strict`, and so does a policy without one."""
    assert ask(tmp_path, changed(change), AMR, "--strict").code == 0


def test_any_decreasing_rank_is_right(tmp_path: Path) -> None:
    """Ranks need not count steps, as long as they fall and stay below the bound."""
    spec = AMR.replace("max_plan_length: 5", "max_plan_length: 50")

    def double(document: Document) -> None:
        document["SpecificationDigest"] = digest(parse(spec))
        document["Certificate"]["Leaves"] = [rank and 2 * rank for rank in document["Certificate"]["Leaves"]]

    answer = ask(tmp_path, changed(double), spec, "--strict")
    assert (answer.code, "certificate: right" in answer.out) == (0, True)


@pytest.mark.parametrize("path", sorted(CHECKER.parent.glob("*.policy.json")), ids=lambda path: path.name)
def test_committed_policies_are_right(path: Path, tmp_path: Path) -> None:
    """Every policy in `proofs/` is right, and so is its certificate."""
    example = EXAMPLES / path.name.replace(".policy.json", ".tum")
    answer = ask(tmp_path, path.read_text(encoding="utf-8"), example.read_text(encoding="utf-8"), "--strict")
    assert (answer.code, answer.failing) == (0, {})
    assert "certificate: right" in answer.out


@pytest.mark.parametrize(
    ("policy", "spec", "code"),
    [
        (amr_policy, lambda: AMR, 0),
        (amr_policy, lambda: "\ufeff" + AMR.replace("\n", "\r\n"), 0),
        (lambda: decide("corridor", "off"), lambda: AMR, 1),
        (lambda: "{", lambda: AMR, 2),
        (amr_policy, lambda: AMR + "BEGIN", 2),
        (amr_policy, lambda: AMR.replace("rule:", "rule: " + "(" * 30_000), 2),
        (
            amr_policy,
            lambda: (
                "BEGIN STATE VECTOR " + " ".join(f"state V{n} can be a, b" for n in range(60)) + " END STATE VECTOR"
            ),
            2,
        ),
    ],
)
def test_exit_codes(policy: Callable[[], str], spec: Callable[[], str], code: int, tmp_path: Path) -> None:
    """As a process, anywhere, without the package: 0 holds, 1 fails, 2 cannot be judged; never a traceback."""
    (tmp_path / "policy.json").write_text(policy(), encoding="utf-8")
    (tmp_path / "spec.tum").write_bytes(spec().encode())
    command = [sys.executable, "-S", "-I", str(CHECKER), "policy.json", "spec.tum"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == code
    assert "Traceback" not in done.stderr


def test_too_many_states_are_no_verdict(tmp_path: Path) -> None:
    """More states than can be looked at end in exit code 3, not in a verdict."""
    names = [f"V{number}" for number in range(60)]
    spec = "BEGIN STATE VECTOR " + " ".join(f"state {name} can be a, b" for name in names) + " END STATE VECTOR"
    states = {name: {"a": 0, "b": 1} for name in names}
    policy = json.dumps({"Type": "policy", "Actions": [], "States": states, "Policy": []})
    assert ask(tmp_path, policy, spec).code == 3


@pytest.mark.parametrize("arguments", [[], ["policy.json"], ["policy.json", "no.tum"], [".", "."]])
def test_usage(arguments: list[str], tmp_path: Path) -> None:
    """Wrong usage and files that cannot be read are exit code 2."""
    command = [sys.executable, str(CHECKER), *arguments]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 2


def test_standard_library_only() -> None:
    """The checker imports nothing but the standard library."""
    tree = ast.parse(CHECKER.read_text(encoding="utf-8"))
    plain = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    named = {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert {name.partition(".")[0] for name in plain | named} <= sys.stdlib_module_names
