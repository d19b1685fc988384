"""Models for other tools decide as `decide` does; `python -m tests.export.decided` asks about all examples."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.export.decided import TOOLS, decided
from tests.export.judges import JUDGES
from tests.export.policies import example


@pytest.mark.parametrize("tool", [pytest.param(tool, marks=JUDGES[tool].needs) for tool in TOOLS])
def test_each_state_is_decided_as_decide_does(tool: str, tmp_path: Path) -> None:
    """And where one state is said to be decided otherwise, or not at all, that is noticed."""
    made = example("amr")
    wanted = decided(made)
    assert TOOLS[tool](made, wanted, tmp_path)
    *_, last = wanted
    for other in (None, ("charge",)):
        assert wanted[last] != other
        assert not TOOLS[tool](made, {**wanted, last: other}, tmp_path)
