"""Ten ways to break the paper's example, as a new user might, and the lines that are to blame."""

from __future__ import annotations

from msgspec import Struct

from tests.repo.documents import ROOT

_AMR = (ROOT / "examples" / "amr.tum").read_text()
_CHARGE = """\
action charge
  duration: 50
  controlled resources: MOTORS
  preconditions: S_Location is charger
  nominal effects: S_Battery is ok
"""


class Variant(Struct, frozen=True):
    """A broken specification: a part of the example, what stands in its place, and a text on the line to be named."""

    name: str
    old: str
    new: str
    blamed: str

    @property
    def text(self) -> str:
        """The broken specification."""
        assert _AMR.count(self.old) == 1, f"{self.name}: the example has changed"
        return _AMR.replace(self.old, self.new)

    @property
    def line(self) -> int:
        """The line that the first screen has to name."""
        lines = self.text.splitlines()
        return next(number for number, line in enumerate(lines, 1) if self.blamed in line)


VARIANTS = (
    Variant(
        "rule_too_strong",
        "rule: IF S_Location is corridor OR S_Location is charger THEN S_Conveyor is off",
        "rule: S_Conveyor is off",
        "rule: S_Conveyor is off",
    ),
    Variant(
        "rule_too_many",
        "END STATE RULES",
        "rule: NOT (S_Location is charger AND S_Battery is low)\nEND STATE RULES",
        "rule: NOT (S_Location is charger",
    ),
    Variant(
        "reaction_rule_too_strong",
        "BEGIN REACTION RULES // Please",
        "BEGIN REACTION RULES\nrule: IF S_Conveyor is on THEN executing charge\n// Please",
        "THEN executing charge",
    ),
    Variant(
        "alternative_too_many",
        "nominal effects: S_Location is charger\n",
        "nominal effects: S_Location is charger\n  alternative effects: S_Conveyor is on\n",
        "alternative effects: S_Conveyor is on",
    ),
    Variant(
        "precondition_too_strong",
        "preconditions: S_Location is charger\n",
        "preconditions: S_Location is charger, S_Conveyor is on\n",
        "preconditions: S_Location is charger, S_Conveyor is on",
    ),
    Variant(
        "assumption_too_strong",
        "BEGIN GOALS",
        "BEGIN ASSUMPTIONS\nassume: NOT (S_Location is workstation_1 AND S_Conveyor is on)\nEND ASSUMPTIONS\n\n"
        "BEGIN GOALS",
        "assume: NOT",
    ),
    Variant("bound_too_short", "max_plan_length: 5", "max_plan_length: 3", "max_plan_length: 3"),
    Variant("missing_action", _CHARGE, "", "goal: S_Battery is ok"),
    Variant(
        "wrong_effect",
        "nominal effects: S_Battery is ok",
        "nominal effects: S_Battery is low",
        "goal: S_Battery is ok",
    ),
    Variant(
        "conflicting_goals",
        "goal type: priority\n",
        "goal type: constraint\ngoal: S_Location is workstation_2\n"
        "when S_Battery is low then goal: S_Location is charger\n",
        "goal: S_Location is charger",
    ),
)
