"""The warning about actions of which one may falsify a precondition of another (`docs/semantics.md`, rule 3.12)."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code
from tumato_symbolic.policy import as_table
from tumato_symbolic.semantics import falsified
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import available_backend, encode
from tumato_symbolic.synthesis import PolicyFormat, Realizable, synthesize
from tumato_symbolic.synthesis.races import _may_race

RACE = """\
BEGIN STATE VECTOR
state Place can be lobby, elevator
state Parcel can be none, aboard
END STATE VECTOR
BEGIN ACTIONS
action drive
preconditions: Place is lobby
nominal effects: Place is elevator
action take
preconditions: Place is lobby, Parcel is none
nominal effects: Parcel is aboard
END ACTIONS
BEGIN GOALS
goal type: priority
when Place is elevator then goal: true
goal: Place is elevator AND Parcel is aboard
END GOALS
"""


def warned(spec: Spec, policy_format: PolicyFormat = "auto") -> list[str]:
    """The messages of the warnings about races."""
    return [each.message for each in synthesize(spec, policy_format=policy_format).warnings if each.code is Code.TUM354]


@pytest.mark.parametrize("policy_format", ["table", "diagram"])
def test_a_policy_with_a_race_is_warned_of(policy_format: PolicyFormat) -> None:
    """With the number of states, and one example: who falsifies what of whom."""
    (message,) = warned(parse(RACE), policy_format)
    assert message.startswith("in 1 state the policy ")
    assert message.endswith(
        "For example in Place=lobby Parcel=none: `drive` (Place=elevator) falsifies `Place is lobby` of `take`"
    )


def test_throughout_there_is_no_race() -> None:
    """The robot takes the parcel first, and drives then; nothing is left to warn of."""
    spec = parse(RACE + "BEGIN CONFIG preconditions: throughout END CONFIG")
    found = synthesize(spec)
    assert isinstance(found, Realizable) and warned(spec) == []
    assert found.policy.decide({"Place": "lobby", "Parcel": "none"}) == ("take",)
    assert found.policy.decide({"Place": "lobby", "Parcel": "aboard"}) == ("drive",)


@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_races_are_counted(profile: str) -> None:
    """The states are those in which, by the explicit meaning, one effect falsifies a precondition of another action."""
    for seed in range(25):
        spec = replace(random_spec(seed, ALL_PROFILES[profile]), preconditions="at_start")
        found = synthesize(spec)
        if not isinstance(found, Realizable):
            continue
        table, last = as_table(found.policy, 10_000), replace(spec, preconditions="throughout")
        assert table is not None
        count = sum(1 for s, chosen in table.rows.items() if any(True for _ in falsified(last, s, chosen, "first")))
        told = [each.message for each in found.warnings if each.code is Code.TUM354]
        places = "1 state" if count == 1 else f"{count:,} states"
        assert [message.partition(" the policy ")[0] for message in told] == ([f"in {places}"] if count else [])


def test_actions_that_exclude_each_other_are_not_paired() -> None:
    """Of many actions of one group no two can race, and none is looked at beside another."""
    actions = " ".join(f"action a{n} controlled resources: M nominal effects: X is {n}" for n in range(50))
    text = (
        f"BEGIN STATE VECTOR state X can be 0..49 state Y can be no, yes END STATE VECTOR BEGIN RESOURCES resource M "
        f"END RESOURCES BEGIN ACTIONS {actions} action b preconditions: X is 3 nominal effects: Y is yes END ACTIONS"
    )
    encoding = encode(parse(text), available_backend())
    assert list(_may_race(encoding)) == [(50, number) for number in range(50)]
