"""The whole tool against the explicit meaning: a fixed sample of `tests.campaign`."""

from __future__ import annotations

import pytest

from tests.differential import Case, examine
from tests.generate import random_spec
from tests.oracle import decide
from tests.profiles import ALL_PROFILES
from tests.repeats.specs import crossroads
from tumato_symbolic import parse
from tumato_symbolic.spec import Ordering
from tumato_symbolic.synthesis import Undecided, repair, synthesize

PLAIN = [(profile, seed) for profile in ALL_PROFILES for seed in range(8)]
INTERACTING = [("interacting", 37), ("interacting", 45), ("interacting", 80), ("restoring", 123), ("mixed", 148)]
CONFLICTING = [("interacting", 48), ("interacting", 189), ("restoring", 74)]
SAMPLE = [*PLAIN, *INTERACTING, *CONFLICTING]


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize(("profile", "seed"), SAMPLE)
def test_synthesizer_and_verifier_agree_with_the_explicit_meaning(profile: str, seed: int, ordering: Ordering) -> None:
    """Verdict, failing states, policy, longest run, and the verdicts on right and wrong policies are the oracle's."""
    assert examine(Case(profile, seed, ordering), mutants=2).complaints == []


@pytest.mark.parametrize(("profile", "seed"), INTERACTING)
def test_the_sample_has_goals_that_interact(profile: str, seed: int) -> None:
    """These have a policy, though runs inside the goals' own regions do not make one."""
    verdict = decide(random_spec(seed, ALL_PROFILES[profile]), "any")
    assert (verdict.kind, verdict.own_region) == ("realizable", False)


@pytest.mark.parametrize(("profile", "seed"), CONFLICTING)
def test_the_sample_has_goals_that_conflict(profile: str, seed: int) -> None:
    """In these every state taken alone has a plan, and no policy serves them all."""
    assert decide(random_spec(seed, ALL_PROFILES[profile]), "any").kind == "conflict"


@pytest.mark.parametrize(("profile", "seed"), [*INTERACTING, *CONFLICTING])
def test_cutting_off_what_leads_nowhere_changes_no_answer(
    profile: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the first round on: the answers, and the certificates of conflicts, are still right."""
    monkeypatch.setattr(repair, "NARROW_ROUNDS", 0)
    assert examine(Case(profile, seed, "any"), mutants=2).complaints == []


def test_many_loops_are_not_cut_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut one by one, the loops of this conflict took 211 rounds."""
    monkeypatch.setattr(repair, "ROUNDS", 100)
    assert not isinstance(synthesize(parse(crossroads(76))), Undecided)
