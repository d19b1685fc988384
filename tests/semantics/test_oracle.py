"""The oracle against brute force, and its own claims."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from math import prod

import pytest

from tests.generate import random_spec
from tests.oracle import Together, World, conflict_is_minimal, decide, decide_world
from tests.profiles import INTERACTING, MIXED, Profile
from tumato_symbolic.semantics import ActionSet, State, follow, judge
from tumato_symbolic.spec import Ordering, Spec

TINY = Profile(
    variables=(2, 3),
    values=(1, 3),
    states=(3, 8),
    actions=(2, 4),
    preconditions=(0, 1),
    state_rules=(0, 1),
    reaction_rules=(0, 1),
    goals=(1, 3),
    executing=0.4,
    conditional=0.9,
)


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_the_oracle_agrees_with_trying_every_policy(ordering: Ordering) -> None:
    """A specification is realizable exactly when one of all policies is sound and complete.

    All are total and choose allowed sets, and safety is restored in one step: what is left is whether every run
    reaches its goal.
    """
    tried = 0
    for seed in range(250):
        spec = random_spec(seed, TINY)
        world = World(spec, ordering)
        choices = [[option.chosen for option in world.options[state]] for state in world.valid]
        if prod(map(len, choices)) > 2000:
            continue
        policies = (dict(zip(world.valid, picked, strict=True)) for picked in product(*choices))
        assert not spec.restores_stepwise
        exists = any(_serves_all(spec, policy) for policy in policies)
        assert (decide_world(world).kind == "realizable") == exists, seed
        tried += 1
    assert tried > 80


def _serves_all(spec: Spec, policy: Mapping[State, ActionSet]) -> bool:
    return all(follow(spec, policy, state, chosen).end == "goal" for state, chosen in policy.items())


@pytest.mark.parametrize("profile", [MIXED, INTERACTING])
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_every_policy_of_the_oracle_is_sound_and_complete(profile: Profile, ordering: Ordering) -> None:
    """What the oracle calls realizable has a policy that the judge accepts; encoding and fixpoint agree."""
    for seed in range(60):
        spec = random_spec(seed, profile)
        world = World(spec, ordering)
        verdict = decide_world(world)
        if verdict.policy is not None:
            assert judge(spec, verdict.policy, ordering).sound_and_complete, seed
        if verdict.kind != "failing":
            assert (Together(world).serve(world.valid) is None) == (verdict.kind == "conflict"), seed


def test_a_conflict_has_a_minimal_set() -> None:
    """Taking states away from a conflict one by one, as long as it stays one, ends in a set that the check accepts."""
    spec, world = next(
        (spec, world)
        for seed in range(400)
        for spec in [random_spec(seed, INTERACTING)]
        for world in [World(spec, "any")]
        if decide_world(world).kind == "conflict"
    )
    together, left = Together(world), list(world.valid)
    for state in world.valid:
        without = [other for other in left if other != state]
        if together.serve(without) is None:
            left = without
    assert conflict_is_minimal(spec, "any", left)
    assert len(left) == len(world.valid) or not conflict_is_minimal(spec, "any", world.valid)
    assert not conflict_is_minimal(spec, "any", left[1:])


def test_failing_states_are_told_apart_by_kind() -> None:
    """Both kinds of failing states, and both at once, occur in a sample; they are never the same states."""
    kinds = set()
    for seed in range(80):
        verdict = decide(random_spec(seed), "any")
        assert not verdict.no_allowed_set & verdict.no_plan
        kinds.add((bool(verdict.no_allowed_set), bool(verdict.no_plan)))
    assert kinds == set(product((True, False), repeat=2))
