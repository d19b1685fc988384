"""What is guaranteed, by the walk, is what the explicit meaning says; every shortcoming is one."""

from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.repo.documents import ROOT
from tests.repo.examples import solved
from tests.verify.policies import near_policies
from tumato_symbolic import Realizable
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import (
    ActionSet,
    Guarantee,
    State,
    all_states,
    allowed,
    allowed_sets,
    is_safe,
    is_valid,
    judge,
    shows,
    successor,
)
from tumato_symbolic.semantics import guarantees as by_meaning
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.guarantees.analyse import guarantees
from tumato_symbolic.verify.guarantees.prospects import WalkProspects
from tumato_symbolic.verify.guarantees.result import Level

Rows = dict[State, ActionSet]


def _allowed_policies(spec: Spec, ordering: Ordering, random: Random) -> Iterator[Rows]:
    """Policies that are allowed where they decide, and need not reach their goals."""
    for rows in near_policies(spec, ordering, random):
        yield {
            state: chosen
            for state, chosen in rows.items()
            if is_valid(spec, state) and allowed(spec, state, chosen, ordering)
        }


def _by_walk(spec: Spec, rows: Rows, ordering: Ordering) -> dict[State, Guarantee | None]:
    model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, rows)), ordering)
    goals, found = WalkGoals(model), dict[State, Guarantee | None]()
    for goal, pending in goals.residuals(model.decided, model.policy):
        for guarantee, states in WalkProspects(model, goals, goal).levels(pending):
            inside = [state for state in all_states(spec) if model.holds(states, state, frozenset())]
            assert not found.keys() & set(inside)
            found |= dict.fromkeys(inside, guarantee)
    return found


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_the_walk_says_what_the_meaning_says(profile: str, ordering: Ordering) -> None:
    """State by state, also of policies whose runs miss their goals, and of partial ones."""
    for seed in range(4):
        spec, random = random_spec(seed, PROFILES[profile]), Random(seed)
        for rows in _allowed_policies(spec, ordering, random):
            assert _by_walk(spec, rows, ordering) == by_meaning(spec, rows, ordering)


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_goals_are_met_in_safe_states_only(restoration: Restoration) -> None:
    """Where safety may take several steps to restore, a run may meet unsafe states, and no goal in them."""
    unsafe = 0
    for seed in range(30):
        spec, random = replace(random_spec(seed, PROFILES["restoring"]), restoration=restoration), Random(seed)
        valid = [state for state in all_states(spec) if is_valid(spec, state)]
        options = {state: list(allowed_sets(spec, state, "any")) for state in valid}
        rows = {state: random.choice(sets) for state, sets in options.items() if sets}
        assert _by_walk(spec, rows, "any") == by_meaning(spec, rows, "any")
        after = {successor(spec, state, chosen) for state, chosen in rows.items()}
        unsafe += any(not is_safe(spec, state) for state in after)
    assert unsafe


def _in(spec: Spec, level: Level) -> set[State]:
    assert level.cubes is not None
    return {
        state
        for state in all_states(spec)
        if is_valid(spec, state)
        and any(all(value in values for value, values in zip(state, cube, strict=True)) for cube in level.cubes)
    }


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_levels_of_proved_policies_are_those_of_their_states(ordering: Ordering) -> None:
    """The cubes hold the states of a level, the number counts them, the worst number of steps is met, and why no more
    is replayed.
    """
    met = set()
    for seed in range(40, 60):
        spec, random = random_spec(seed, PROFILES[("restoring", "interacting")[seed % 2]]), Random(seed)
        for rows in near_policies(spec, ordering, random, count=2):
            if not judge(spec, rows, ordering).sound_and_complete:
                continue
            truth = by_meaning(spec, rows, ordering)
            found = guarantees(policy_from_rows(spec, rows), spec, ordering)
            assert found.status == "known"
            assert sum(level.states for level in found.levels) == len(truth)
            for level in found.levels:
                kind, deviations = level.guarantee.kind, level.guarantee.deviations
                known = {state: each for state, each in truth.items() if each is not None}
                alike = {s for s, each in known.items() if (each.kind, each.deviations) == (kind, deviations)}
                assert _in(spec, level) == alike
                assert level.states == len(alike)
                steps = [known[state].steps or 0 for state in alike if kind == "guaranteed"]
                assert level.guarantee.steps == max(steps, default=None)
                if kind == "guaranteed":
                    assert level.shortcoming is None
                else:
                    assert level.shortcoming is not None
                    assert shows(spec, rows, ordering, level.guarantee, level.shortcoming)
                met.add(kind)
    assert met >= {"guaranteed", "fair"}


FACTS = {
    "amr": {("guaranteed", 4, None): 16, ("fair", None, None): 16},
    "coin": {("guaranteed", 2, None): 9},
    "concurrent": {("guaranteed", 3, None): 8},
    "grid3": {("guaranteed", 1, None): 1, ("fair", None, None): 8},
}


@pytest.mark.parametrize("name", FACTS)
def test_facts_of_the_examples(name: str) -> None:
    """The numbers that are stated for the examples."""
    spec, outcome = solved(Path(ROOT / "examples" / f"{name}.tum"))
    assert isinstance(outcome, Realizable)
    found = guarantees(outcome.policy, spec, spec.ordering)
    levels = {(each.guarantee.kind, each.guarantee.steps, each.guarantee.deviations): each for each in found.levels}
    assert {key: level.states for key, level in levels.items()} == FACTS[name]


def test_a_limit_leaves_it_undecided() -> None:
    """Where time is up there is no level, and the reason is the limit."""
    spec, outcome = solved(ROOT / "examples" / "amr.tum")
    assert isinstance(outcome, Realizable)
    found = guarantees(outcome.policy, spec, "any", context=Context(Limits(seconds=0)))
    assert (found.status, found.levels) == ("undecided", ())
    assert found.reason is not None
    assert "time limit" in found.reason
    assert guarantees(outcome.policy, spec, "any", timeout=0.0).status == "undecided"
