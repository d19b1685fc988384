"""A sample of the mutants; `make mutants` tries many."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.mutants.campaign import Tally, examine
from tests.mutants.refusals import examine_refusal
from tests.profiles import PROFILES


@pytest.mark.parametrize("profile", PROFILES)
def test_every_tier_tells_right_from_wrong(profile: str, tmp_path: Path) -> None:
    """Z3, the walk and the stand-alone checker accept every right mutant and reject every wrong one, strictly."""
    total = Tally()
    for seed in range(100, 124):
        total.add(examine(profile, seed, 5, tmp_path))
    assert not total.complaints
    assert 0 < total.right < total.mutants


@pytest.mark.parametrize("profile", PROFILES)
def test_nothing_false_is_proved_of_the_answer_no(profile: str, tmp_path: Path) -> None:
    """Where something changed is proved unrealizable there is no policy; a change of the layout alone loses nothing."""
    total = Tally()
    for seed in range(100, 130):
        total.add(examine_refusal(profile, seed, 3, tmp_path))
    assert not total.complaints
    assert 0 < total.right < total.mutants
