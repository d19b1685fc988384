"""Robots whose first draft has no policy, and for which bad advice gives up safety."""

from __future__ import annotations

from pathlib import Path

NEAR = """\
BEGIN STATE VECTOR
state B can be critical, ok
state L can be off, on
END STATE VECTOR
BEGIN ACTIONS
action lights_on
nominal effects: L is on
action lights_off
nominal effects: L is off
END ACTIONS
BEGIN STATE RULES
rule: NOT B is critical
END STATE RULES
BEGIN GOALS
goal type: priority
goal: true
END GOALS
"""
TAUT = """\
BEGIN STATE VECTOR
state P can be in, out
state B can be low, ok
END STATE VECTOR
BEGIN ACTIONS
action leave
preconditions: P is in
nominal effects: P is out
alternative effects: none
action enter
preconditions: P is out
nominal effects: P is in
END ACTIONS
BEGIN STATE RULES
rule: IF B is low THEN NOT P is in
END STATE RULES
BEGIN GOALS
goal type: priority
goal: P is out
END GOALS
"""
BRAKE = """\
BEGIN STATE VECTOR
state Human can be away, here
state Speed can be stopped, slow, fast
END STATE VECTOR
BEGIN ACTIONS
action brake1
preconditions: Speed is fast
nominal effects: Speed is slow
action brake2
preconditions: Speed is slow
nominal effects: Speed is stopped
END ACTIONS
BEGIN STATE RULES
rule: IF Human is here THEN Speed is stopped
END STATE RULES
BEGIN GOALS
goal type: priority
goal: true
END GOALS
"""

FORKLIFT = (Path(__file__).parent / "inputs" / "forklift.tum").read_text()


def battery(levels: int) -> str:
    """A robot that drives with one action for each level of its battery, and charges at home."""
    moves = "".join(
        f"""\
action {name}_{level}
controlled resources: MOTORS
preconditions: B is b{level}, P is {here}
nominal effects: B is b{level - 1}, P is {there}
"""
        for level in range(1, levels + 1)
        for name, here, there in (("drive", "home", "away"), ("back", "away", "home"))
    )
    return f"""\
BEGIN STATE VECTOR
state B can be {", ".join(f"b{level}" for level in range(levels + 1))}
state P can be home, away
state J can be todo, done
END STATE VECTOR
BEGIN RESOURCES
resource MOTORS
END RESOURCES
BEGIN ACTIONS
{moves}action charge
controlled resources: MOTORS
preconditions: P is home
nominal effects: B is b{levels}
action do
controlled resources: MOTORS
preconditions: P is away
nominal effects: J is done
END ACTIONS
BEGIN STATE RULES
rule: NOT B is b0
END STATE RULES
BEGIN GOALS
goal type: priority
when J is todo then goal: J is done
goal: P is home
END GOALS
"""


ROBOTS = {"near": NEAR, "taut": TAUT, "brake": BRAKE, "forklift": FORKLIFT, "battery": battery(8)}
