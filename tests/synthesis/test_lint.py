"""Warnings that need the whole state space: by diagrams, and state by state for `check`."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.clauses.generate import random_pair
from tests.cli.conftest import Cli, cli
from tests.generate import ALL_PROFILES, random_text
from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.game.problem import build_problem
from tumato_symbolic.semantics import lint as explicit
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.symbolic import available_backend
from tumato_symbolic.synthesis.lint import lint

__all__ = ["cli"]


def spec_of(text: str) -> Spec:
    """The specification of a text without errors."""
    spec = load(Source("spec.tum", text)).spec
    assert spec is not None
    return spec


def agree(spec: Spec) -> int:
    """Hold that both ways warn of the same, in the same words and places; how many warnings there are."""
    found = 0
    for ordering in ("any", "first"):
        case = replace(spec, effect_ordering=ordering)
        warnings = explicit.lint(case)
        assert warnings == lint(build_problem(case, case.ordering, available_backend()))
        found += len(warnings)
    return found


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_both_ways_warn_of_the_same(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Generated specifications; most of them have something that is surely not meant."""
    monkeypatch.setattr(explicit, "MAX_WORK", 10**9)
    assert sum(agree(spec_of(random_text(seed, ALL_PROFILES[profile]))) for seed in range(10)) > 0


EXCLUSIVE = """\
BEGIN STATE VECTOR
state N can be 0..3
END STATE VECTOR
BEGIN ACTIONS
action up
nominal effects: N is N + 1
action down
nominal effects: N is N - 2
END ACTIONS
BEGIN REACTION RULES
rule: NOT (executing up AND executing down)
END REACTION RULES
BEGIN GOALS goal type: priority goal: N is 3 END GOALS
"""
"""Two cases agree that are never meant in one state, and so no state has a set that the rule could forbid."""


def test_both_ways_warn_of_the_same_where_effects_depend_on_the_state(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sets are asked about by the cases that are meant."""
    monkeypatch.setattr(explicit, "MAX_WORK", 10**9)
    texts = [EXCLUSIVE, *(random_pair(seed).text for seed in range(30))]
    specs = [loaded.spec for text in texts if (loaded := load(Source("spec.tum", text))).spec is not None]
    specs = [replace(spec, restoration="one_step") for spec in specs]
    assert sum(agree(spec) for spec in specs if len(spec.tiers) < 2) > 0


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.tum")), ids=lambda path: path.stem)
def test_both_ways_warn_of_the_same_in_examples(path: Path) -> None:
    """The examples as well."""
    agree(spec_of(path.read_text()))


SUSPICIOUS = """\
BEGIN STATE VECTOR
state x can be a, b
state y can be a, b
END STATE VECTOR
BEGIN RESOURCES
resource HAND
END RESOURCES
BEGIN ACTIONS
action never
preconditions: x is b
nominal effects: y is b
action one
controlled resources: HAND
preconditions: none
nominal effects: y is b
action two
controlled resources: HAND
preconditions: none
nominal effects: y is b
END ACTIONS
BEGIN REACTION RULES
rule: NOT (executing one AND executing two)
rule: NOT (executing one AND executing never)
END REACTION RULES
BEGIN STATE RULES
rule: x is a
END STATE RULES
BEGIN ASSUMPTIONS
assume: x is a
END ASSUMPTIONS
BEGIN GOALS
goal type: priority
goal: x is a
when y is a then goal: y is b
END GOALS
"""
"""An action that no valid state allows, rules that nothing breaks, a goal behind one that is always entered."""


def test_check_warns_of_them(cli: Cli, tmp_path: Path) -> None:
    """`check` says what `synth` says; a rule that only repeats a shared resource is left alone."""
    (tmp_path / "suspicious.tum").write_text(SUSPICIOUS)
    check, synth = cli("check", "suspicious.tum"), cli("synth", "suspicious.tum")
    assert (check.code, synth.code) == (0, 0)
    lines = SUSPICIOUS.splitlines()
    for line, code in (
        ("action never", "TUM353"),
        ("rule: NOT (executing one AND executing never)", "TUM352"),
        ("rule: x is a", "TUM352"),
        ("goal: x is a", "TUM355"),
        ("when y is a then goal: y is b", "TUM351"),
    ):
        for text in (check.out, synth.err):
            assert re.search(rf"{code}.*\n  --> suspicious.tum:{lines.index(line) + 1}:", text)
    assert "suspicious.tum: 5 warnings, 1 remark" in check.out


def test_check_finds_that_no_state_is_valid(cli: Cli, tmp_path: Path) -> None:
    """An error of the assumptions together: exit 2 and TUM312, as in `synth`."""
    text = SUSPICIOUS.replace("assume: x is a", "assume: x is a\nassume: x is b")
    (tmp_path / "empty.tum").write_text(text)
    for command in ("check", "synth"):
        ran = cli(command, "empty.tum")
        assert ran.code == 2
        assert "TUM312" in ran.out + ran.err


@pytest.mark.parametrize(("limit", "value"), [("MAX_STATES", 3), ("MAX_WORK", 4)])
def test_what_would_take_long_is_left_to_synth(monkeypatch: pytest.MonkeyPatch, limit: str, value: int) -> None:
    """Beyond a number of states or of atoms nothing is said."""
    monkeypatch.setattr(explicit, limit, value)
    assert explicit.lint(spec_of(SUSPICIOUS)) == ()


def test_half_the_work_is_half_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever may be done: what is said then is among what would be said in the end."""
    whole = explicit.lint(spec_of(SUSPICIOUS))
    for most in range(0, 400, 7):
        monkeypatch.setattr(explicit, "MAX_WORK", most)
        assert set(explicit.lint(spec_of(SUSPICIOUS))) <= set(whole)
