"""A sample of the damaged files; `python -m tests.readers` tries many."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.readers.campaign import Tally, examine_file, examine_text, run


@pytest.mark.parametrize("block", range(3))
def test_both_read_the_same_specification(block: int, tmp_path: Path) -> None:
    """Damaged specifications are accepted by both readers or by none, with one meaning."""
    _hold(run(examine_text, range(block * 50, block * 50 + 50), tmp_path), "text: read", "text: refused")


@pytest.mark.parametrize("block", range(2))
def test_both_read_the_same_policy(block: int, tmp_path: Path) -> None:
    """The same of damaged policies and certificates."""
    _hold(run(examine_file, range(block * 50, block * 50 + 50), tmp_path), "file: policy", "file: refused")


def _hold(total: Tally, *kinds: str) -> None:
    assert not total.complaints
    assert all(total.kinds[kind] for kind in kinds)
