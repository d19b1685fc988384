"""What the stand-alone checker tells of a policy that fails, word for word: the witness of each property."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.checker.standalone import CHECKER, ask
from tests.checker.unrealizable import spec_text
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps, policy_from_rows

GOAL = "BEGIN GOALS goal type: priority goal: P is {} END GOALS"


def told(folder: Path, text: str, decisions: dict[str, str], *options: str) -> dict[str, str]:
    """What is told of each property that fails; in these states, a letter for each value, these actions run."""
    spec = parse(text)
    names = [action.name for action in spec.actions]
    rows = {
        tuple(each.values.index(value) for each, value in zip(spec.variables, state, strict=True)): frozenset(
            map(names.index, chosen.split())
        )
        for state, chosen in decisions.items()
    }
    answer = ask(folder, dumps(policy_from_rows(spec, rows)), text, *options)
    assert (answer.code, answer.err) == (1, "")
    lines = [line.split(maxsplit=1) for line in answer.out.splitlines() if " FAILS in " in line]
    return {name: why.partition(": ")[2] for name, why in lines}


RUNS = {
    "round from the start": (
        "a",
        None,
        {"b": "bc", "c": "cb", "a": ""},
        "b",
        "(P c), (P b) and round again from (P c)",
    ),
    "a place that stays": ("a", None, {"b": "bc", "c": "cc", "a": ""}, "b", "(P c) and round again from (P c)"),
    "into a round": ("a", None, {"b": "bc", "c": "cd", "d": "dc"}, "b", "(P c), (P d) and round again from (P c)"),
    "no decision": (
        "a",
        None,
        {"b": "bc", "c": "cd"},
        "b",
        "(P c), (P d) where nothing is decided that has one nominal successor",
    ),
    "a step too far": ("d", 1, {"b": "bc", "c": "cd", "d": ""}, "b", "(P c) and reaches it after 2 steps, more than 1"),
    "back too late": ("b", 1, {"b": "bc", "c": "cb"}, "b", "(P c) and reaches it after 2 steps, more than 1"),
}


@pytest.mark.parametrize("name", RUNS)
def test_a_run_that_misses_its_goal(name: str, tmp_path: Path) -> None:
    """The states that it passes, and whether it goes round, and from where, or ends, or comes too late."""
    goal, bound, decisions, start, run = RUNS[name]
    text = spec_text("abcd", "bc cb cd cc dc", GOAL.format(goal), bound)
    why = told(tmp_path, text, decisions)["goals"]
    step = f"in (P {start}) the decision is {{{decisions[start]}}} (duration 0)"
    assert why == f"{step}: its goal is P is {goal}; the run is (P {start}), {run}"


TWO = """BEGIN STATE VECTOR state P can be a, b state Q can be a, b END STATE VECTOR
BEGIN RESOURCES resource ARM END RESOURCES
BEGIN ACTIONS
action one controlled resources: ARM preconditions: P is a nominal effects: P is b
action two preconditions: none nominal effects: Q is b
action too controlled resources: ARM preconditions: none nominal effects: P is b
action back preconditions: none nominal effects: P is a, Q is a
END ACTIONS
BEGIN REACTION RULES
rule: IF executing too THEN NOT executing two
END REACTION RULES
BEGIN STATE RULES
rule: IF P is b THEN Q is a
END STATE RULES
"""
OBJECTIONS = {
    ("aa", "one two"): (
        "an outcome breaks the state rule at line 13: `rule: IF P is b THEN Q is a`; "
        "the effects lead to (P a, Q b), then (P b, Q b)"
    ),
    ("ab", "one"): (
        "an outcome breaks the state rule at line 13: `rule: IF P is b THEN Q is a`; the effects lead to (P b, Q b)"
    ),
    ("bb", ""): "an outcome breaks the state rule at line 13: `rule: IF P is b THEN Q is a`",
    ("ba", "one"): "a precondition of one does not hold: line 4: `action one controlled resources: ARM "
    "preconditions: P is a nominal effects: P is b`",
    ("aa", "one too"): "one and too share ARM",
    ("aa", "one back"): "the nominal effects disagree",
    ("ba", "too two"): "a reaction rule is broken: line 10: `rule: IF executing too THEN NOT executing two`",
}


@pytest.mark.parametrize(("state", "chosen"), OBJECTIONS)
def test_a_decision_that_is_not_allowed(state: str, chosen: str, tmp_path: Path) -> None:
    """The condition that fails, and for an outcome the states on the way to it."""
    names = ", ".join(sorted(chosen.split()))
    where = f"in (P {state[0]}, Q {state[1]}) the decision is {{{names}}} (duration 0): "
    assert told(tmp_path, TWO, {state: chosen})["safe"] == where + OBJECTIONS[state, chosen]


def test_a_terminal_without_the_letters_of_a_rule(tmp_path: Path) -> None:
    """Where it cannot show a letter, it shows its number; the exit code is that of the verdict."""
    text = TWO.replace("rule: IF P is b THEN Q is a", "rule: IF P is b THEN Q is a // só")
    spec = parse(text)
    (tmp_path / "policy.json").write_text(dumps(policy_from_rows(spec, {(1, 1): frozenset()})), encoding="utf-8")
    (tmp_path / "spec.tum").write_text(text, encoding="utf-8")
    command = [sys.executable, str(CHECKER), str(tmp_path / "policy.json"), str(tmp_path / "spec.tum")]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, capture_output=True, check=False, env=environment)
    assert (done.returncode, done.stderr) == (1, b"")
    assert b"Q is a // s\\xf3`" in done.stdout
