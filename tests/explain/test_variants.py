"""The paper's example, broken in ten ways: the first screen says where."""

import pytest

from tests.cli.golden import CASES, golden_path
from tests.explain.variants import VARIANTS, Variant

SCREEN = 24
"""Lines of a small terminal."""

_variants = pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.name)


def test_there_are_ten() -> None:
    """Ten variants, each with a name of its own."""
    assert len({variant.name for variant in VARIANTS}) == 10


@_variants
def test_the_first_screen_names_the_broken_line(variant: Variant) -> None:
    """The first lines of `explain` name the file and the line that is broken."""
    case = next(case for case in CASES if case.name == f"explain-{variant.name}")
    screen = golden_path(case).read_text().splitlines()[1 : SCREEN + 1]
    assert any(f"{variant.name}.tum:{variant.line}" in line for line in screen)


@pytest.mark.parametrize("name", ["missing_action", "wrong_effect"])
def test_what_nothing_makes_true_is_named(name: str) -> None:
    """Where an action is missing or an effect is wrong, the report says what no effect makes true."""
    case = next(case for case in CASES if case.name == f"explain-{name}")
    assert "no nominal effect ever makes `S_Battery is ok` true" in golden_path(case).read_text()
