"""The texts of the examples."""

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def examples() -> dict[str, str]:
    """By name."""
    folder = Path(__file__).parents[2] / "examples"
    return {path.stem: path.read_text() for path in folder.glob("*.tum")}
