"""What names stand for: hover, references, renaming."""

from pathlib import Path

import pytest

from tests.generate import random_text
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.hover import hover
from tumato_symbolic.editor.mentions import Symbol, index
from tumato_symbolic.editor.renaming import CannotRenameError, rename
from tumato_symbolic.spec import load
from tumato_symbolic.syntax.edits import edited

EXAMPLES = Path(__file__).parents[2] / "examples"
SPRAYER = Source("sprayer.tum", (EXAMPLES / "sprayer.tum").read_text(encoding="utf-8"))
KNOWN = index(SPRAYER)


def _at(piece: str, text: str = SPRAYER.text) -> tuple[int, int]:
    """The line and column where a piece of a text begins."""
    before = text[: text.index(piece)]
    return before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1


@pytest.mark.parametrize(
    ("piece", "said"),
    [
        (
            "S_Tank > 0",
            ["one of `0`, `1`, `2`", "written by action `spray_row1`", "action `fill`", "state S_Tank can be 0..2"],
        ),
        ("S_Wind is calm AND", ["no action writes it", "read by alias `may_spray`, a goal"]),
        ("calm AND", ["value `calm` of `S_Wind`", "asked for by alias `may_spray`"]),
        ("PUMP\nEND", ["resource `PUMP`", "needed by action `spray_row1`"]),
        (
            "fold AND",
            ["action `fold`", "writes `S_Boom`", "reads `S_Boom`", "needs `BOOM`", "stands in a reaction rule"],
        ),
        ("in_row AND", ["alias `in_row`", "used by alias `may_spray`"]),
        ("S_Row{R} is treated,", ["`S_Row1`", "`S_Row2`", "`S_Row3`", "written by action `spray_row2`"]),
    ],
)
def test_hover(piece: str, said: list[str]) -> None:
    """Declaration, values, what writes it, what reads it; among copies, each of them."""
    text = hover(KNOWN, *_at(piece))
    assert text is not None
    assert [each for each in said if each not in text] == []


def test_nothing_is_said_of_words_of_the_language() -> None:
    """Nor of white space."""
    assert hover(KNOWN, *_at("BEGIN ACTIONS")) is None
    assert hover(KNOWN, 9999, 1) is None


@pytest.mark.parametrize("seed", range(12))
def test_a_renamed_specification_means_the_same(seed: int) -> None:
    """After renaming a variable, a value, an action and a resource everywhere, only their names differ."""
    source = Source("text", random_text(seed))
    before = load(source).spec
    assert before is not None
    variable = before.variables[0].name
    wanted = [Symbol("value", before.variables[0].values[0], variable), Symbol("state variable", variable)]
    wanted += [Symbol("action", before.actions[0].name)] if before.actions else []
    for symbol in wanted:
        known = index(source)
        span = known.declarations(symbol)[0]
        source = Source(
            "text", edited(source, tuple(rename(known, span.line, span.column, "Renamed_" + symbol.kind[:3])))
        )
    after = load(source).spec
    assert after is not None
    assert [each.formula for each in after.state_rules] == [each.formula for each in before.state_rules]
    assert [each.formula for each in after.bodies] == [each.formula for each in before.bodies]
    assert [(each.nominal, each.duration) for each in after.actions] == [
        (each.nominal, each.duration) for each in before.actions
    ]
    assert after.variables[0].name == "Renamed_sta"
    assert after.variables[0].values[0] == "Renamed_val"


@pytest.mark.parametrize(
    ("piece", "name", "why"),
    [
        ("S_Row{R} can", "S_Line", "made of parameters"),
        ("row1, row2", "line1", "made of parameters"),
        ("S_Wind can", "S_Tank", "in use already"),
        ("S_Wind can", "AND", "not a name"),
        ("S_Wind can", "a b", "not a name"),
        ("S_Wind can", "true", "means something else"),
        ("BEGIN ACTIONS", "X", "no name here"),
    ],
)
def test_what_cannot_be_renamed(piece: str, name: str, why: str) -> None:
    """And why."""
    with pytest.raises(CannotRenameError, match=why):
        rename(KNOWN, *_at(piece), name)


COPIES = Source(
    "copies.tum",
    """\
BEGIN STATE VECTOR
for R in a, b, c, Q in 1..2 where R != c
  state S_{R}_{Q} can be x, y
  for P in a where P != R
    state T_{R}_{P} can be x{Q}, y
  end for
end for
for R in a, b
  state U_{R} can be x, y
end for
END STATE VECTOR
BEGIN STATE RULES
rule: all R in a, b: U_{R} is x OR some Q in 1..2: S_{R}_{Q} is y
rule: S_a_1 is x
END STATE RULES
""",
)


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ((2, 5), "parameter `R`, which stands in 4 places"),
        ((3, 12), "parameter `R`, which stands in 4 places"),
        ((3, 16), "parameter `Q`, which stands in 2 places"),
        ((4, 25), "parameter `R`, which stands in 4 places"),
        ((8, 5), "parameter `R`, which stands in 1 place"),
        ((13, 25), "parameter `R`, which stands in 2 places"),
    ],
)
def test_parameters_are_told_apart(place: tuple[int, int], said: str) -> None:
    """Each belongs to its copies, in braces, in conditions, in quantifiers; its header is shown."""
    text = hover(index(COPIES), *place)
    assert text is not None
    assert said in text


@pytest.mark.parametrize("place", [(2, 5), (3, 12), (4, 25)])
def test_a_parameter_is_renamed_in_its_copies_only(place: tuple[int, int]) -> None:
    """The names that are made stay."""
    renamed = edited(COPIES, tuple(rename(index(COPIES), *place, "Row")))
    assert renamed.count("Row") == 5
    assert renamed.split("\n")[1:5] == [
        "for Row in a, b, c, Q in 1..2 where Row != c",
        "  state S_{Row}_{Q} can be x, y",
        "  for P in a where P != Row",
        "    state T_{Row}_{P} can be x{Q}, y",
    ]


@pytest.mark.parametrize(("place", "name"), [((2, 5), "Q"), ((2, 5), "P"), ((4, 7), "R"), ((2, 5), "c")])
def test_a_parameter_keeps_apart_from_others(place: tuple[int, int], name: str) -> None:
    """Around it, in it, beside it, and from words that it is compared with."""
    with pytest.raises(CannotRenameError, match="something else"):
        rename(index(COPIES), *place, name)


def test_named_lists_are_found_in_headers() -> None:
    """Their declaration, and each use after `in`."""
    known = index(Source("fleet.tum", (EXAMPLES / "fleet.tum").read_text(encoding="utf-8")))
    uses = [each.use for each in known.of_symbol[Symbol("named list", "FLEET")]]
    assert uses.count("declared") == 1
    assert uses.count("read") == 10


def test_a_text_with_mistakes_still_has_names() -> None:
    """What could be read is known."""
    known = index(
        Source("text", "BEGIN STATE VECTOR\nstate S can be a, b\nEND STATE VECTOR\nBEGIN STATE RULES\nrule: S is")
    )
    assert known.values("S") == ["a", "b"]
