"""What README and docs show is what happens."""

import re
from pathlib import Path

import pytest

from tests.repo.documents import ROOT, Step, matches, perform, prepare, steps

DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "examples").rglob("*.md")])
TEXTS = sorted([*DOCUMENTS, ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *(ROOT / "proofs").glob("*.md")])
_LINK = re.compile(r"\]\((?!https?://)([^)#]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize(
    "document", DOCUMENTS, ids=lambda path: path.name if path.parent == ROOT else str(path.relative_to(ROOT))
)
def test_every_command_prints_what_the_document_shows(document: Path, tmp_path: Path) -> None:
    """Each command of a document, in order, exits with 0 and prints the output shown."""
    prepare(tmp_path)
    for step in steps(document.read_text()):
        printed = perform(step, tmp_path)
        if isinstance(step, Step):
            assert matches(step.expected, printed), (
                f"$ {step.command}\n{printed}\n--- the document says\n{step.expected}"
            )


@pytest.mark.parametrize("document", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_to_files(document: Path) -> None:
    """A relative link in a document names a file of the repository."""
    for target in _LINK.findall(document.read_text()):
        assert (document.parent / target).exists(), target


def test_make_targets_in_the_readme_exist() -> None:
    """`make X` in README and CONTRIBUTING names a target of the Makefile."""
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    said = (ROOT / "README.md").read_text() + (ROOT / "CONTRIBUTING.md").read_text()
    assert set(re.findall(r"\bmake ([a-z]+)\b", said)) <= targets


def test_the_runner_notices_wrong_output() -> None:
    """Only times and what `...` stands for may differ."""
    assert matches("took 0.1 s\n", "took 12 s")
    assert matches("a ... c\n...\nz", "a b c\n1\n2\nz\n")
    assert not matches("32 states", "33 states")
    assert not matches("a ... c", "a\nc")
    assert not matches("one line", "one line\nanother")
