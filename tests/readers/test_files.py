"""Files as they come from elsewhere, through both commands."""

from __future__ import annotations

import json
from pathlib import Path
from random import Random

from tests.checker.standalone import ask
from tests.repo.documents import ROOT
from tests.repo.examples import solved
from tumato_symbolic import Realizable
from tumato_symbolic.cli.main import main as tumato_sym
from tumato_symbolic.policy import dumps

LONE_RETURN = """BEGIN STATE VECTOR
state S_x can be a, b
END STATE VECTOR
BEGIN ACTIONS
action go nominal effects: S_x is b
END ACTIONS
BEGIN STATE RULES // rules\rrule: S_x is a
END STATE RULES
BEGIN GOALS goal type: priority goal: true END GOALS
"""


def codes(folder: Path, policy: str, spec: str) -> tuple[int, int]:
    """The exit codes of `verify` and of the checker."""
    answer = ask(folder, policy, spec)
    return tumato_sym(["verify", str(folder / "policy.json"), str(folder / "spec.tum")]), answer.code


def test_a_rule_after_a_lone_return_is_a_rule(tmp_path: Path) -> None:
    """It is on a line of its own, not part of the comment before it; both find the policy that breaks it."""
    rows = [{"S_x": "a", "Actions": ["go"]}, {"S_x": "b", "Actions": []}]
    policy = {"Type": "policy", "Actions": ["go"], "States": {"S_x": {"a": 0, "b": 1}}, "Policy": rows}
    assert codes(tmp_path, json.dumps(policy), LONE_RETURN) == (1, 1)


def test_a_table_as_published(tmp_path: Path) -> None:
    """Values numbered from 1, rows in any order over many lines, none of our sections: proved by both."""
    path = ROOT / "examples" / "amr.tum"
    _, outcome = solved(path)
    assert isinstance(outcome, Realizable)
    document = json.loads(dumps(outcome.policy))
    published = {key: document[key] for key in ("PolicyFrameworkVersion", "Type", "Actions", "States", "Policy")}
    for values in published["States"].values():
        values.update({value: number + 1 for value, number in values.items()})
    Random(0).shuffle(published["Policy"])
    assert codes(tmp_path, json.dumps(published, indent=2), path.read_text(encoding="utf-8")) == (0, 0)
