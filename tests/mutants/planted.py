"""Bugs to plant in the engine, one at a time: each makes some policy come out wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.game import evaluation, fixpoints, routing
from tumato_symbolic.policy import Policy
from tumato_symbolic.spec import GoalList, Spec
from tumato_symbolic.symbolic import extract, goals, steps
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.synthesis import restoring

EXAMPLES = Path(__file__).parents[2] / "examples"

PLACES = """\
BEGIN STATE VECTOR
  state S_Place can be kitchen, hall, office, lab
END STATE VECTOR
BEGIN RESOURCES
  resource WHEELS
END RESOURCES
BEGIN ACTIONS
  action to_kitchen  controlled resources: WHEELS  nominal effects: S_Place is kitchen
  action to_hall     controlled resources: WHEELS  nominal effects: S_Place is hall
  action to_office   controlled resources: WHEELS  nominal effects: S_Place is office
  action to_lab      controlled resources: WHEELS  nominal effects: S_Place is lab
END ACTIONS
BEGIN GOALS
  goal type: priority
  goal: S_Place is lab
END GOALS
"""
"""A robot that goes anywhere in one step."""


class Bug(Struct, frozen=True):
    """A bug, and a specification whose policy it spoils."""

    name: str
    text: str
    plant: Callable[[pytest.MonkeyPatch], None]

    @property
    def spec(self) -> Spec:
        """The specification."""
        return parse(self.text)

    def spoilt(self) -> Policy:
        """The policy that the engine makes with this bug."""
        with pytest.MonkeyPatch.context() as planted:
            self.plant(planted)
            outcome = synthesize(self.spec)
        assert isinstance(outcome, Realizable)
        return outcome.policy


def example(name: str) -> str:
    """The text of an example."""
    return (EXAMPLES / f"{name}.tum").read_text(encoding="utf-8")


def _predecessor(patch: pytest.MonkeyPatch) -> None:
    """What a nominal effect writes into a variable of several bits is traced back with one of them flipped."""
    write = Encoding.assignment_bits

    def flipped(encoding: Encoding, effect: Any) -> Mapping[str, bool]:
        bits = write(encoding, effect)
        return bits if len(bits) < 2 else {**bits, (last := list(bits)[-1]): not bits[last]}

    def mistaken(function: Callable[..., Any]) -> Callable[..., Any]:
        def run(*arguments: Any) -> Any:
            with pytest.MonkeyPatch.context() as inside:
                inside.setattr(Encoding, "assignment_bits", flipped)
                return function(*arguments)

        return run

    preimage = fixpoints.preimage
    patch.setattr(Encoding, "before", mistaken(Encoding.before))
    patch.setattr(Encoding, "next_state", mistaken(Encoding.next_state))
    patch.setattr(fixpoints.ClosedLoop, "predecessor", mistaken(fixpoints.ClosedLoop.predecessor))
    for room in (routing, evaluation):
        patch.setattr(room, "preimage", lambda *given: mistaken(mistaken(preimage)(*given)))


def _order_of_effects(patch: pytest.MonkeyPatch) -> None:
    """Only the first effect is looked at, whatever happens after it."""
    patch.setattr(steps, "_always_safe", lambda _, safe: safe)


def _restoring_choice(patch: pytest.MonkeyPatch) -> None:
    """Any serving set is taken for the cheapest."""
    patch.setattr(restoring, "lasting", lambda encoding, _: encoding.manager.true)


def _goal_activation(patch: pytest.MonkeyPatch) -> None:
    """In a priority list the last goal comes first."""
    walk = goals._walk

    def backwards(encoding: Any, goal: Any, here: Any, idle: Any) -> Any:
        if isinstance(goal, GoalList) and goal.kind == "priority":
            goal = replace(goal, members=goal.members[::-1])
        return walk(encoding, goal, here, idle)

    patch.setattr(goals, "_walk", backwards)


def _extraction(patch: pytest.MonkeyPatch) -> None:
    """The values of a variable are written in the reverse order."""
    by_value = extract.Extractor._by_value

    def reversed_(self: Any, states: Any, level: int) -> Iterator[tuple[Any, int]]:
        return reversed(list(by_value(self, states, level)))

    patch.setattr(extract.Extractor, "_by_value", reversed_)


BUGS = (
    Bug("predecessor", PLACES, _predecessor),
    Bug("order of effects", example("concurrent"), _order_of_effects),
    Bug("restoring choice", example("amr"), _restoring_choice),
    Bug("goal activation", example("amr"), _goal_activation),
    Bug("extraction", example("amr"), _extraction),
)
