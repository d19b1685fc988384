"""The printer and the parser are inverses."""

from pathlib import Path

import pytest
from hypothesis import given, settings

from tests.syntax.printing import print_specification
from tests.syntax.trees import specifications
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.syntax import ast, parse, read_source

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.tum"))


@settings(max_examples=80)
@given(specifications)
def test_what_is_printed_parses_to_the_same_tree(tree: ast.Specification) -> None:
    """`parse(print(tree)) == tree` for every tree, whatever words serve as names."""
    parsed = parse(Source("generated", print_specification(tree)))
    assert parsed.diagnostics == ()
    assert parsed.tree == tree


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_printing_settles_after_one_round(path: Path) -> None:
    """A real specification keeps its tree when printed, and what is printed prints as itself."""
    tree = parse(read_source(str(path))).tree
    assert tree is not None
    text = print_specification(tree)
    again = parse(Source("printed", text)).tree
    assert again == tree
    assert print_specification(again) == text
