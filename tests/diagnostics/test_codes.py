"""Every code is emitted, and some test sees it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.repo.documents import ROOT
from tumato_symbolic.diagnostics import Code


def _texts(folder: str, *suffixes: str) -> str:
    paths = sorted(path for path in (ROOT / folder).rglob("*") if path.suffix in suffixes)
    return "\n".join(path.read_text(encoding="utf-8") for path in paths if path != Path(__file__))


EMITTED = set(re.findall(r"\bCode\.(TUM\d+)", _texts("tumato_symbolic", ".py")))
EXPECTED = set(re.findall(r"\bTUM\d+", _texts("tests", ".py", ".txt")))


@pytest.mark.parametrize("code", [code.name for code in Code])
def test_a_code_is_emitted_and_expected(code: str) -> None:
    """A documented code stands where the package raises it, and in a test or a golden output that waits for it."""
    assert code in EMITTED
    assert code in EXPECTED
