"""Limits: the stand-alone checker takes what is at one, as the package does, and refuses what is beyond it by one."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.checker.standalone import ask, checker
from tests.checker.test_language import GO, STATES, action, alias, config, goals, reaction, rule, values
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import load


def many(count: int, each: str, block: str) -> str:
    """A block with so many entries."""
    return f"BEGIN {block} {' '.join(each.format(number) for number in range(count))} END {block}"


def nested_goals(levels: int) -> str:
    """Goal lists in goal lists."""
    inner = "BEGIN GOALS goal type: priority " * levels + "goal: A is x " + "END GOALS " * levels
    return STATES + GO + inner


def aliases(levels: int) -> str:
    """Aliases of which each is the negation of the one before."""
    steps = " ".join(f"define k{number + 1} as NOT k{number}" for number in range(levels))
    return alias(f"define k0 as A is x {steps}")


def ifs(levels: int) -> str:
    """Aliases of which each is the condition of another rule."""
    steps = " ".join(f"define k{number + 1} as IF k{number} THEN B is x" for number in range(levels))
    return alias(f"define k0 as A is x {steps}")


def consequences(levels: int) -> str:
    """Aliases of which each is what follows in another rule."""
    steps = " ".join(f"define k{number + 1} as IF B is x THEN k{number}" for number in range(levels))
    return alias(f"define k0 as A is x {steps}")


def conditions(levels: int) -> str:
    """A goal with a condition, and operators in its body."""
    return goals(f"when A is x then goal: {'NOT ' * levels} A is y")


LIMITS: dict[str, tuple[Callable[[int], str], int]] = {
    "variables": (lambda count: many(count, "state V{} can be a, b", "STATE VECTOR"), 1000),
    "values": (lambda count: values(", ".join(f"v{number}" for number in range(count))), 10_000),
    "actions": (lambda count: STATES + many(count, "action a{}", "ACTIONS"), 10_000),
    "a duration": (lambda number: action(f"duration: {number}"), 1_000_000_000),
    "a bound": (lambda number: config(f"max_plan_length: {number}"), 1_000_000_000),
    "digits": (lambda count: action(f"duration: {'1':0>{count}}"), 18),
    "parentheses": (lambda count: rule("(" * count + "A is x" + ")" * count), 100),
    "parentheses after others": (
        lambda count: rule("((A is x) AND (B is x)) AND " + "(" * count + "A is x" + ")" * count),
        100,
    ),
    "operators": (lambda count: rule("NOT " * count + "A is x"), 99),
    "operators in a reaction rule": (lambda count: reaction("NOT " * count + "executing go"), 99),
    "aliases": (aliases, 99),
    "aliases and IF": (ifs, 49),
    "aliases and THEN": (consequences, 98),
    "goal lists": (nested_goals, 99),
    "conditions": (conditions, 97),
}


def _readable(text: str) -> bool:
    try:
        checker.read_specification(text.encode())
    except checker.Unreadable:
        return False
    return True


@pytest.mark.parametrize("name", LIMITS)
def test_what_is_at_a_limit_is_read(name: str) -> None:
    """By both, and what is beyond it by none."""
    make, limit = LIMITS[name]
    for size, fine in ((limit, True), (limit + 1, False)):
        text = make(size)
        assert _readable(text) == fine, f"the checker: {size}"
        assert (load(Source("spec.tum", text)).spec is not None) == fine, f"the package: {size}"


def test_bytes_are_counted() -> None:
    """As many as a specification may have."""
    assert _readable(STATES + "/" * (2_000_000 - len(STATES)))
    assert not _readable(STATES + "/" * (2_000_001 - len(STATES)))


def test_terms_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each operator is one and each operand; IF is NOT and OR; an alias counts as often as it is used."""
    predicate = "IF k AND NOT k THEN A is y OR true"
    parts = [("A is x AND B is x", 3), (predicate, 1 + 1 + (1 + 3 + 1 + 3) + (1 + 1 + 1))]
    text = alias(f"define k as {parts[0][0]}", f"BEGIN STATE RULES rule: {predicate} END STATE RULES")
    for most, fine in ((parts[1][1], True), (parts[1][1] - 1, False)):
        monkeypatch.setattr(checker, "MOST_TERMS", most)
        assert _readable(text) == fine
    monkeypatch.setattr(checker, "MOST_TERMS", 1000)
    for most, fine in ((parts[1][1] + 1, True), (parts[1][1], False)):
        monkeypatch.setattr(checker, "MOST_TERMS_IN_ALL", most)
        assert _readable(text) == fine, "the effect of `go` is a term as well"


def test_outcomes_and_assignments_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many outcomes of alternative effects as allowed, and as many assignments as are looked at."""
    text = action("alternative effects: NOT A is x OR NOT B is x")
    for most, fine in ((5, True), (4, False)):
        monkeypatch.setattr(checker, "MOST_OUTCOMES", most)
        assert _readable(text) == fine
    monkeypatch.setattr(checker, "MOST_OUTCOMES", 5)
    monkeypatch.setattr(checker, "LARGEST", 6)
    assert _readable(text)
    monkeypatch.setattr(checker, "LARGEST", 5)
    with pytest.raises(checker.TooLarge):
        checker.read_specification(text.encode())


def test_states_and_sets_are_counted(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Six states are looked at where six may be; where five may, there is no verdict."""
    text = STATES + GO
    policy = json.dumps(
        {
            "Type": "policy",
            "Actions": ["go"],
            "States": {"A": {"x": 0, "y": 1, "z": 2}, "B": {"x": 0, "y": 1}},
            "Policy": [{"A": one, "B": other, "Actions": []} for one in "xyz" for other in "xy"],
        }
    )
    for most, code in ((6, 0), (5, 3)):
        monkeypatch.setattr(checker, "LARGEST", most)
        assert ask(tmp_path, policy, text).code == code


def test_levels_of_a_file(tmp_path: Path) -> None:
    """Objects and lists in each other, up to a hundred."""
    text = STATES + GO
    for levels, code in ((99, 1), (100, 2)):
        remark: object = []
        for _ in range(levels - 1):
            remark = [remark]
        policy = {
            "Type": "policy",
            "Actions": ["go"],
            "States": {"A": {"x": 0, "y": 1, "z": 2}, "B": {"x": 0, "y": 1}},
            "Policy": [],
            "Remark": remark,
        }
        assert ask(tmp_path, json.dumps(policy), text).code == code, levels


def test_values_are_numbered_from_0_or_from_1_in_the_whole_file(tmp_path: Path) -> None:
    """Where one variable has a value 0, all others begin there too."""
    text = STATES + GO
    for first, second, told in (
        ((0, 1, 2), (0, 1), ""),
        ((1, 2, 3), (1, 2), ""),
        ((0, 1, 2), (1, 2), "the values of `B` are not numbered 0, 1"),
        ((1, 2, 3), (0, 1), "the values of `A` are not numbered 0, 1"),
        ((2, 3, 4), (2, 3), "the values of `A` are not numbered 1, 2"),
    ):
        states = {"A": dict(zip("xyz", first, strict=True)), "B": dict(zip("xy", second, strict=True))}
        answer = ask(tmp_path, json.dumps({"Type": "policy", "Actions": ["go"], "States": states, "Policy": []}), text)
        assert (answer.code == 2) == bool(told)
        assert told in answer.err
