"""Entries of files that name all there is: every action, every variable, every goal."""

from __future__ import annotations

import json
from pathlib import Path

from tests.checker.refusals import spec_text
from tests.checker.standalone import ask, checker
from tests.verify.policies import certified
from tumato_symbolic import parse
from tumato_symbolic.policy import dumps
from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import Spec

GOALS = """BEGIN GOALS
goal type: constraint
goal: P is b
goal: P is b OR executing ab
END GOALS"""
TEXT = spec_text("ab", "ab", GOALS)


def _policy(spec: Spec) -> str:
    """Its decisions execute all actions, and the certificate ranks all goals, executing all actions."""
    rows = {(0,): frozenset((0,)), (1,): frozenset[int]()}
    both = frozenset((0, 1))
    ranks = {Residual(both, frozenset((0,))): {(1,): 0, (0,): 1}, Residual(both, frozenset()): {(1,): 0}}
    return dumps(certified(spec, rows, ranks))


def test_all_may_be_named(tmp_path: Path) -> None:
    """Names have to be known; there may be as many as there are."""
    policy = _policy(parse(TEXT))
    answer = ask(tmp_path, policy, TEXT)
    assert "certificate: right" in answer.out, answer
    spec = checker.read_specification(TEXT.encode())
    document = json.loads(policy)
    goal, _ = document["Certificate"]["Goals"]
    assert checker.read_goal(goal, spec)[1] == {"ab"}
