"""Specifications and policies that the tests of the command line share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.explain.variants import VARIANTS
from tests.repo.documents import ROOT

AMR = ROOT / "examples" / "amr.tum"
TWO_ROBOTS = ROOT / "examples" / "two_robots.tum"
AMR_POLICY = ROOT / "proofs" / "amr.policy.json"
TWO_ROBOTS_CERTIFICATE = ROOT / "proofs" / "two_robots.unrealizable.json"

TYPO = """\
BEGIN STATE VECTOR
state S_Battery can be low, ok
state S_Door can be open, closed
END STATE VECTOR
BEGIN ACTIONS
action charge
preconditions: S_Batery is low
nominal effects: S_Battery is okay
END ACTIONS
BEGIN GOALS
goal type: priority
goal: S_Battery is ok
END GOALS
"""
"""Two mistakes: a variable and a value that do not exist."""

WARNED = """\
BEGIN STATE VECTOR
state S_Battery can be low, ok
END STATE VECTOR
BEGIN RESOURCES
resource PLUG
END RESOURCES
BEGIN ACTIONS
action charge
preconditions: none
nominal effects: S_Battery is ok
END ACTIONS
BEGIN GOALS
goal type: priority
goal: S_Battery is ok
END GOALS
"""
"""Realizable, with a resource that nothing uses."""

NO_PLAN = WARNED.replace("resource PLUG\n", "").replace("preconditions: none", "preconditions: S_Battery is ok")
"""No action leads out of a low battery."""

CONFLICT = """\
BEGIN STATE VECTOR
state S_Place can be left, middle, right
END STATE VECTOR
BEGIN RESOURCES
resource MOTORS
END RESOURCES
BEGIN ACTIONS
action to_left
controlled resources: MOTORS
preconditions: S_Place is middle
nominal effects: S_Place is left
action to_right
controlled resources: MOTORS
preconditions: S_Place is middle
nominal effects: S_Place is right
action to_middle
controlled resources: MOTORS
preconditions: NOT S_Place is middle
nominal effects: S_Place is middle
END ACTIONS
BEGIN GOALS
goal type: priority
when S_Place is left then goal: S_Place is right
when S_Place is right then goal: S_Place is left
END GOALS
BEGIN CONFIG
max_plan_length: 2
END CONFIG
"""
"""From the left through the middle to the right, and back: the middle cannot decide for both."""


def changed_policy(where: dict[str, str], actions: list[str]) -> dict[str, Any]:
    """The AMR's policy with other actions in one state, and without our own sections: a stranger's policy."""
    policy: dict[str, Any] = json.loads(AMR_POLICY.read_text())
    row = next(row for row in policy["Policy"] if all(row[name] == value for name, value in where.items()))
    row["Actions"] = actions
    kept = ("PolicyFrameworkVersion", "Type", "Actions", "States", "Policy")
    return {name: policy[name] for name in kept}


def holed_certificate() -> dict[str, Any]:
    """The proof that two robots have no policy, without its last cube."""
    certificate: dict[str, Any] = json.loads(TWO_ROBOTS_CERTIFICATE.read_text())
    certificate["Reason"]["Cubes"].pop()
    return certificate


def state(place: str, battery: str, load: str, conveyor: str) -> dict[str, str]:
    """A state of the AMR."""
    return {"S_Location": place, "S_Battery": battery, "S_Load": load, "S_Conveyor": conveyor}


def write_inputs(folder: Path) -> None:
    """Lay out everything that golden commands read."""
    (folder / "amr.tum").write_text(AMR.read_text())
    (folder / "two_robots.tum").write_text(TWO_ROBOTS.read_text())
    (folder / "amr.json").write_text(AMR_POLICY.read_text())
    (folder / "holed.unrealizable.json").write_text(json.dumps(holed_certificate()))
    for name, text in (("typo", TYPO), ("warned", WARNED), ("no_plan", NO_PLAN), ("conflict", CONFLICT)):
        (folder / f"{name}.tum").write_text(text)
    for variant in VARIANTS:
        (folder / f"{variant.name}.tum").write_text(variant.text)
    (folder / "grid5.tum").write_text((ROOT / "examples" / "grid5.tum").read_text())
    for name, where, actions in (
        ("slower", state("corridor", "ok", "loaded", "on"), ["move_to_workstation_2"]),
        ("unsafe", state("workstation_2", "ok", "free", "on"), ["move_to_corridor", "stop_conveyor"]),
        ("lazy", state("corridor", "ok", "free", "off"), []),
    ):
        (folder / f"{name}.json").write_text(json.dumps(changed_policy(where, actions)))
