"""The compiled library of `proofs/coq`, once for all tests."""

from __future__ import annotations

import pytest

from tests.export.compiler import Library


@pytest.fixture(scope="session")
def library() -> Library:
    return Library.shared()
