"""Decisions in the region of the own goals."""

from __future__ import annotations

import pytest

from benchmarks.missions import sampler
from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.game import routing
from tumato_symbolic.game.problem import Problem, build_problem
from tumato_symbolic.game.routing import own_region_policy
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Bdd, Turn, available_backend, in_turns

SEEDS = range(20)


def searches_in_turns(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> int:
    """How many searches went on in turns from the first layer on; the policy and its ranks are the same."""
    problem, taken = build_problem(spec, "any", available_backend()), []

    def turns_of(problem: Problem, relation: Bdd) -> Turn | None:
        taken.append(in_turns(problem.encoding, relation))
        return taken[-1]

    expected = own_region_policy(problem)
    with monkeypatch.context() as patch:
        patch.setattr(routing, "MANY_NODES", 0)
        patch.setattr(routing, "turns_of", turns_of)
        assert own_region_policy(problem) == expected
    return sum(turn is not None for turn in taken)


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_decisions_in_turns_are_those_layer_by_layer(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the specification is, with a bound on plans or without."""
    specs = (random_spec(seed, ALL_PROFILES[profile]) for seed in SEEDS)
    assert sum(searches_in_turns(spec, monkeypatch) for spec in specs) > len(SEEDS) / 2


@pytest.mark.parametrize("most", [2, 6, 14])
def test_plans_of_many_layers(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two groups that act at once, and ranks that count; plans may be bounded below what is needed."""
    text = sampler(4, True).replace("max_plan_length: 14", f"max_plan_length: {most}")
    assert f"max_plan_length: {most}" in text
    assert searches_in_turns(parse(text), monkeypatch) == 3
