"""The remark about a policy that leaves the region of a goal on the way to it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.generate import PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.policy import Policy
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    active_goals,
    all_states,
    is_safe,
    named,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Spec
from tumato_symbolic.synthesis import Realizable, synthesize

EXAMPLES = Path(__file__).parents[2] / "examples"
LEAVING = "in {:,} safe state"


def leaves(spec: Spec, policy: Policy, start: State) -> bool:
    """Whether a run passes a state with other goals before it reaches its own."""
    numbers = {action.name: number for number, action in enumerate(spec.actions)}

    def decision(state: State) -> ActionSet:
        return frozenset(numbers[name] for name in policy.decide(named(spec, state)))

    here, goal = start, residual_goal(spec, start, decision(start))
    while active_goals(spec, here) == goal.bodies:
        here = successor(spec, here, decision(here))
        if reached(spec, goal, here):
            return False
    return True


def remarks(found: Realizable) -> list[str]:
    """What is said of it."""
    return [each.message for each in found.warnings if each.code.name == "TUM356"]


def expected(spec: Spec, found: Realizable) -> list[str]:
    """The beginning of what has to be said, state by state."""
    count = sum(leaves(spec, found.policy, state) for state in all_states(spec) if is_safe(spec, state))
    return [LEAVING.format(count)] * bool(count)


def test_a_half_loaded_robot_is_on_the_way_to_two_loads() -> None:
    """With two loads to take, the way leads through states where one load is to be delivered."""
    spec = parse((EXAMPLES / "amr_two_loads.tum").read_text(encoding="utf-8"))
    found = synthesize(spec)
    assert isinstance(found, Realizable)
    (message,) = remarks(found)
    assert message.startswith(expected(spec, found)[0])
    assert "S_Load_0=free" in message and "passes S_Location=workstation_1 S_Battery=ok S_Load_0=loaded" in message


@pytest.mark.parametrize("name", ["amr", "nested_goals", "brake"])
def test_nothing_is_said_where_runs_stay(name: str) -> None:
    """The paper's robot reaches its goals where they are active."""
    found = synthesize(parse((EXAMPLES / f"{name}.tum").read_text(encoding="utf-8")))
    assert isinstance(found, Realizable) and remarks(found) == []


@pytest.mark.parametrize("seed", [58, 121, 185, *range(12)])
def test_the_states_are_counted(seed: int) -> None:
    """As many states as runs that leave, told one by one."""
    spec = random_spec(700_000 + seed, PROFILES["interacting"])
    found = synthesize(spec, certify=False, diagnose=False)
    if isinstance(found, Realizable):
        said, begins = remarks(found), expected(spec, found)
        assert len(said) == len(begins)
        assert all(message.startswith(begin) for message, begin in zip(said, begins, strict=True))
