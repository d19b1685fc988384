"""Objections, told with the user's own rules and lines."""

import pytest

from tumato_symbolic import parse
from tumato_symbolic.report.objections import Place, broken_here, objection_text, why_no_set
from tumato_symbolic.semantics import objections

TEXT = """\
BEGIN STATE VECTOR
state Door can be open, closed
state Lamp can be on, off
END STATE VECTOR
BEGIN RESOURCES
resource HAND
END RESOURCES
BEGIN ACTIONS
action open_door
controlled resources: HAND
preconditions: Door is closed
nominal effects: Door is open
action close_door
controlled resources: HAND
preconditions: none
nominal effects: Door is closed
alternative effects: none
action unlock
preconditions: none
nominal effects: Door is open
action switch_on
preconditions: none
nominal effects: Lamp is on
END ACTIONS
BEGIN REACTION RULES
rule: IF Door is open THEN NOT executing switch_on
END REACTION RULES
BEGIN STATE RULES
rule: NOT
  (Door is open
   AND Lamp is on)
END STATE RULES
"""
PLACE = Place(parse(TEXT), "door.tum")
CLOSED, OPEN, BAD = (1, 1), (0, 1), (0, 0)
OPEN_DOOR, CLOSE_DOOR, UNLOCK, SWITCH_ON = range(4)


@pytest.mark.parametrize(
    ("state", "actions", "sentence"),
    [
        (OPEN, {OPEN_DOOR}, "open_door has the precondition `Door is closed` (door.tum:11), which does not hold"),
        (CLOSED, {OPEN_DOOR, CLOSE_DOOR}, "open_door and close_door both control HAND"),
        (CLOSED, {CLOSE_DOOR, UNLOCK}, "the nominal effects of close_door and unlock contradict each other"),
        (
            OPEN,
            {SWITCH_ON},
            "the reaction rule `IF Door is open THEN NOT executing switch_on` (door.tum:26) forbids it",
        ),
        (
            CLOSED,
            {UNLOCK, SWITCH_ON},
            "when unlock takes its nominal effect (Door=open), then switch_on takes its nominal effect (Lamp=on),\n"
            "  `NOT (Door is open AND Lamp is on)` (door.tum:29) is broken",
        ),
        (
            BAD,
            {CLOSE_DOOR},
            "when close_door takes an alternative effect (no change; door.tum:17),\n"
            "  `NOT (Door is open AND Lamp is on)` (door.tum:29) stays broken",
        ),
        (BAD, set(), "`NOT (Door is open AND Lamp is on)` (door.tum:29) stays broken"),
    ],
    ids=["precondition", "resource", "conflict", "reaction", "order", "alternative", "nothing"],
)
def test_an_objection_is_a_sentence(state: tuple[int, int], actions: set[int], sentence: str) -> None:
    """Each kind of objection names the actions, the effects in their order, the rule and its line."""
    found = objections(PLACE.spec, state, frozenset(actions), "any")
    assert objection_text(PLACE, next(found), state) == sentence


def test_the_nearest_sets_come_first() -> None:
    """Where nothing is allowed, the sets whose nominal effects would do lead the list."""
    lines = why_no_set(PLACE, BAD, "any")
    assert lines[0].startswith("{close_door}: when close_door takes an alternative effect")
    assert len(lines) == 3


def test_an_unsafe_state_says_what_it_breaks() -> None:
    """The broken rule with its line; nothing in a safe state."""
    assert broken_here(PLACE, BAD) == "unsafe: it breaks `NOT (Door is open AND Lamp is on)` (door.tum:29)"
    assert broken_here(PLACE, CLOSED) == ""
