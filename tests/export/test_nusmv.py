"""The closed loop for NuSMV: right policies satisfy all claims, and wrong ones break the claim that is meant."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain, islice
from pathlib import Path

import pytest

from tests.export.cases import generated, stepwise
from tests.export.compiler import Case
from tests.export.model_checkers import needs_nusmv, nusmv_verdicts
from tests.export.policies import EXAMPLES, example, random_request, request
from tests.profiles import ALL_PROFILES
from tumato_symbolic.export import nusmv
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import judge
from tumato_symbolic.spec import Restoration


def _text(case: Case) -> str:
    return nusmv.files(replace(request(case.spec, case.rows), ordering=case.ordering))[0]


def _compare(cases: Sequence[Case], folder: Path) -> tuple[int, int]:
    """How many policies were right and wrong, where NuSMV and the meaning agree on each."""
    right = wrong = 0
    verdicts = nusmv_verdicts([_text(case) for case in cases], folder)
    for case, claims in zip(cases, verdicts, strict=True):
        truth = judge(case.spec, case.rows, case.ordering)
        assert all(claims.values()) == truth.sound_and_complete, (truth, claims)
        assert claims["total"] or truth.missing
        if not truth.missing and not truth.not_allowed:
            assert claims.get("goals_reached", True) == (not truth.goal_missed)
            assert claims.get("safety_restored", True) == (not truth.not_restored)
        right += truth.sound_and_complete
        wrong += not truth.sound_and_complete
    return right, wrong


@needs_nusmv
def test_every_example_satisfies_all_claims(tmp_path: Path) -> None:
    """As a table and as a diagram."""
    texts = [nusmv.files(example(name, diagram=number % 2 == 0))[0] for number, name in enumerate(EXAMPLES)]
    for name, claims in zip(EXAMPLES, nusmv_verdicts(texts, tmp_path), strict=True):
        assert {"total", "allowed_at_decisions", "safe_after_effects"} <= claims.keys()
        assert all(claims.values()), (name, claims)


@needs_nusmv
def test_changed_policies_of_the_robot(tmp_path: Path) -> None:
    """Another decision in one state, or none: NuSMV accepts it where the explicit meaning does."""
    made = example("amr")
    assert isinstance(made.policy.decisions, Table)
    rows = made.policy.decisions.rows
    changed = [
        {**rows, state: frozenset(chosen)}
        for number, state in enumerate(rows)
        for chosen in ((number % 8,), (6, (number + 3) % 6))
    ]
    holed = [{other: chosen for other, chosen in rows.items() if other != state} for state in list(rows)[:4]]
    _, wrong = _compare([Case(made.spec, each, "any") for each in [*changed, *holed]], tmp_path)
    assert wrong > 50


@needs_nusmv
@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_generated_policies(profile: str, tmp_path: Path) -> None:
    """Right and wrong ones, under both orderings."""
    realizable = (found for seed in range(160, 220) if (found := generated(profile, seed, 4)))
    right, _ = _compare(list(chain.from_iterable(islice(realizable, 2))), tmp_path)
    assert right > 0


@needs_nusmv
@pytest.mark.parametrize("restoration", ["one_step", "bounded", "fair"])
def test_where_safety_takes_several_steps(restoration: Restoration, tmp_path: Path) -> None:
    """And with severities of state rules."""
    cases = [case for seed in (51, 52) for case in stepwise(seed, restoration, 1 + seed % 3)]
    right, wrong = _compare(cases[:24], tmp_path)
    assert right + wrong > 10


@needs_nusmv
def test_nasty_names_are_read(tmp_path: Path) -> None:
    """Words of NuSMV, names of ours, and names that are alike once joined."""
    texts = [nusmv.files(random_request(seed))[0] for seed in range(12)]
    assert len(nusmv_verdicts(texts, tmp_path)) == len(texts)
