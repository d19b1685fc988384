"""Which cases an action has, what is said of wrong clauses, and that only the action is seen from outside."""

from __future__ import annotations

import json
import re
import time
from pathlib import Path

import pytest

from tests.checker.standalone import ask, checker
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.export.coq import export
from tumato_symbolic.policy import Policy, bind, dumps, loads, policy_from_rows
from tumato_symbolic.semantics import all_states, allowed, cases_in
from tumato_symbolic.spec import Action, Spec, canonical_text, digest, load
from tumato_symbolic.spec.loading import Loaded
from tumato_symbolic.synthesis import Realizable, synthesize
from tumato_symbolic.verify import verify

VARIABLES = "state N can be 0..3 state P can be a, b state Q can be x, y"
DRAINING = """BEGIN STATE VECTOR
state Level can be 0..4
state Place can be dock, hall, yard
state Done can be no, yes
END STATE VECTOR
BEGIN ACTIONS
action drive
  duration: 2
  preconditions: Level >= 1
  nominal effects: Level is Level - 1
    when Place is dock OR Place is yard: Place is hall
    when Place is hall AND Done is no: Place is yard
    when Place is hall AND Done is yes: Place is dock
action charge
  preconditions: Level < 4
  nominal effects: Level is Level + 1
action work
  preconditions: Place is yard
  nominal effects: Done is yes
END ACTIONS
BEGIN REACTION RULES
rule: NOT (executing drive AND executing work)
END REACTION RULES
BEGIN STATE RULES
rule: NOT (Place is yard AND Level is 0)
END STATE RULES
BEGIN GOALS
goal type: priority
when Done is no then goal: executing drive OR Done is yes
goal: Place is dock
END GOALS
"""


def loaded(fields: str, more: str = "") -> Loaded:
    """What is read of one action with these fields."""
    text = f"BEGIN STATE VECTOR {VARIABLES} END STATE VECTOR BEGIN ACTIONS action go {fields} END ACTIONS {more}"
    return load(Source("clauses", text))


def codes(found: Loaded) -> list[str]:
    """The codes of what is said of actions, whatever else is unused."""
    return [each.code.name for each in found.diagnostics if not re.match("TUM3(26|4.)", each.code.name)]


def cases(fields: str, more: str = "") -> list[tuple[str | None, str]]:
    """The guard of each case and what it nominally writes."""
    spec = loaded(fields, more).spec
    assert spec is not None

    def written(action: Action) -> str:
        return " ".join(f"{spec.variables[v].name}={spec.variables[v].values[value]}" for v, value in action.nominal)

    return [
        (None if each.guard is None else canonical_text(spec, each.guard.formula), written(each))
        for each in spec.actions
    ]


def draining() -> Spec:
    """A robot whose battery drains."""
    spec = load(Source("draining", DRAINING)).spec
    assert spec is not None
    return spec


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ("effects: Q is y when P is a: N is 0", [("P is a", "N=0 Q=y"), ("P is b", "Q=y")]),
        ("effects: none when P is a: Q is x when P is not a: Q is x", [(None, "Q=x")]),
        ("effects: none when true: Q is x", [(None, "Q=x")]),
        ("effects: N is N - 2", [("(N is 0) OR (N is 1) OR (N is 2)", "N=0"), ("N is 3", "N=1")]),
        (
            "effects: none when P is a AND Q is x: N is 1",
            [("(P is a) AND (Q is x)", "N=1"), ("((P is a) AND (Q is y)) OR (P is b)", "")],
        ),
        (
            "effects: none when P is a: N is N + 1",
            [("(N is 0) AND (P is a)", "N=1"), ("P is b", ""), ("(N is 1) AND (P is a)", "N=2"),
             ("((N is 2) OR (N is 3)) AND (P is a)", "N=3")],
        ),
    ],
)  # fmt: skip
def test_cases_are_what_may_happen(fields: str, expected: list[tuple[str | None, str]]) -> None:
    """One case for each thing that an action may do, with the states in which it does it."""
    assert cases(fields) == expected


def test_components_are_multiplied() -> None:
    """Conditions about different variables make a case of each combination."""
    assert len(cases("effects: none when P is a: N is 1 alternative effects: none when Q is x: P is b")) == 4


@pytest.mark.parametrize(
    ("fields", "code", "shown"),
    [
        ("effects: none when P is a: N is 1 when Q is x: N is 2", "TUM305", "where P is a, Q is x"),
        ("preconditions: Q is x effects: N is 0 when P is a: N is 1", "TUM305", "where P is a, Q is x"),
        ("effects: none alternative effects: N is 0 when P is a: N is 1", "TUM306", "where P is a"),
        ("effects: none when P is a: Q is x OR Q is y", "TUM305", "`Q is x`; `Q is y`"),
        ("effects: P is P - 1", "TUM318", "values that are not numbers"),
        ("effects: N is Q + 1", "TUM318", "another variable"),
        ("effects: N is N + 0", "TUM318", "not by 0"),
        ("effects: N is N - -1", "TUM318", "not by -1"),
        ("effects: none when executing go: N is 1", "TUM304", "the condition of an effect"),
        ("effects: none when R is a: N is 1", "TUM201", "no state variable `R`"),
    ],
)
def test_wrong_clauses_are_errors(fields: str, code: str, shown: str) -> None:
    """Each mistake has its code, and shows the state or what is wrong; the stand-alone checker refuses it as well."""
    found = loaded(fields)
    assert found.spec is None
    assert [each.code.name for each in found.diagnostics if each.code.severity == "error"] == [code]
    assert shown in next(each.message for each in found.diagnostics if each.code.name == code)
    text = f"BEGIN STATE VECTOR {VARIABLES} END STATE VECTOR BEGIN ACTIONS action go {fields} END ACTIONS"
    with pytest.raises(checker.Unreadable):
        checker.read_specification(text.encode())


@pytest.mark.parametrize(
    ("fields", "more"),
    [
        ("preconditions: NOT (P is a AND Q is x) effects: none when P is a: N is 1 when Q is x: N is 2", ""),
        ("effects: none when P is a: N is 1 when Q is x: N is 2", "BEGIN ASSUMPTIONS assume: Q is y END ASSUMPTIONS"),
    ],
)
def test_what_cannot_be_met_is_no_error(fields: str, more: str) -> None:
    """Effects may disagree where preconditions or assumptions exclude it."""
    assert "TUM305" not in codes(loaded(fields, more))


def test_leaving_the_range_is_a_warning() -> None:
    """Only where no precondition excludes it; the message shows the value at the end, and a precondition."""
    found = loaded("effects: N is N - 2")
    assert codes(found) == ["TUM331"]
    (warning,) = (each for each in found.diagnostics if each.code.name == "TUM331")
    assert "where N is 0; it becomes 0 there" in warning.message
    assert "`N >= 2`" in (warning.help or "")
    assert codes(loaded("preconditions: N >= 2 effects: N is N - 2")) == []
    assert codes(loaded("effects: none when N > 1: N is N - 2")) == []


def test_too_many_cases_end_at_once() -> None:
    """Conditions that make too many cases, or too much work, are an error, and soon."""
    many = " ".join(f"state V{number} can be 0..99" for number in range(4))
    clauses = " ".join(f"when V{number} > 50 AND V{number + 1} > 3: V0 is 1" for number in range(3))
    for fields in (clauses, ", ".join(f"V{number} is V{number} + 1" for number in range(3))):
        text = f"BEGIN STATE VECTOR {many} END STATE VECTOR BEGIN ACTIONS action go effects: {fields} END ACTIONS"
        started = time.process_time()
        assert "TUM319" in codes(load(Source("many", text)))
        assert time.process_time() - started < 3


def test_a_relative_effect_is_a_clause_for_each_value() -> None:
    """A relative effect has the digest of its clauses; both readers compute the same."""
    short = loaded("effects: N is N + 1 when P is a: Q is y, N is N + 1").spec
    steps = " ".join(f"when N is {value}: N is {min(value + 1, 3)}" for value in range(4))
    under = " ".join(f"when P is a AND N is {value}: N is {min(value + 1, 3)}" for value in range(4))
    long = loaded(f"effects: none {under} {steps} when P is a: Q is y").spec
    assert short is not None
    assert long is not None
    assert digest(short) == digest(long)
    assert [each.nominal for each in short.actions] == [each.nominal for each in long.actions]


def test_outside_there_is_only_the_action() -> None:
    """A policy names actions; bound to the specification it executes cases, and every prover proves it."""
    spec = draining()
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    assert json.loads(dumps(outcome.policy))["Actions"] == ["drive", "charge", "work"]
    policy = loads(dumps(outcome.policy))
    assert isinstance(policy, Policy)
    assert len(bind(policy, spec).vocabulary.actions) == len(spec.actions) > 3
    for prover in ("explicit", "walk", "z3"):
        assert verify(policy, spec, prover=prover).verdict == "proved"


def test_an_action_that_never_starts_keeps_its_clauses() -> None:
    """They belong to the meaning that the digest covers, in both readers."""
    fields = "preconditions: P is a, P is b effects: none when N > 1: P is"
    block = f"BEGIN STATE VECTOR {VARIABLES} END STATE VECTOR BEGIN ACTIONS action go {fields}"
    texts = [f"{block} {value} END ACTIONS" for value in ("a", "b")]
    found = [digest(parse(text)) for text in texts]
    assert len(set(found)) == 2
    assert found == [checker.digest(checker.read_specification(text.encode())) for text in texts]


def test_the_condition_of_a_clause_is_no_precondition(tmp_path: Path) -> None:
    """Where preconditions have to hold throughout, conditions still are read at the start only, by every judge."""
    text = """BEGIN STATE VECTOR state P can be a, b state Q can be x, y END STATE VECTOR BEGIN ACTIONS
    action go effects: none when Q is x: P is b when Q is y: P is a action other effects: Q is y END ACTIONS
    BEGIN CONFIG preconditions: throughout END CONFIG"""
    spec = load(Source("throughout", text)).spec
    assert spec is not None
    both = frozenset((0, 1))
    rows = {state: cases_in(spec, both, state) for state in all_states(spec)}
    policy = policy_from_rows(spec, rows, "any")
    for prover in ("explicit", "walk", "z3"):
        assert verify(policy, spec, prover=prover).verdict == "proved"
    assert all(allowed(spec, state, chosen, "any") for state, chosen in rows.items())
    assert ask(tmp_path, dumps(policy), text).code == 0
    exported = export(policy, spec, "any")
    assert "guard := [Is 1 0]" in exported
    assert "guard := [Is 1 1]" in exported


@pytest.mark.parametrize(
    ("effects", "help_"),
    [
        ("none when P is a then Q is x", "write `when CONDITION: EFFECT`"),
        ("N is N - 1 AND P is a", "write a comma"),
        ("NOT N is N + 1", "stands alone"),
        ("N is 3 - 1", "stands alone"),
    ],
)
def test_what_does_not_fit_in_a_clause_is_told(effects: str, help_: str) -> None:
    """With the form that was probably meant."""
    found = loaded(f"effects: {effects}")
    assert found.spec is None
    assert help_ in (found.diagnostics[0].help or "")
