"""Section 8 of docs/semantics.md: the paper's example."""

from pathlib import Path

import pytest

from tests.conformance.asking import Asked, faults, under_both
from tests.conformance.roles import Decider, Judge, Stepper
from tests.conformance.rules import rule
from tests.conformance.world import BOTH, world
from tumato_symbolic.policy import Table, load
from tumato_symbolic.semantics import all_states
from tumato_symbolic.spec import Ordering

ROOT = Path(__file__).parents[2]
AMR = (ROOT / "examples" / "amr.tum").read_text(encoding="utf-8")
RESTORED = ("move_to_workstation_2", "stop_conveyor", "move_to_workstation_2 stop_conveyor")


def published() -> dict[str, str]:
    """The policy of the repository in words."""
    policy = load(str(ROOT / "proofs" / "amr.policy.json"))
    assert isinstance(policy.decisions, Table)
    return world(AMR).decisions(policy.decisions.rows)


@rule("8.1")
def test_all_of_32_states_are_valid_and_24_are_safe(stepper: Stepper) -> None:
    """Which 8 are unsafe: with the conveyor on, in the corridor and at the charger."""
    asked = Asked(stepper, AMR)
    states = [asked.world.words(state) for state in all_states(asked.world.spec)]
    valid = [state for state in states if stepper.valid(asked.world, asked.world.state(state))]
    unsafe = [state for state in states if not stepper.safe(asked.world, asked.world.state(state))]
    assert len(valid) == len(states) == 32
    assert len(unsafe) == 8
    assert all(state.split()[0] in ("corridor", "charger") and state.endswith(" on") for state in unsafe)


@rule("8.1")
@pytest.mark.parametrize("ordering", BOTH)
def test_it_is_realizable_and_the_printed_entries_come_out(decider: Decider, ordering: Ordering) -> None:
    """With a longest run of 4 steps."""
    asked = world(AMR, ordering)
    answer = decider.answer(asked)
    assert answer.policy is not None and answer.longest == 4
    decisions = asked.decisions(answer.policy)
    assert decisions["corridor ok free off"] == "move_to_workstation_1"
    assert decisions["corridor low free off"] == "move_to_charger"
    assert decisions["workstation_2 ok free on"] == "stop_conveyor"
    assert decisions["corridor low free on"] == "stop_conveyor"
    assert len(decisions) == 32


@rule("8.1")
def test_the_policy_is_right_with_a_bound_of_4_and_not_with_one_of_3(judge: Judge) -> None:
    """The printed bound is 5."""
    assert "max_plan_length: 5" in AMR
    for bound, found in ((5, set()), (4, set()), (3, {"goals"})):
        text = AMR.replace("max_plan_length: 5", f"max_plan_length: {bound}")
        assert faults(judge, text, published()) == found


@rule("8.2")
def test_three_sets_restore_safety_and_going_to_the_charger_does_not(stepper: Stepper) -> None:
    """The rule covers the charger as well."""
    for asked in under_both(stepper, AMR):
        here = "corridor low free on"
        for chosen in RESTORED:
            assert asked.allows(here, chosen)
        for chosen in ("", "move_to_charger", "move_to_charger stop_conveyor", "move_to_workstation_1"):
            assert not asked.allows(here, chosen)


@rule("8.2")
def test_stopping_the_conveyor_is_the_minimum(judge: Judge) -> None:
    """It takes 1, where moving takes 10 and both together 11."""
    for chosen in RESTORED:
        found = faults(judge, AMR, {**published(), "corridor low free on": chosen})
        assert ("minimal" in found) is (chosen != "stop_conveyor"), chosen
