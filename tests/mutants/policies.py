"""Mutations of a policy file, as a JSON object: its decisions, its diagram, its certificate."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

Document = dict[str, Any]
Mutation = Callable[[Document, Random], None]
"""Changes a document in place; where it finds nothing to change, it leaves it as it is."""


def _any_actions(document: Document, random: Random) -> list[str]:
    return random.sample(document["Actions"], random.randint(0, min(3, len(document["Actions"]))))


def _decision(document: Document, random: Random) -> None:
    """A decision becomes any set of actions."""
    random.choice(document["Policy"])["Actions"] = _any_actions(document, random)


def _borrowed(document: Document, random: Random) -> None:
    """A decision becomes that of another state: often a sensible one."""
    row, other = random.choice(document["Policy"]), random.choice(document["Policy"])
    row["Actions"] = list(other["Actions"])


def _one_action(document: Document, random: Random) -> None:
    """One action is added to a decision or taken from it."""
    actions = random.choice(document["Policy"])["Actions"]
    action = random.choice(document["Actions"])
    if action in actions:
        actions.remove(action)
    else:
        actions.append(action)


def _swapped(document: Document, random: Random) -> None:
    one, other = random.choice(document["Policy"]), random.choice(document["Policy"])
    one["Actions"], other["Actions"] = other["Actions"], one["Actions"]


def _dropped_row(document: Document, random: Random) -> None:
    document["Policy"].pop(random.randrange(len(document["Policy"])))


def _doubled_row(document: Document, random: Random) -> None:
    """A row twice, which says nothing new, or with another decision, which contradicts it."""
    row = dict(random.choice(document["Policy"]))
    if random.random() < 0.3:
        row["Actions"] = _any_actions(document, random)
    document["Policy"].insert(random.randrange(len(document["Policy"]) + 1), row)


def _shuffled_rows(document: Document, random: Random) -> None:
    random.shuffle(document["Policy"])
    random.shuffle(document["Actions"])
    for row in document["Policy"]:
        random.shuffle(row["Actions"])


def _ordering(document: Document, random: Random) -> None:
    """The recorded effect ordering is another one, or is missing."""
    document.pop("EffectOrdering", None)
    if random.random() < 0.7:
        document["EffectOrdering"] = random.choice(("any", "first"))


TABLE: dict[str, Mutation] = {
    "a decision changed": _decision,
    "a decision borrowed": _borrowed,
    "an action more or less": _one_action,
    "two decisions swapped": _swapped,
    "a row dropped": _dropped_row,
    "a row doubled": _doubled_row,
    "rows reordered": _shuffled_rows,
    "another ordering": _ordering,
}


def _reference(section: Document, random: Random, below: int | None = None) -> int:
    return random.randrange(len(section["Leaves"]) + (len(section["Nodes"]) if below is None else below))


def _child(section: Document, random: Random) -> None:
    """An edge of a node leads elsewhere, where the order of levels allows it; else to a leaf."""
    if not section["Nodes"]:
        return
    number = random.randrange(len(section["Nodes"]))
    level, below = section["Nodes"][number]
    target, base = _reference(section, random, number), len(section["Leaves"])
    if target >= base and section["Nodes"][target - base][0] <= level:
        target = random.randrange(base)
    below[random.randrange(len(below))] = target


def _decision_child(document: Document, random: Random) -> None:
    _child(document["Diagram"], random)


def _decision_root(document: Document, random: Random) -> None:
    diagram = document["Diagram"]
    diagram["Roots"][random.choice(document["Actions"])] = _reference(diagram, random)


def _swapped_roots(document: Document, random: Random) -> None:
    roots = document["Diagram"]["Roots"]
    one, other = random.choice(document["Actions"]), random.choice(document["Actions"])
    roots[one], roots[other] = roots[other], roots[one]


def _defined(document: Document, random: Random) -> None:
    document["Diagram"]["Defined"] = _reference(document["Diagram"], random)


def _everywhere(document: Document, random: Random) -> None:
    """Also states that are not valid are decided, somehow."""
    document["Diagram"]["Defined"] = document["Diagram"]["Leaves"].index(True)


DIAGRAM: dict[str, Mutation] = {
    "a node's child": _decision_child,
    "a root": _decision_root,
    "two roots swapped": _swapped_roots,
    "what is decided": _defined,
    "all states decided": _everywhere,
    "another ordering": _ordering,
}


def _rank(document: Document, random: Random) -> None:
    """One number becomes another one, wherever it stands."""
    leaves = document["Certificate"]["Leaves"]
    place = random.randrange(len(leaves))
    leaves[place] = random.choice((None, 0, 1, 2, 3, 7, (leaves[place] or 0) + 1))


def _ranks_swapped(document: Document, random: Random) -> None:
    leaves = document["Certificate"]["Leaves"]
    one, other = random.randrange(len(leaves)), random.randrange(len(leaves))
    leaves[one], leaves[other] = leaves[other], leaves[one]


def _ranks_stretched(document: Document, random: Random) -> None:
    """Larger ranks that still decrease: right as long as they stay within the bound."""
    factor = random.choice((2, 3, 10))
    leaves = document["Certificate"]["Leaves"]
    leaves[:] = [rank and rank * factor for rank in leaves]


def _rank_child(document: Document, random: Random) -> None:
    _child(document["Certificate"], random)


def _goal(document: Document, random: Random) -> Document:
    goals = document["Certificate"]["Goals"]
    if not goals:
        goals.append({"Bodies": [], "Executed": [], "Root": 0})
    found: Document = random.choice(goals)
    return found


def _rank_root(document: Document, random: Random) -> None:
    _goal(document, random)["Root"] = _reference(document["Certificate"], random)


def _roots_of_goals_swapped(document: Document, random: Random) -> None:
    one, other = _goal(document, random), _goal(document, random)
    one["Root"], other["Root"] = other["Root"], one["Root"]


def _goal_dropped(document: Document, random: Random) -> None:
    goal = _goal(document, random)
    document["Certificate"]["Goals"].remove(goal)


def _goal_doubled(document: Document, random: Random) -> None:
    goal = dict(_goal(document, random))
    if random.random() < 0.5:
        goal["Root"] = _reference(document["Certificate"], random)
    document["Certificate"]["Goals"].append(goal)


def _bodies(document: Document, random: Random) -> None:
    goal, known = _goal(document, random), document["Certificate"]["Goals"]
    goal["Bodies"] = random.choice((goal["Bodies"][1:], ["true"], random.choice(known)["Bodies"]))


def _executed(document: Document, random: Random) -> None:
    """An action more or less that the goal was executed with."""
    goal, action = _goal(document, random), random.choice(document["Actions"])
    goal["Executed"] = sorted({*goal["Executed"]} ^ {action})


def _order(document: Document, random: Random) -> None:
    random.shuffle(document["Certificate"]["Order"])


def _digest(document: Document, random: Random) -> None:
    document.pop("SpecificationDigest")
    if random.random() < 0.7:
        document["SpecificationDigest"] = random.choice(("", "sha256:0"))


def _none(document: Document, random: Random) -> None:
    document.pop("Certificate")


CERTIFICATE: dict[str, Mutation] = {
    "a rank": _rank,
    "two ranks swapped": _ranks_swapped,
    "ranks stretched": _ranks_stretched,
    "a node's child in the certificate": _rank_child,
    "a root of a goal": _rank_root,
    "the roots of two goals swapped": _roots_of_goals_swapped,
    "a goal dropped": _goal_dropped,
    "a goal doubled": _goal_doubled,
    "the bodies of a goal": _bodies,
    "`Executed`": _executed,
    "the order of tests": _order,
    "another digest": _digest,
    "no certificate": _none,
}
