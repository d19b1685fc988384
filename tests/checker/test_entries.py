"""Files at their limits: entries that name all there is, as many bytes and levels as are read, and no more."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.checker.standalone import ask, checker
from tests.checker.unrealizable import spec_text
from tests.verify.policies import certified
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy import dumps, loads
from tumato_symbolic.semantics import ActionSet, Residual, State
from tumato_symbolic.spec import Spec

GOALS = """BEGIN GOALS
goal type: constraint
goal: P is b
goal: P is b OR executing ab
END GOALS"""
TEXT = spec_text("ab", "ab", GOALS)


def _policy(spec: Spec) -> str:
    """Its decisions execute all actions, and the certificate ranks all goals, executing all actions."""
    rows: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): frozenset[int]()}
    both = frozenset((0, 1))
    ranks: dict[Residual, dict[State, int]] = {
        Residual(both, frozenset((0,))): {(1,): 0, (0,): 1},
        Residual(both, frozenset()): {(1,): 0},
    }
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


def test_files_are_no_larger_than_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Byte by byte."""
    policy = _policy(parse(TEXT))
    for room, code in ((0, 0), (1, 0), (-1, 2)):
        monkeypatch.setattr(checker, "MOST_FILE_BYTES", len(policy.encode()) + room)
        answer = ask(tmp_path, policy, TEXT)
        assert answer.code == code
        assert ("the file is larger than" in answer.err) == (code == 2)


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity"])
def test_what_python_takes_for_numbers_is_no_json(word: str, tmp_path: Path) -> None:
    """Even where nobody looks; the package refuses it too."""
    policy = _policy(parse(TEXT)).replace("{", f'{{"Remarks": {word}, ', 1)
    assert ask(tmp_path, policy, TEXT).code == 2
    with pytest.raises(UserError):
        loads(policy)


@pytest.mark.parametrize(("deeper", "code"), [(0, 0), (1, 2)])
def test_how_deep_files_are(deeper: int, code: int, tmp_path: Path) -> None:
    """Lists in lists, as far as the limit; the package draws the same line."""
    levels = checker.MOST_LEVELS - 1 + deeper
    policy = _policy(parse(TEXT)).replace("{", f'{{"Remarks": {"[" * levels}{"]" * levels}, ', 1)
    assert ask(tmp_path, policy, TEXT).code == code
    if code:
        with pytest.raises(UserError):
            loads(policy)
    else:
        loads(policy)
