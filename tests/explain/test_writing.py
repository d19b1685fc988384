"""Tests of writing an assumption into a specification."""

import pytest

from tests.repo.documents import ROOT
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.explain.writing import with_assumption

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
    """The paper's grid of five by five cells: a cross of five cells around the goal is what remains."""
    from tumato_symbolic.explain.explain import explain
    from tumato_symbolic.explain.explanation import Explanation

    text = (ROOT / "examples" / "grid5.tum").read_text()
    found = explain(parse(text), wanted_repairs=0)
    assert isinstance(found, Explanation)
    assert found.part is not None
    assert (found.part.states, found.part.given_up, found.part.unique) == (5, 20, True)
    outcome = synthesize(parse(with_assumption(Source("grid5.tum", text), found.part.text)))
    assert isinstance(outcome, Realizable)
