"""The compiled library of `proofs/coq`, once for all tests."""

from __future__ import annotations

import pytest

from tests.export.compiler import Library


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    found = Library.copy_to(tmp_path_factory.mktemp("coq"))
    built = found.build()
    assert built.returncode == 0, built.stderr
    return found
