"""Explanations of generated specifications against the explicit meaning (`campaign.py` does this by the thousand)."""

import pytest

from tests.explain.campaign import examine

CHOSEN = (
    *(("mixed", seed) for seed in range(8)),
    *(("interacting", seed) for seed in range(8)),
    *(("restoring", seed) for seed in range(6)),
    *(("concurrent", seed) for seed in range(6)),
)


@pytest.mark.parametrize(("profile", "seed"), CHOSEN)
def test_an_explanation_is_right(profile: str, seed: int) -> None:
    """States, cores, repairs and the realizable part are what the explicit meaning says."""
    assert examine((profile, seed, "any" if seed % 2 else "first", 2))[2] == []
