"""Tests of what `explain` may be asked: caps, more cores, no repairs, both orderings."""

from msgspec.structs import replace

from tests.cli.inputs import CONFLICT, TWO_ROBOTS, WARNED
from tests.generate import random_spec
from tumato_symbolic import parse, synthesize
from tumato_symbolic.explain.explain import MAX_CUBES, explain
from tumato_symbolic.explain.explanation import Explanation, NothingToExplain
from tumato_symbolic.limits import Context
from tumato_symbolic.spec.many_goals import many_told
from tumato_symbolic.symbolic import Backend, available_backend

BACKENDS: tuple[Backend, Backend] = (available_backend(), "autoref")


def _explained(text: str, wanted_repairs: int = 3, max_cubes: int = MAX_CUBES) -> Explanation:
    found = explain(parse(text), wanted_repairs=wanted_repairs, max_cubes=max_cubes)
    assert isinstance(found, Explanation)
    return found


def test_two_robots() -> None:
    """112 states without an allowed set, in four disjoint cubes, each with one core."""
    found = _explained(TWO_ROBOTS.read_text(), wanted_repairs=0)
    assert found.failing_states == 112
    assert sorted(reason.count for reason in found.reasons) == [16, 16, 16, 64]
    assert all(len(reason.cubes) == 1 and reason.kind == "no-allowed-set" for reason in found.reasons)
    assert found.part is not None
    assert found.part.states == 912


def test_a_cap_on_cubes_says_what_it_left_out() -> None:
    """`max_cubes` keeps the largest; the counts stay exact."""
    found = _explained(TWO_ROBOTS.read_text(), wanted_repairs=0, max_cubes=2)
    assert sum(len(reason.cubes) for reason in found.reasons) == 2
    assert [reason.omitted for reason in found.reasons] == [0, 0, 16, 16]
    assert sum(reason.count for reason in found.reasons) == 112


def test_no_repairs_are_looked_for_where_none_are_wanted() -> None:
    """`wanted_repairs=0` is quick, and does not claim that there are none."""
    found = _explained(CONFLICT, wanted_repairs=0)
    assert (found.repairs, found.repairs_complete) == ((), False)


def test_a_policy_leaves_nothing_to_explain() -> None:
    """On a realizable specification."""
    assert isinstance(explain(parse(WARNED)), NothingToExplain)


def test_the_same_explanation_twice() -> None:
    """Explanations are deterministic."""
    assert _explained(CONFLICT) == _explained(CONFLICT)


def test_both_backends_give_the_same_explanation() -> None:
    """Nothing depends on how a backend enumerates."""
    for seed in (2, 4, 6):
        first, second = (explain(random_spec(seed), "any", backend=backend) for backend in BACKENDS)
        assert isinstance(first, Explanation)
        assert isinstance(second, Explanation)
        assert first.repairs
        assert first == replace(second, statistics=first.statistics)


def test_many_goals_are_told_where_a_limit_is_met() -> None:
    """In how many ways they may be active, beside the stage that was cut short."""
    names = [f"x{number}" for number in range(9)]
    states = " ".join(f"state {name} can be a, b" for name in names)
    goals = " ".join(f"when {name} is a then goal: {name} is b" for name in names)
    spec = parse(
        f"BEGIN STATE VECTOR {states} END STATE VECTOR BEGIN ACTIONS END ACTIONS "
        f"BEGIN GOALS goal type: constraint {goals} END GOALS"
    )
    assert many_told(spec) == "up to 512 sets of goals may be active"
    told = list[str]()
    synthesize(spec, context=Context(progress=told.append))
    assert "solving each goal in its own region (up to 512 sets of goals may be active)" in told
