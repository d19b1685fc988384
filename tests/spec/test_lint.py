"""Warnings: legal, surely unmeant."""

from pathlib import Path

import pytest

from tests.spec.marked import FULL, VECTOR, codes, loaded, the, unmark
from tumato_symbolic.spec import load
from tumato_symbolic.syntax import read_source

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.tum"))

WARNINGS = [
    ("TUM321", f"{FULL}".replace("resource R", "resource R resource «Q»")),
    ("TUM322", f"{FULL}BEGIN ALIASES define «p» as S is a END ALIASES"),
    ("TUM323", f"{FULL}BEGIN STATE RULES rule: «S is a OR S is b» END STATE RULES"),
    ("TUM323", f"{FULL}BEGIN ASSUMPTIONS assume: «IF S is a THEN NOT S is b» END ASSUMPTIONS"),
    ("TUM323", FULL.replace("goal: S is b", "when «S is a IFONLYIF NOT S is b» then goal: S is b")),
    ("TUM323", FULL.replace("goal: S is b", "goal: «executing go OR NOT executing go»")),
    ("TUM324", FULL.replace("preconditions: S is a", "preconditions: «S is a AND S is b»")),
    ("TUM324", FULL.replace("preconditions: S is a", "preconditions: «S is a, T is x, S is b»")),
    ("TUM324", FULL.replace("goal: S is b", "goal: «S is a AND NOT S is a»")),
    ("TUM324", f"{FULL}BEGIN REACTION RULES rule: «false» END REACTION RULES"),
    ("TUM325", f"{VECTOR} «BEGIN ACTIONS» END ACTIONS BEGIN GOALS goal type: priority goal: true END GOALS"),
    ("TUM326", FULL.replace("BEGIN GOALS goal type: priority goal: S is b END GOALS\n", "").rstrip() + "«»"),
    ("TUM327", FULL.replace("action go", "action «idle» preconditions: none action go")),
    ("TUM328", FULL.replace("resources: R", "resources: R, «R»")),
]


@pytest.mark.parametrize(("code", "marked"), WARNINGS, ids=lambda each: str(each)[:40])
def test_a_warning_is_given_where_it_belongs(code: str, marked: str) -> None:
    """The code and the span of each warning; nothing else is said, and there is a specification all the same."""
    case = unmark(marked)
    assert codes(case.text) == [code]
    assert the(code, case.text).span == case.span
    assert loaded(case.text).spec is not None


def test_a_plain_true_is_meant() -> None:
    """`true` alone is no reason to warn, wherever it stands."""
    text = FULL.replace("goal: S is b", "when true then goal: true").replace("S is a nom", "true nom")
    assert codes(f"{text}BEGIN STATE RULES rule: true END STATE RULES") == []


def test_what_is_used_by_an_unused_alias_only_is_unused() -> None:
    """An alias counts as used when a rule, a field or a goal needs it."""
    text = f"{FULL}BEGIN ALIASES define p as q define q as S is a END ALIASES"
    assert codes(text) == ["TUM322", "TUM322"]
    assert codes(f"{text} BEGIN STATE RULES rule: p END STATE RULES") == []


def test_large_predicates_are_left_undecided() -> None:
    """A predicate with too many assignments is not searched."""
    variables = " ".join(f"state S{number} can be a, b" for number in range(40))
    parity = "S0 is a"
    for number in range(1, 40):
        parity = f"({parity}) IFONLYIF S{number} is a"
    text = f"BEGIN STATE VECTOR {variables} END STATE VECTOR BEGIN STATE RULES rule: {parity} END STATE RULES"
    assert "TUM323" not in codes(text)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_the_examples_are_clean(path: Path) -> None:
    """No example has an error or a warning; what is worth knowing is remarked."""
    assert [each for each in load(read_source(str(path))).diagnostics if each.severity != "remark"] == []
