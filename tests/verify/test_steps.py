"""Single steps: which outcomes there are, and in which order they may come."""

from itertools import combinations, islice

import pytest

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.semantics.build import Build, chosen
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import all_states, allowed, is_safe
from tumato_symbolic.spec import And, Is, Not, Ordering
from tumato_symbolic.verify import ProverName, verify
from tumato_symbolic.verify.by_z3 import outcomes
from tumato_symbolic.verify.by_z3.outcomes import objections_to


def _forbidding(build: Build, *forbidden: str) -> tuple[Not, ...]:
    return tuple(Not(And(tuple(Is(*pair) for pair in build.effect(text)))) for text in forbidden)


@pytest.mark.parametrize("prover", ["z3", "walk"])
def test_the_witness_is_an_order_that_goes_wrong(prover: ProverName) -> None:
    """An alternative happens after the other action's effect; under `first` there is no such order."""
    build = Build({"x": "abc", "y": "ab"})
    one = build.action("x=b", alternatives=["x=c"])
    two = build.action("x=b y=b")
    spec = build.spec(state_rules=_forbidding(build, "x=c y=b"))
    rows = {state: frozenset[int]() for state in all_states(spec) if state != build.state("cb")}
    rows[build.state("aa")] = chosen(one, two)
    results = {}
    for ordering in ("any", "first"):
        policy = policy_from_rows(spec, {**rows, build.state("cb"): chosen(two)})
        results[ordering] = verify(policy, spec, ordering=ordering, properties=["safe"], prover=prover).properties[0]
    assert results["first"].verdict == "proved"
    refutation = results["any"].refutation
    assert refutation is not None
    assert refutation.objection is not None
    assert [step.action for step in refutation.objection.outcome] == [two.action, one.action]
    assert refutation.objection.state == build.state("cb")


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_sought_outcomes_are_those_of_the_explicit_meaning(ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether outcomes are listed or sought, the same sets are allowed, and what is sought is an outcome."""
    monkeypatch.setattr(outcomes, "LISTED_ACTIONS", 1)
    found = 0
    for seed in range(15):
        spec = random_spec(seed, ALL_PROFILES["restoring"])
        actions = range(len(spec.actions))
        sets = [frozenset(each) for size in (2, 3) for each in combinations(actions, size)]
        for state in islice((state for state in all_states(spec) if is_safe(spec, state)), 4):
            for decision in sets:
                with_limit = objections_to(spec, state, decision, ordering)
                assert (not with_limit) == allowed(spec, state, decision, ordering)
                for objection in with_limit:
                    assert objection.kind != "unsafe" or not is_safe(spec, objection.outcome[-1].after)
                    found += objection.kind == "unsafe" and len(objection.outcome) > 1
    assert (found > 0) == (ordering == "any")
