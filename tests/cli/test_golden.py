"""Commands print what was reviewed."""

import pytest

from tests.cli.golden import CASES, Case, golden_path, produce


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_output_is_what_was_reviewed(case: Case) -> None:
    """Output, streams and exit code equal the golden file (`make regenerate` writes it; read the difference)."""
    assert produce(case) == golden_path(case).read_text()


def test_no_golden_file_without_a_case() -> None:
    """Every golden file belongs to a case."""
    assert {path.name for path in golden_path(CASES[0]).parent.glob("*.txt")} == {f"{case.name}.txt" for case in CASES}
