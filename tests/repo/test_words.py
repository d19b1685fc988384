"""One name for one thing: words that stood beside a term of the glossary do not come back."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]

FORBIDDEN = {
    r"owe[sd]?|owing": "a residual goal is pending",
    r"disproofs?|disproved|answer no": "unrealizable",
    r"strikes?|struck|striking": "effects happen, interleave or take effect",
    r"spoken of|spoken_of": "mentioned, or covered",
    r"by_walk": "by_diagrams",
    r"whoever|anybody's|believes nobody|for want of": "say what it is",
    r"gives? back|giving back|what would do": "revert, possible changes",
}
"""Whole words, in any case, and what is said instead."""


def test_old_words_do_not_come_back() -> None:
    """In the package, its documents and the stand-alone checker's messages."""
    files = [
        *(ROOT / "tumato_symbolic").rglob("*.py"),
        *(ROOT / "tumato_symbolic").rglob("*.json"),
        *(ROOT / "docs").rglob("*.md"),
        ROOT / "README.md",
        ROOT / "CONTRIBUTING.md",
        ROOT / "proofs" / "checker.py",
    ]
    pattern = re.compile(rf"(?<![a-z])(?:{'|'.join(FORBIDDEN)})(?![a-z])", re.IGNORECASE)
    found = [
        f"{file.relative_to(ROOT)}:{number}: {line.strip()}"
        for file in files
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1)
        if pattern.search(line)
    ]
    assert found == []


def test_a_term_has_one_row_in_the_glossary() -> None:
    """So none has two meanings."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    glossary = text[text.index("## Glossary") : text.index("## Where a change goes")]
    rows = [line.split("|")[1].strip() for line in glossary.splitlines() if line.startswith("| ")][1:]
    terms = [term for row in rows for term in row.split(", ")]
    assert len(terms) > 30
    assert len(set(terms)) == len(terms)
