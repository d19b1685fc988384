"""Policies from starts for the tools that check them, and specifications that mix features."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.export.c_check import Counted, counts
from tests.export.c_compiler import needs_cc
from tests.export.compiler import Case
from tests.export.judges import JUDGES, disagreements
from tests.export.mixed import mixed
from tests.export.policies import exported
from tumato_symbolic import parse
from tumato_symbolic.export.targets import TARGETS, load
from tumato_symbolic.semantics import ActionSet, State, judge

TYRE = """
BEGIN STATE VECTOR state Place can be a, b, c state Tyre can be good, flat END STATE VECTOR
BEGIN RESOURCES resource CAR END RESOURCES
BEGIN ACTIONS
action short controlled resources: CAR preconditions: Place is a, Tyre is good
  nominal effects: Place is c alternative effects: Place is a, Tyre is flat
action long controlled resources: CAR preconditions: Place is a, Tyre is good
  nominal effects: Place is b alternative effects: Place is b, Tyre is flat
action on controlled resources: CAR preconditions: Place is b, Tyre is good nominal effects: Place is c
action mend controlled resources: CAR preconditions: Place is b, Tyre is flat nominal effects: Tyre is good
END ACTIONS
BEGIN ASSUMPTIONS assume: NOT (Place is c AND Tyre is flat) END ASSUMPTIONS
BEGIN GOALS goal type: priority goal: Place is c END GOALS
BEGIN START start: Place is a AND Tyre is good END START
"""
"""A tyre that goes flat at `a` stays flat, so that the short road leads where nothing can be decided."""

SHORT, LONG, ON, MEND = (frozenset((number,)) for number in range(4))
RIGHT: Mapping[State, ActionSet] = {(0, 0): LONG, (1, 0): ON, (1, 1): MEND, (2, 0): frozenset()}
WRONG: Mapping[str, Mapping[State, ActionSet]] = {
    "a start is left out": {state: chosen for state, chosen in RIGHT.items() if state != (0, 0)},
    "an outcome is left out": {state: chosen for state, chosen in RIGHT.items() if state != (1, 1)},
    "a step leads out": {**RIGHT, (0, 0): SHORT},
    "a state that is not valid is decided": {**RIGHT, (2, 1): MEND},
    "a state that fails is decided as well": {**RIGHT, (0, 1): frozenset()},
    "a precondition does not hold": {**RIGHT, (1, 0): MEND},
    "a goal is missed": {**RIGHT, (1, 0): frozenset()},
}

TOOLS = [pytest.param(name, marks=tool.needs) for name, tool in JUDGES.items()]


@pytest.mark.parametrize("tool", TOOLS)
def test_a_policy_from_a_start(tool: str, tmp_path: Path) -> None:
    """It is accepted though it leaves a valid state undecided, and each of these is refused."""
    wrong = [rows for fault, rows in WRONG.items() if fault in _FEW.get(tool, WRONG)]
    cases = [Case(parse(TYRE), rows, "any") for rows in (RIGHT, *wrong)]
    assert not disagreements(JUDGES[tool], cases, tmp_path)
    assert [JUDGES[tool].right(judge(case.spec, case.rows, "any")) for case in cases] == [True, *(False for _ in wrong)]


_FEW: Mapping[str, tuple[str, ...]] = {
    "spin": ("a start is left out", "a step leads out"),
    "esbmc": ("a start is left out", "a step leads out"),
}
"""What tools are tried on that take a second for each; and in C, what is proved is about single steps."""


@needs_cc
def test_faults_are_counted_apart(tmp_path: Path) -> None:
    """The check in C tells a start that is undecided from a step that leads out, and from a goal that is missed."""
    cases = [Case(parse(TYRE), rows, "any") for rows in WRONG.values()]
    assert counts([exported(case) for case in cases], tmp_path) == [
        Counted(1, (1, 0, 0, 0)),
        Counted(1, (0, 1, 0, 0)),
        Counted(1, (0, 1, 0, 0)),
        Counted(1, (0, 0, 0, 0), invalid=1),
        Counted(1, (0, 0, 1, 0)),
        Counted(1, (0, 1, 2, 0)),
        Counted(1, (0, 0, 3, 0)),
    ]


@pytest.mark.parametrize("tool", TOOLS)
def test_mixed_features(tool: str, tmp_path: Path) -> None:
    """Starts, clauses, severities, several steps and lasting preconditions together, right and wrong policies."""
    cases = [case for seed in (48, 25, 27) for case in mixed(seed)][: 2 if tool in _FEW else 15]
    assert not disagreements(JUDGES[tool], cases, tmp_path)


def test_every_file_says_where_it_begins() -> None:
    """And that there are states in which nothing is decided; without starts, nothing of it."""
    plain = parse(TYRE.partition("BEGIN START")[0])
    for target in TARGETS:
        if target != "coq":
            from_start, from_all = (load(target)(exported(Case(spec, RIGHT, "any"))) for spec in (parse(TYRE), plain))
            assert "the starts of the specification" in " ".join(from_start[0].split() + from_start[-1].split()), target
            assert "the starts of the specification" not in " ".join(from_all[0].split()), target
