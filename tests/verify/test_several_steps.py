"""`verify` and the explicit judgement agree where safety may take several steps to restore."""

from collections import Counter
from random import Random

import pytest
from msgspec.structs import replace

from tests.verify.several_steps import RESTORATIONS, Rows, near, stepwise_spec
from tumato_symbolic.policy import Policy, policy_from_rows
from tumato_symbolic.semantics import Judgement, better_sets, excluded, is_valid, judge
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.verify import ProverName, Refutation, Verification, verify

ORDERINGS: tuple[Ordering, ...] = ("any", "first")
PROVERS: tuple[ProverName, ...] = ("explicit", "walk", "z3")


def judged_by(
    spec: Spec, rows: Rows, ordering: Ordering, policy: Policy, prover: ProverName, *, judged: Judgement | None = None
) -> Verification:
    """The answer of a prover, which is the judge's wherever there is one.

    The walk has no name for a set in which two actions exclude each other.
    """
    judged = judged or judge(spec, rows, ordering)
    answer = verify(policy, spec, ordering=ordering, prover=prover, restoration=spec.restoration)
    expected = {
        "total": not judged.missing,
        "safe": not judged.not_allowed,
        "restoring": not judged.not_restored,
        "goals": not judged.goal_missed,
        "minimal": not judged.not_minimal,
    }
    assert {result.name for result in answer.properties} == set(expected)
    for result in answer.properties:
        if result.verdict == "undecided" and prover == "walk":
            assert result.name in ("restoring", "minimal")
            masks = excluded(spec)
            assert any(masks[one] >> other & 1 for chosen in rows.values() for one in chosen for other in chosen)
            continue
        assert result.verdict == ("proved" if expected[result.name] else "refuted"), (result, judged)
        if result.refutation is not None:
            _assert_witness(spec, rows, judged, ordering, result.refutation)
    return answer


def _assert_witness(spec: Spec, rows: Rows, judged: Judgement, ordering: Ordering, refutation: Refutation) -> None:
    state, run = refutation.state, refutation.run
    assert state is not None
    assert is_valid(spec, state)
    match refutation.kind:
        case "not-allowed":
            assert state in dict(judged.not_allowed)
        case "not-restored":
            assert state in judged.not_restored
            assert run is not None
            assert run.states[0] == state
            assert run.end in ("loop", "undefined")
        case "goal-missed":
            assert run is not None
            assert run.end == dict(judged.goal_missed)[state].end
        case "not-minimal":
            assert refutation.cheaper in set(better_sets(spec, rows, state, ordering))
            assert refutation.qualities is not None


@pytest.mark.parametrize("ordering", ORDERINGS)
@pytest.mark.parametrize("restoration", RESTORATIONS)
def test_every_mode_is_judged_as_by_the_explicit_meaning(restoration: Restoration, ordering: Ordering) -> None:
    """Right policies, nearly right and random ones: every verdict is the judge's, and every witness is one.

    `make mutants` tries thousands.
    """
    met = Counter[tuple[str, str, str]]()
    for seed in range(5):
        spec, random = stepwise_spec(seed, restoration, 1 + seed % 3), Random(seed)
        if not spec.restores_stepwise:
            continue
        for rows in near(spec, ordering, random, count=1):
            judged = judge(spec, rows, ordering)
            for prover in PROVERS:
                answer = judged_by(spec, rows, ordering, policy_from_rows(spec, rows), prover, judged=judged)
                met.update((prover, result.name, result.verdict) for result in answer.properties)
    assert len([each for each in met if each[-1] != "undecided"]) == 10 * len(PROVERS), met


def test_a_policy_for_a_weaker_restoration_is_refuted() -> None:
    """Unless it is said by which one to judge it."""
    spec = stepwise_spec(0, "bounded", 1)
    policy = replace(policy_from_rows(spec, {}), restoration="fair")
    kinds = [each.refutation.kind for each in verify(policy, spec).properties if each.refutation is not None]
    assert kinds[0] == "restoration"
    told = verify(policy, spec, restoration="bounded")
    assert "restoration" not in [each.name for each in told.properties]
