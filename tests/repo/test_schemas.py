"""The JSON Schemas that are shipped."""

from pathlib import Path

import pytest

from tests.repo.schemas import FOLDER, schemas


@pytest.mark.parametrize(
    ("path", "text"), list(schemas()), ids=lambda value: value.stem if isinstance(value, Path) else ""
)
def test_each_is_what_the_tables_say(path: Path, text: str) -> None:
    """As `make regenerate` writes them, from the tables by which files are read and written."""
    assert path.read_text(encoding="utf-8") == text


def test_all_are_generated() -> None:
    """None is written by hand."""
    assert sorted(path for path, _ in schemas()) == sorted(FOLDER.glob("*.schema.json"))
