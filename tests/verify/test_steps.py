"""Single steps: which outcomes there are, and in which order they may come."""

from itertools import combinations, islice

import pytest

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.semantics.build import Build, chosen
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, State, all_states, allowed, is_safe, objections
from tumato_symbolic.spec import And, Is, Not, Ordering, Spec
from tumato_symbolic.verify import PropertyResult, verify
from tumato_symbolic.verify.by_z3 import outcomes
from tumato_symbolic.verify.by_z3.outcomes import objections_to


def _safe(spec: Spec, rows: dict[State, ActionSet], ordering: Ordering) -> PropertyResult:
    """The verdict on `safe`, for `rows` and nothing done elsewhere."""
    everywhere = {state: rows.get(state, frozenset()) for state in all_states(spec)}
    return verify(policy_from_rows(spec, everywhere), spec, ordering=ordering, properties=["safe"]).properties[0]


def _forbidding(build: Build, *forbidden: str) -> tuple[Not, ...]:
    return tuple(Not(And(tuple(Is(*pair) for pair in build.effect(text)))) for text in forbidden)


def test_order_of_effects_on_one_variable() -> None:
    """Under `any`, an alternative may strike after the other action's effect; under `first` it cannot."""
    build = Build({"x": "abc", "y": "ab"})
    one = build.action("x=b", alternatives=["x=c"])
    two = build.action("x=b y=b")
    spec = build.spec(state_rules=_forbidding(build, "x=c y=b"))
    rows = {state: frozenset[int]() for state in all_states(spec) if state != build.state("cb")}
    rows[build.state("aa")] = chosen(one, two)
    results = {}
    for ordering in ("any", "first"):
        policy = policy_from_rows(spec, {**rows, build.state("cb"): chosen(two)})
        results[ordering] = verify(policy, spec, ordering=ordering, properties=["safe"]).properties[0]
    assert results["first"].verdict == "proved"
    refutation = results["any"].refutation
    assert refutation is not None
    assert refutation.objection is not None
    assert [step.action for step in refutation.objection.outcome] == [two.action, one.action]
    assert refutation.objection.state == build.state("cb")


def test_an_action_takes_effect_once() -> None:
    """Two alternatives of the same action never both strike in one step."""
    build = Build({"x": "ab", "y": "ab"})
    action = build.action("", alternatives=["x=b", "y=b"])
    spec = build.spec(state_rules=_forbidding(build, "x=b y=b"))
    rows = {build.state("aa"): chosen(action)}
    refutation = _safe(spec, rows, "any").refutation
    assert refutation is not None
    assert refutation.state == build.state("bb"), "only the unsafe state, where nothing is done, is refuted"


def test_all_nominal_effects_together_must_be_safe_under_first() -> None:
    """Under `first` each effect alone may be safe while `δ` is not: condition 6."""
    build = Build({"x": "ab", "y": "ab"})
    one, two = build.action("x=b"), build.action("y=b")
    back = build.action("x=a")
    spec = build.spec(state_rules=_forbidding(build, "x=b y=b"))
    rows = {build.state("aa"): chosen(one, two), build.state("bb"): chosen(back)}
    refutation = _safe(spec, rows, "first").refutation
    assert refutation is not None
    assert refutation.objection is not None
    assert refutation.objection.kind == "nominal-unsafe"
    assert refutation.state == build.state("aa")


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_doing_nothing_is_for_safe_states(ordering: Ordering) -> None:
    """The empty set is refuted in an unsafe state."""
    build = Build({"x": "ab"})
    build.action("x=a")
    spec = build.spec(state_rules=_forbidding(build, "x=b"))
    refutation = _safe(spec, {}, ordering).refutation
    assert refutation is not None
    assert (refutation.state, refutation.decision) == (build.state("b"), frozenset())


def test_every_condition_has_its_objection() -> None:
    """Preconditions, resources, nominal agreement and reaction rules are refuted by name."""
    build = Build({"x": "abc"}, resources=["R"])
    first = build.action("x=b", needs=["R"])
    second = build.action("x=b", needs=["R"])
    third = build.action("x=c")
    guarded = build.action("x=a", when=[build.atom("x=b")])
    spec = build.spec(reaction_rules=[Not(third)])
    expected = {
        chosen(guarded): "precondition",
        chosen(first, second): "resource",
        chosen(first, third): "nominal-conflict",
        chosen(third): "reaction-rule",
    }
    for decision, kind in expected.items():
        refutation = _safe(spec, {build.state("a"): decision}, "any").refutation
        assert refutation is not None
        assert refutation.objection == next(objections(spec, build.state("a"), decision, "any"))
        assert refutation.objection.kind == kind


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_sought_outcomes_are_those_of_the_explicit_meaning(ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether outcomes are listed or sought, the same sets are allowed, and what is sought is an outcome."""
    monkeypatch.setattr(outcomes, "LISTED_ACTIONS", 1)
    found = 0
    for seed in range(15):
        spec = random_spec(seed, PROFILES["restoring"])
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
