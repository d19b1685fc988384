"""Explanations of generated specifications against the explicit meaning (`campaign.py` does this by the thousand)."""

import pytest

from tests.explain.campaign import examine
from tumato_symbolic.spec import Ordering

CHOSEN = (
    *(("mixed", seed) for seed in range(1, 4)),
    *(("interacting", seed) for seed in range(1, 4)),
    *(("restoring", seed) for seed in range(2, 4)),
    *(("concurrent", seed) for seed in range(2, 4)),
)

CONFLICTS = (
    ("interacting", 101314, "any"),
    ("interacting", 102349, "first"),
    ("mixed", 101684, "any"),
)


@pytest.mark.parametrize(("profile", "seed", "ordering"), CONFLICTS)
def test_a_conflict_is_explained(profile: str, seed: int, ordering: Ordering) -> None:
    """Conflicting states, their cores, repairs and the part that is left are what the explicit meaning says."""
    _, counts, wrong = examine((profile, seed, ordering, 3))
    assert counts["reasons: conflict"] == 1
    assert wrong == []


@pytest.mark.parametrize(("profile", "seed"), CHOSEN)
def test_an_explanation_is_right(profile: str, seed: int) -> None:
    """States, cores, repairs and the realizable part are what the explicit meaning says."""
    assert examine((profile, seed, "any" if seed % 2 else "first", 2))[2] == []
