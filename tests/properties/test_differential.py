"""The whole tool against the explicit meaning: a fixed sample of `tests.campaign`."""

from __future__ import annotations

import pytest

pytest.importorskip("tumato_symbolic.synthesis", exc_type=ImportError)
pytest.importorskip("tests.differential", exc_type=ImportError)

from tests.differential import Case, examine
from tests.generate import PROFILES
from tumato_symbolic.spec import Ordering

SAMPLE = [(profile, seed) for profile in PROFILES for seed in range(10)]


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize(("profile", "seed"), SAMPLE)
def test_synthesizer_and_verifier_agree_with_the_explicit_meaning(profile: str, seed: int, ordering: Ordering) -> None:
    """Verdict, failing states, policy, longest run, and the verdicts on right and wrong policies are the oracle's."""
    assert examine(Case(profile, seed, ordering), mutants=2).complaints == []
