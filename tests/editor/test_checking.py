"""Fixes that mend, and what synthesis says of a text."""

import pytest

from tests.cli.inputs import NO_PLAN, TYPO, WARNED
from tests.explain.variants import VARIANTS
from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.answer import answer, dumps, loads
from tumato_symbolic.editor.checking import findings, fixes
from tumato_symbolic.editor.outline import outline
from tumato_symbolic.limits import Context
from tumato_symbolic.spec import load
from tumato_symbolic.syntax.edits import edited
from tumato_symbolic.synthesis import Realizable, synthesize


def test_fixes_are_what_was_meant() -> None:
    """A misspelled variable and a misspelled value, one after the other, and nothing is wrong any more."""
    source = Source("text", TYPO)
    found = list(fixes(source, 1, 99))
    assert [each.title for each in found] == ["Change to `S_Battery`", "Change to `ok`"]
    mended = Source("text", edited(source, tuple(edit for each in found for edit in each.edits)))
    assert not [each for each in findings(mended) if each.severity == "error"]
    assert list(fixes(source, 1, 6)) == []


@pytest.mark.parametrize(
    ("wrong", "title"),
    [
        ("BEGIN STATE VECTR", "Change to `BEGIN STATE VECTOR`"),
        ("rule: A is x and A is y", "Change to `AND`"),
        ("rule: NOT excuting go", None),
    ],
)
def test_only_what_mends_is_offered(wrong: str, title: str | None) -> None:
    """A proposal is tried before it is offered."""
    text = "BEGIN STATE VECTOR\nstate A can be x, y\nEND STATE VECTOR\n"
    text += "BEGIN REACTION RULES\nrule: true\nEND REACTION RULES"
    text = text.replace("BEGIN STATE VECTOR" if wrong.startswith("BEGIN") else "rule: true", wrong)
    offered = [each.title for each in fixes(Source("text", text), 1, 99)]
    assert title in offered if title is not None else offered == []


def test_remarks_and_what_shows_in_the_states_come_when_thorough() -> None:
    """As `check` tells them."""
    source = Source("text", WARNED + "BEGIN REACTION RULES\nrule: NOT executing charge\nEND REACTION RULES\n")
    codes = [{each.code.name for each in findings(source, thorough)} for thorough in (False, True)]
    assert "TUM353" not in codes[0]
    assert codes[0] | {"TUM353"} <= codes[1]


def test_a_realizable_text() -> None:
    """Counts stand after the lines with which blocks begin."""
    source = Source("amr.tum", (ROOT / "examples" / "amr.tum").read_text(encoding="utf-8"))
    found = answer(source, Context())
    assert loads(dumps(found)) == found
    lines = source.text.split("\n")
    told = {lines[hint.line - 1][: hint.column - 1]: hint.text for hint in found.hints}
    assert told == {
        "BEGIN STATE VECTOR": "32 states",
        "BEGIN ACTIONS": "8 actions",
        "BEGIN STATE RULES": "24 safe, 8 unsafe",
        "BEGIN GOALS": "realizable, in 4 steps at most",
    }
    assert (found.verdict, found.failures, found.repairs) == ("realizable", (), ())


@pytest.mark.parametrize("name", ["bound_too_short", "missing_action", "reaction_rule_too_strong"])
def test_repairs_are_edits_that_give_a_policy(name: str) -> None:
    """Each repaired text is realizable, has all its state rules, and leaves the judgement to the user."""
    text = next(each.text for each in VARIANTS if each.name == name)
    source = Source("amr.tum", text)
    found = answer(source, Context())
    assert loads(dumps(found)) == found
    assert found.verdict == "unrealizable"
    assert found.failures[0].code in ("TUM401", "TUM402")
    assert found.repairs
    rules = [each.formula for each in load(source).spec.state_rules]  # type: ignore[union-attr]
    for repair in found.repairs:
        spec = load(Source("amr.tum", edited(source, repair.edits))).spec
        assert spec is not None
        assert [each.formula for each in spec.state_rules] == rules
        assert isinstance(synthesize(spec), Realizable)
        assert repair.title.endswith("whether it is safe is for you to judge)")


def test_what_has_no_answer() -> None:
    """Mistakes, and a specification without valid states."""
    assert answer(Source("text", TYPO), Context()).verdict == "mistakes"
    none = NO_PLAN + "BEGIN ASSUMPTIONS\nassume: false\nEND ASSUMPTIONS\n"
    assert answer(Source("text", none), Context()).verdict == "mistakes"


def test_the_outline() -> None:
    """Blocks, what is declared in them, copies, and goals in lists."""
    source = Source("sprayer.tum", (ROOT / "examples" / "sprayer.tum").read_text(encoding="utf-8"))
    blocks = {each.name: each for each in outline(source)}
    assert [each.name for each in blocks["ACTIONS"].entries[:3]] == [
        "drive_to_yard",
        "drive_to_headland",
        "for R in 1..3",
    ]
    assert [each.name for each in blocks["ACTIONS"].entries[2].entries] == ["enter_row{R}", "spray_row{R}"]
    assert [each.kind for each in blocks["GOALS"].entries] == ["goal"] * 4
    assert outline(Source("text", "")) == ()
