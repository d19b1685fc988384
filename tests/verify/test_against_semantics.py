"""`verify` and the explicit judgement agree on generated specifications and policies near to right ones."""

from random import Random

import pytest

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.verify.policies import certified, dressed, exact_ranks, leaving, near_policies, wrong_ranks
from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import Judgement, State, better_sets, duration, judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify import ProverName, Refutation, Verification, verify
from tumato_symbolic.verify.by_z3 import rank_terms

Rows = dict[State, frozenset[int]]


def _assert_as_judged(
    spec: Spec, judged: Judgement, ordering: Ordering, policy: Policy, prover: ProverName = "auto"
) -> Verification:
    answer = verify(policy, spec, ordering=ordering, prover=prover)
    assert {result.name: result.verdict for result in answer.properties} == {
        "total": "refuted" if judged.missing else "proved",
        "safe": "refuted" if judged.not_allowed else "proved",
        "goals": "refuted" if judged.goal_missed else "proved",
        "minimal": "refuted" if judged.not_minimal else "proved",
    }
    assert answer.verdict == ("proved" if judged.sound_and_complete and judged.minimal else "refuted")
    return answer


def assert_witness(spec: Spec, rows: Rows, judged: Judgement, ordering: Ordering, refutation: Refutation) -> None:
    """The state fails as the refutation says, by the explicit meaning; the cheaper set is the best one."""
    state = refutation.state
    assert state is not None
    assert refutation.decision == rows.get(state)
    match refutation.kind:
        case "missing":
            exits = leaving(spec, rows, ordering)
            assert state in ({after for _, after in exits} or {judged.missing[0]})
        case "not-allowed":
            assert state in dict(judged.not_allowed)
            assert refutation.objection is not None
        case "goal-missed":
            assert refutation.run is not None
            assert refutation.run.end == dict(judged.goal_missed)[state].end
        case "not-minimal":
            better = better_sets(spec, rows, state, ordering)
            assert state == judged.not_minimal[0][0]
            assert refutation.cheaper == min(better, key=lambda each: (duration(spec, each), len(each), sorted(each)))


@pytest.mark.parametrize("prover", ["auto", "explicit"])
@pytest.mark.parametrize("profile", ALL_PROFILES)
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_strangers_are_judged_as_by_the_explicit_meaning(profile: str, ordering: Ordering, prover: ProverName) -> None:
    """Every verdict is the judge's, and every witness is one: the first state for total and minimal, the best set."""
    met = set()
    for seed in range(4):
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        for rows in near_policies(spec, ordering, random):
            judged = judge(spec, rows, ordering)
            answer = _assert_as_judged(spec, judged, ordering, dressed(spec, rows, random), prover)
            for result in answer.properties:
                met.add((result.name, result.verdict))
                if result.refutation is not None:
                    assert_witness(spec, rows, judged, ordering, result.refutation)
    assert len(met) >= 7


@pytest.mark.parametrize(
    ("prover", "parts"), [("auto", False), ("auto", True), ("explicit", False)], ids=["at-once", "by-parts", "explicit"]
)
def test_a_certificate_changes_no_verdict(prover: ProverName, parts: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Right ranks are used where every run reaches its goal; wrong ones are set aside; the verdicts are the same."""
    if parts:
        monkeypatch.setattr(rank_terms, "AT_ONCE", -1.0)
    met = set()
    for seed in range(11, 16):
        profile = ("restoring", "interacting")[seed % 2]
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        for rows in near_policies(spec, "any", random, count=1):
            judged = judge(spec, rows, "any")
            if judged.not_allowed:
                continue
            ranks = exact_ranks(spec, rows, "any")
            answer = _assert_as_judged(spec, judged, "any", certified(spec, rows, ranks), prover)
            assert (answer.certificate.status == "used") == (not judged.goal_missed)
            if ranks:
                changed = certified(spec, rows, wrong_ranks(ranks, random))
                met.add(_assert_as_judged(spec, judged, "any", changed, prover).certificate.status)
    assert met >= {"used", "wrong", "incomplete"}
