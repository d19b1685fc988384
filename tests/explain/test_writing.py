"""Tests of writing an assumption into a specification."""

import re

import pytest

from tests.cli.golden import CASES, golden_path
from tests.repo.documents import ROOT
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.writing import with_assumption
from tumato_symbolic.semantics import all_states, is_valid

TEXT = "BEGIN STATE VECTOR state S can be a, b, c END STATE VECTOR BEGIN ACTIONS END ACTIONS"


@pytest.mark.parametrize(
    "block",
    [
        "",
        "\nBEGIN ASSUMPTIONS END ASSUMPTIONS",
        "\nBEGIN ASSUMPTIONS assume: NOT (S is c) END ASSUMPTIONS // END",
        "\nBEGIN ASSUMPTIONS\nassume: NOT S is c // mind the END\nEND\nASSUMPTIONS\n",
    ],
)
def test_the_assumption_is_added(block: str) -> None:
    """With a block, an empty block or none: one assumption more, the others stay, and everything can be read."""
    before = parse(TEXT + block)
    after = parse(with_assumption(Source("t", TEXT + block), "S is a OR S is b"))
    assert len(after.assumptions) == len(before.assumptions) + 1
    assert after.assumptions[: len(before.assumptions)] == before.assumptions or block.endswith("\n")
    assert after.assumptions[-1].text.split() == ["S", "is", "a", "OR", "S", "is", "b"]


def test_the_grid_with_its_assumption_is_realizable() -> None:
    """The paper's grid of five by five cells: a cross of five cells around the goal is what `explain` says remains."""
    case = next(case for case in CASES if case.name == "explain-grid5")
    told = re.search(r"part: (\d+) of 25 valid states, .*:\n  assume: (.*)", golden_path(case).read_text())
    assert told is not None
    states, assumption = told.groups()
    spec = parse(with_assumption(Source("grid5.tum", (ROOT / "examples" / "grid5.tum").read_text()), assumption))
    assert sum(is_valid(spec, state) for state in all_states(spec)) == int(states) == 5
    assert isinstance(synthesize(spec), Realizable)
