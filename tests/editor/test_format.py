"""One layout for all texts, which keeps what they say, their comments, and what these allow."""

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.editor.formatted import complaint, complaint_of
from tests.editor.texts import commented
from tests.syntax.printing import print_specification
from tests.syntax.trees import specifications
from tumato_symbolic.diagnostics import Code, Source, UserError
from tumato_symbolic.editor.format import format_text
from tumato_symbolic.syntax import ast

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(ROOT.glob("examples/*.tum"))
DOCUMENTS = sorted((ROOT / "docs").glob("*.md"))

_MESSY = """\
// About all of it.
BEGIN STATE VECTOR state A can be x,y , z   // the first
state B can be 0 .. 3 END STATE VECTOR
BEGIN ACTIONS


action go   preconditions:A is x,B>=1
    // of `go`
  nominal effects : B is B -1 when A is x:A is y
  // the last of `go`
// of `stop`
action stop
END ACTIONS
BEGIN STATE RULES
rule: IF A is x AND B is 1 AND NOT (A is y AND B is 2) AND A is not z AND B in {0,1,2}
THEN B is 2 OR B is 3 OR (A is y AND B is 0)
for R in 1..3 where R+1<4
rule: B is not {R} /* one of three */ OR A is x
end for
END STATE RULES
BEGIN GOALS goal type: priority
when A is x then
goal: A is y
BEGIN GOALS goal type: constraint goal: true END GOALS END GOALS
"""

_NEAT = """\
// About all of it.
BEGIN STATE VECTOR
state A can be x, y, z // the first
state B can be 0..3
END STATE VECTOR

BEGIN ACTIONS
action go
  preconditions: A is x, B >= 1
  // of `go`
  nominal effects: B is B - 1
    when A is x: A is y
  // the last of `go`
// of `stop`
action stop
END ACTIONS

BEGIN STATE RULES
rule: IF A is x AND B is 1 AND NOT (A is y AND B is 2) AND A is not z AND B in {0, 1, 2}
    THEN B is 2 OR B is 3 OR (A is y AND B is 0)
for R in 1..3 where R+1 < 4
  rule: B is not {R} /* one of three */ OR A is x
end for
END STATE RULES

BEGIN GOALS
goal type: priority
when A is x then goal: A is y
  BEGIN GOALS
  goal type: constraint
  goal: true
  END GOALS
END GOALS
"""


def _formatted(text: str) -> str:
    return format_text(Source("text", text))


def test_one_text_as_a_whole() -> None:
    """Spaces, indentation, blank lines, a long line, and every kind of comment."""
    assert _formatted(_MESSY) == _NEAT


@pytest.mark.parametrize("seed", range(24))
def test_generated_texts(seed: int) -> None:
    """The same tree, the same comments and allowances, and a second layout changes nothing."""
    assert complaint_of(seed) is None


@settings(max_examples=12)
@given(specifications, st.integers(0, 10**6))
def test_whatever_words_are_names(tree: ast.Specification, seed: int) -> None:
    """Keywords as names, negative numbers, odd goal lists."""
    assert complaint(commented(print_specification(tree), seed)) is None


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples(path: Path) -> None:
    """Every one of them."""
    assert complaint(path.read_text(encoding="utf-8")) is None


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.stem)
def test_specifications_in_documents(path: Path) -> None:
    """Every fenced specification."""
    for body in re.findall(r"^```tumato[^\n]*\n(.*?)^```$", path.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
        assert complaint(body) is None


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("rule: S is a // allow TUM323\n  AND S is b", "rule: S is a // allow TUM323\n    AND S is b"),
        ("rule: S is a\n// allow TUM323\nAND S is b", "rule: S is a\n    // allow TUM323\n    AND S is b"),
        ("rule:S is a rule: S is b // allow TUM323", "rule: S is a rule: S is b // allow TUM323"),
        ("// allow TUM323\nrule: S is a rule: S is b", "// allow TUM323\nrule: S is a rule: S is b"),
        ("// allow TUM323\n\nrule: S is a", "// allow TUM323\n\nrule: S is a"),
    ],
)
def test_what_is_allowed_stays_on_its_line(text: str, kept: str) -> None:
    """Lines about which a comment speaks are neither broken nor joined."""
    assert _formatted(f"BEGIN STATE RULES\n{text}\nEND STATE RULES") == f"BEGIN STATE RULES\n{kept}\nEND STATE RULES\n"


def test_mistakes_are_told() -> None:
    """A text with a mistake in its syntax has no layout."""
    with pytest.raises(UserError) as caught:
        _formatted("BEGIN STATE VECTOR\nstate S can a\nEND STATE VECTOR\n/* open")
    assert {each.code for each in caught.value.diagnostics} == {Code.TUM105, Code.TUM106}


def test_a_value_list_is_filled() -> None:
    """As many values a line as fit."""
    values = ", ".join(f"value_{number}" for number in range(30))
    lines = _formatted(f"BEGIN STATE VECTOR state S can be {values} END STATE VECTOR").split("\n")[1:-2]
    assert [len(line) > 100 for line in lines] == [True, True, False]
    assert all(line.startswith("    value") for line in lines[1:])
