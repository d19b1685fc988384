"""Values that are numbers, in every file of this project: written as numbers, read as numbers or as their digits."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, Literal

import pytest

from tests.checker.standalone import ask
from tumato_symbolic import Realizable, Unrealizable, parse, synthesize
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import dumps, guarantees, loads, unrealizability
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.guarantees.analyse import guarantees as analysed

RUNNING = """
BEGIN STATE VECTOR state N can be -1..2 state B can be 0, 1, off END STATE VECTOR
BEGIN ACTIONS
  action up preconditions: B is not off nominal effects: N is N + 1 alternative effects: none
  action on preconditions: B is off nominal effects: B is 0
END ACTIONS
BEGIN STATE RULES rule: N < 3 END STATE RULES
BEGIN GOALS goal type: priority goal: N is 2 END GOALS
"""
FAILING = RUNNING.replace("N < 3", "N < 2")


def with_digits(document: str) -> str:
    """The same with texts where rows, states and cubes have numbers."""
    return re.sub(r'"(N|B)": (-?[0-9]+)(?=[,}])', r'"\1": "\2"', document)


def solved(text: str, form: Literal["table", "diagram"] = "table") -> tuple[Spec, Any]:
    """The specification and the outcome."""
    spec = parse(text)
    return spec, synthesize(spec, policy_format=form)


@pytest.mark.parametrize("form", ["table", "diagram"])
def test_policies(form: Literal["table", "diagram"], tmp_path: Path) -> None:
    """Rows have numbers; with digits in their place it is the same policy, for both readers."""
    _, outcome = solved(RUNNING, form)
    assert isinstance(outcome, Realizable)
    document = dumps(outcome.policy)
    assert form == "diagram" or '{"N": -1, "B": "off", "Actions"' in document
    assert loads(document) == loads(with_digits(document)) == outcome.policy
    for each in (document, with_digits(document)):
        assert ask(tmp_path, each, RUNNING, "--strict").code == 0


@pytest.mark.parametrize("wrong", ["true", "1.0", '"01"', "3", "null", "[1]", "1e0", "12345678901234567890"])
def test_what_passes_for_no_number(wrong: str, tmp_path: Path) -> None:
    """In a table that has the number 1, nothing else passes for it, for either reader."""
    _, outcome = solved(RUNNING)
    document = dumps(outcome.policy)
    changed = document.replace('{"N": 1, "B": 1', f'{{"N": {wrong}, "B": 1')
    assert changed != document
    with pytest.raises(UserError):
        loads(changed)
    assert ask(tmp_path, changed, RUNNING, "--strict").code == 2


def test_certificates_that_there_is_no_policy(tmp_path: Path) -> None:
    """The states of a certificate of *no*."""
    spec, outcome = solved(FAILING)
    assert isinstance(outcome, Unrealizable)
    assert outcome.certificate is not None
    document = unrealizability.dumps(outcome.certificate)
    assert re.search(r'"N": -?[0-9]', document)
    assert unrealizability.loads(with_digits(document)) == unrealizability.loads(document) == outcome.certificate
    assert [ask(tmp_path, each, FAILING).code for each in (document, with_digits(document))] == [0, 0]
    assert spec.variables[0].values[0] == "-1"


def test_certificates_of_guarantees(tmp_path: Path) -> None:
    """The cubes of levels."""
    spec, outcome = solved(RUNNING)
    certificate = analysed(outcome.policy, spec, "any", certify=True).certificate
    assert certificate is not None
    levels = json.loads(guarantees.dumps(certificate))["Levels"]
    assert any(isinstance(value, int) for level in levels for cube in level["Cubes"] for value in cube.get("N", []))
    document = json.loads(guarantees.dumps(certificate))
    for level in [{}, *document["Levels"]]:  # first as it is written, then level by level with digits
        for cube in level.get("Cubes", ()):
            cube.update({name: [str(value) for value in values] for name, values in cube.items()})
        (tmp_path / "guarantees.json").write_text(json.dumps(document))
        options = ("--guarantees", str(tmp_path / "guarantees.json"))
        assert ask(tmp_path, dumps(outcome.policy), RUNNING, *options).code == 0
