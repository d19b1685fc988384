"""The closed loop for NuSMV, Storm and TLA+: right policies satisfy all claims, wrong ones break the one meant."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.cases import generated, stepwise
from tests.export.compiler import Case
from tests.export.model_checkers import (
    MOST_STATES_LISTED,
    Verdicts,
    by_storm,
    needs_nusmv,
    needs_storm,
    needs_tla,
    nusmv_verdicts,
    storm_verdicts,
    tla_verdicts,
)
from tests.export.policies import EXAMPLES, example, random_request, request
from tests.profiles import ALL_PROFILES
from tumato_symbolic.export.request import Request
from tumato_symbolic.export.targets import load
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import count_states, judge
from tumato_symbolic.spec import Restoration

MOST_STATES = {"prism": MOST_STATES_LISTED, "tlaplus": 500}
"""Larger examples take Storm seconds, and `tla` minutes: `python -m tests.export.trial storm --of examples`."""

CHECKERS = (
    pytest.param("nusmv", nusmv_verdicts, marks=needs_nusmv),
    pytest.param("prism", storm_verdicts, marks=needs_storm),
    pytest.param("tlaplus", tla_verdicts, marks=needs_tla),
)

by_each = pytest.mark.parametrize(("target", "verdicts"), CHECKERS)


def _compare(target: str, verdicts: Verdicts, cases: Sequence[Case], folder: Path) -> tuple[int, int]:
    """How many policies were right and wrong, where the tool and the meaning agree on each."""
    right = wrong = 0
    requests = [replace(request(case.spec, case.rows), ordering=case.ordering) for case in cases]
    found = verdicts([load(target)(made) for made in requests], folder)
    for case, claims in zip(cases, found, strict=True):
        truth = judge(case.spec, case.rows, case.ordering)
        assert all(claims.values()) == truth.sound_and_complete, (truth, claims)
        assert claims["total"] or truth.missing
        if not truth.missing and not truth.not_allowed:
            assert claims.get("goals_reached", True) == (not truth.goal_missed)
            assert claims.get("safety_restored", True) == (not truth.not_restored)
        right += truth.sound_and_complete
        wrong += not truth.sound_and_complete
    return right, wrong


@by_each
def test_every_example_satisfies_all_claims(target: str, verdicts: Verdicts, tmp_path: Path) -> None:
    """As a table or as a diagram."""

    def asked(number: int, name: str) -> Request | None:
        made = example(name, diagram=number % 2 == 0)
        return made if count_states(made.spec) <= MOST_STATES.get(target, 1_000_000) else None

    requests = [made for number, name in enumerate(EXAMPLES) if (made := asked(number, name)) is not None]
    assert len(requests) > 7
    for made, claims in zip(requests, verdicts([load(target)(each) for each in requests], tmp_path), strict=True):
        assert {"total", "allowed_at_decisions", "safe_after_effects"} <= claims.keys()
        assert all(claims.values()), (made.spec.variables, claims)


@by_each
def test_changed_policies_of_the_robot(target: str, verdicts: Verdicts, tmp_path: Path) -> None:
    """Another decision in one state, or none: the tool accepts it where the explicit meaning does."""
    made = example("amr")
    assert isinstance(made.policy.decisions, Table)
    rows = made.policy.decisions.rows
    changed = [
        {**rows, state: frozenset(chosen)}
        for number, state in enumerate(rows)
        for chosen in ((number % 8,) if number % 2 else (6, (number + 3) % 6),)
    ]
    holed = [{other: chosen for other, chosen in rows.items() if other != state} for state in list(rows)[:4]]
    cases = [Case(made.spec, each, "any") for each in [*changed, *holed]]
    _, wrong = _compare(target, verdicts, cases, tmp_path)
    assert wrong > 25


@by_each
@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_generated_policies(target: str, verdicts: Verdicts, profile: str, tmp_path: Path) -> None:
    """Right and wrong ones, under both orderings. Of more: `python -m tests.export.trial nusmv`, `storm` and `tla`."""
    cases = next(found for seed in range(160, 220) if (found := generated(profile, seed, 4)))
    right, _ = _compare(target, verdicts, cases, tmp_path)
    assert right > 0


@by_each
@pytest.mark.parametrize("restoration", ["one_step", "bounded", "fair"])
def test_where_safety_takes_several_steps(
    target: str, verdicts: Verdicts, restoration: Restoration, tmp_path: Path
) -> None:
    """And with severities of state rules."""
    cases = [case for seed in (51, 52) for case in stepwise(seed, restoration, 1 + seed % 3)]
    right, wrong = _compare(target, verdicts, cases[:24], tmp_path)
    assert right + wrong > 10


@needs_storm
def test_storm_says_the_same_by_diagrams(tmp_path: Path) -> None:
    """Of a right policy, and of wrong ones."""
    made = example("amr")
    assert isinstance(made.policy.decisions, Table)
    rows = made.policy.decisions.rows
    (first, *_), *_ = rows.items()
    for changed in (rows, {**rows, first: frozenset((7,))}, {**rows, first: frozenset()}):
        text, properties = load("prism")(request(made.spec, changed))
        listed, diagrams = (by_storm(text, properties, tmp_path, diagrams=way) for way in (False, True))
        assert listed == diagrams
        assert all(listed.values()) == (changed is rows)


@by_each
def test_nasty_names_are_read(target: str, verdicts: Verdicts, tmp_path: Path) -> None:
    """Words of the language, names of ours, and names that are alike once joined."""
    texts = [load(target)(random_request(seed)) for seed in range(6)]
    assert len(verdicts(texts, tmp_path)) == len(texts)
