"""A sample of what `python -m tests.clauses` tries: clauses against the same written out."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.clauses.compare import examine


@pytest.mark.parametrize("block", range(3))
def test_clauses_mean_what_separate_actions_mean(block: int, tmp_path: Path) -> None:
    """The same allowed sets, decisions, certificates and verdicts, for right and for changed policies."""
    for seed in range(4 * block, 4 * block + 4):
        assert examine(seed, tmp_path, mutants=1).differences == []
