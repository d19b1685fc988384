"""What would restore the states that one step does not restore: settings, and joint actions that were tried."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tumato_symbolic.report.layout import count, enumeration
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import in_json
from tumato_symbolic.spec import value_of

if TYPE_CHECKING:
    from tumato_symbolic.synthesis.diagnosis import Cured, JointAction, Restorability


def restorable_lines(place: Place, found: Restorability) -> Iterator[str]:
    """The diagnosis for a person: what each setting would do, with the line to add, and each joint action."""
    whole = sum(each.count for each in found.cured)
    yield f"What would restore {'this state' if whole == 1 else f'these {whole:,} states'}:"
    for each in found.cured:
        yield f"  {_cured(place, each, whole)}"
    for joint in found.joint:
        yield f"  {_joint(place, joint, whole)}"


def _cured(place: Place, cured: Cured, whole: int) -> str:
    of = "it" if whole == 1 else "all of them" if cured.count == whole else f"{cured.count:,} of them"
    if cured.count < whole:
        of += f", such as {place.state(cured.example)}"
    match cured.cure:
        case "bounded" if cured.worst is not None and cured.most_steps is not None:
            limit = f"{_aim(place)}in at most {count(cured.most_steps, 'step')} (duration {cured.worst[0]} at most)"
            return f"`restoration: bounded` in CONFIG: {of}, {limit}, whatever happens"
        case "fair":
            return f"`restoration: fair` in CONFIG: {of}, if nominal effects occur often enough"
        case _:
            return f"for {of}, no setting: no sequence of actions leads {_lost(place)}"


def _aim(place: Place) -> str:
    """What restoring comes to first, where rules have severities; else nothing, for it is safety."""
    return "to a higher level " if len(place.spec.tiers) > 1 else ""


def _lost(place: Place) -> str:
    if len(place.spec.tiers) > 1:
        return "to a higher level without breaking another rule that has to be kept"
    return "back to safety without breaking another rule"


def _joint(place: Place, joint: JointAction, whole: int) -> str:
    variables = place.spec.variables
    effects = enumeration([f"{variables[v].name} is {variables[v].values[value]}" for v, value in joint.effects])
    restored = "it" if whole == 1 else f"{whole - joint.left:,} of them"
    return f"one action with the effects {effects} (tried): {restored}, {_aim(place)}in one step"


def restorable_json(place: Place, found: Restorability | None) -> dict[str, object]:
    """The same for a program; nothing where there is no diagnosis."""
    if found is None:
        return {}
    variables = place.spec.variables
    cured: dict[str, object] = {
        each.cure: {
            "count": each.count,
            "example": in_json(place.spec, each.example),
            "efforts": [{"duration": d, "steps": steps, "states": n} for (d, steps), n in each.efforts],
        }
        for each in found.cured
    }
    joint = [
        {
            "effects": {variables[v].name: value_of(variables[v].values[value]) for v, value in each.effects},
            "left": each.left,
        }
        for each in found.joint
    ]
    return {"restorable": {**cured, "joint_actions": joint}}
