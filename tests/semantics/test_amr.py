"""Checked facts of the paper's example (`docs/semantics.md`)."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.oracle import World, decide_world
from tests.reference_policy import reference_policy
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    action_names,
    all_states,
    allowed,
    allowed_sets,
    is_safe,
    is_valid,
    judge,
    named,
    objections,
)
from tumato_symbolic.spec import Ordering, Spec, load

AMR = Path(__file__).parents[2] / "examples" / "amr.tum"
BOTH: tuple[Ordering, ...] = ("any", "first")


@pytest.fixture(scope="module")
def amr() -> Spec:
    """The specification printed in the paper's appendix."""
    spec = load(Source(AMR.name, AMR.read_text(encoding="utf-8"))).spec
    assert spec is not None
    return spec


def state(spec: Spec, *values: str) -> State:
    """A state by its values, in the order of declaration."""
    return next(state for state in all_states(spec) if tuple(named(spec, state).values()) == values)


def actions(spec: Spec, *names: str) -> ActionSet:
    """A set of actions by their names."""
    return frozenset(number for number, action in enumerate(spec.actions) if action.name in names)


def test_the_amr_has_32_states_of_which_24_are_safe(amr: Spec) -> None:
    """All 32 are valid, 8 of them unsafe."""
    states = list(all_states(amr))
    assert len(states) == 32
    assert all(is_valid(amr, state) for state in states)
    assert sum(is_safe(amr, state) for state in states) == 24


@pytest.mark.parametrize("ordering", BOTH)
def test_moving_to_the_charger_with_the_conveyor_on_restores_nothing(amr: Spec, ordering: Ordering) -> None:
    """The rule covers the charger too: stopping the conveyor, moving to workstation 2, or both are the allowed sets."""
    here = state(amr, "corridor", "low", "free", "on")
    found = [set(action_names(amr, chosen)) for chosen in allowed_sets(amr, here, ordering)]
    assert found == [{"move_to_workstation_2"}, {"stop_conveyor"}, {"move_to_workstation_2", "stop_conveyor"}]
    (objection, *_) = objections(amr, here, actions(amr, "move_to_charger"), ordering)
    assert (objection.kind, objection.rule) == ("unsafe", amr.state_rules[0])
    assert objection.state == state(amr, "charger", "low", "free", "on")


@pytest.mark.parametrize("ordering", BOTH)
def test_the_amr_is_realizable_and_its_longest_run_has_four_steps(amr: Spec, ordering: Ordering) -> None:
    """The oracle finds a policy in the goals' own regions; the preferred one is sound, complete and minimal."""
    world = World(amr, ordering)
    verdict = decide_world(world)
    policy = reference_policy(world)
    assert (verdict.kind, verdict.own_region) == ("realizable", True)
    assert policy is not None
    judgement = judge(amr, policy, ordering)
    assert judgement.sound_and_complete
    assert judgement.minimal
    assert judgement.longest_run == 4


def test_a_dear_restoration_is_allowed_but_not_minimal(amr: Spec) -> None:
    """In (corridor, ok, loaded, on) moving costs 10 where stopping the conveyor costs 1."""
    here = state(amr, "corridor", "ok", "loaded", "on")
    policy = reference_policy(World(amr, "any"))
    assert policy is not None
    assert policy[here] == actions(amr, "stop_conveyor")
    dear = {**policy, here: actions(amr, "move_to_workstation_2")}
    assert allowed(amr, here, dear[here], "any")
    judgement = judge(amr, dear, "any")
    assert judgement.sound_and_complete
    assert judgement.not_minimal == ((here, actions(amr, "stop_conveyor")),)
