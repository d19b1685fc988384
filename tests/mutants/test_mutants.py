"""A sample of the mutants; `make mutants` tries many."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.export.compiler import COQC
from tests.mutants.campaign import CLAUSES, Tally, examine
from tests.mutants.stepwise import examine_stepwise
from tests.mutants.unrealizable import examine_conflict, examine_unrealizable
from tests.profiles import ALL_PROFILES


@pytest.mark.parametrize("profile", [*ALL_PROFILES, CLAUSES])
def test_every_tier_tells_right_from_wrong(profile: str, tmp_path: Path) -> None:
    """Z3, the walk and the stand-alone checker accept every right mutant and reject every wrong one, strictly."""
    total = Tally()
    for seed in range(100, 114):
        total.add(examine(profile, seed, 5, tmp_path))
    assert not total.complaints
    assert 0 < total.right < total.mutants


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_both_checkers_accept_the_same_certificates(profile: str, tmp_path: Path) -> None:
    """What `verify` or the checker accepts has no policy, and is accepted by both; a new layout loses nothing."""
    total = Tally()
    for seed in range(100, 105):
        total.add(examine_unrealizable(profile, seed, 3, tmp_path))
    assert not total.complaints
    assert 0 < total.right < total.mutants


def test_both_checkers_accept_the_same_conflicts(tmp_path: Path) -> None:
    """So it is for conflicts, which are rare among generated specifications."""
    total = Tally()
    for number in range(0, 20, 6):
        total.add(examine_conflict(number, 6, tmp_path))
    assert not total.complaints
    assert 0 < total.right < total.mutants


def test_every_tier_tells_how_safety_is_restored(tmp_path: Path) -> None:
    """So it is where safety takes several steps to restore, and where some rules are more severe than others.

    Also of certificates that there is no policy. Where Coq is installed, its checker says the same of the decisions,
    and of efforts that are not theirs.
    """
    total = examine_stepwise(0, 1, tmp_path, coq=COQC is not None)
    assert not total.complaints
    assert 0 < total.right < total.mutants
    assert len(total.modes) > 10
    assert COQC is None or all(total.by_coq[each] for each in ("policy, right", "policy, wrong", "efforts, wrong"))
