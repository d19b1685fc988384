"""What tests of the stand-alone checker share."""

from __future__ import annotations

from functools import lru_cache

import pytest

from tests.checker.standalone import checker


@pytest.fixture
def read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Specifications of which many policies are judged, one after the other, are read once."""
    monkeypatch.setattr(checker, "read_specification", lru_cache(maxsize=4)(checker.read_specification))
