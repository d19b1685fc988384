"""What mutations of a certificate of unrealizability have in common, and those that fit several kinds."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from random import Random
from typing import Any

Document = dict[str, Any]
Mutation = Callable[[Document, Random], None]
"""Changes a document in place; where it finds nothing to change, it leaves it as it is."""


def reason(document: Document) -> Document:
    """What the certificate says."""
    found: Document = document["Reason"]
    return found


def other_state(document: Document, random: Random) -> Document:
    """Any state."""
    return {name: random.choice([*values]) for name, values in document["States"].items()}


def near_state(document: Document, state: Document, random: Random) -> Document:
    """A state that differs in one variable."""
    name = random.choice([*state])
    return {**state, name: random.choice([*document["States"][name]])}


def some_reference(section: Document, random: Random) -> int:
    """Any node or leaf."""
    return random.randrange(len(section["Leaves"]) + len(section["Nodes"]))


def dropped(entries: list[Any], random: Random) -> None:
    """One entry less."""
    if entries:
        entries.pop(random.randrange(len(entries)))


def doubled(entries: list[Any], random: Random) -> None:
    """One entry twice."""
    if entries:
        entries.insert(random.randrange(len(entries) + 1), deepcopy(random.choice(entries)))


def swapped(entries: list[Any], random: Random) -> None:
    """Two entries change places."""
    if entries:
        one, other = random.randrange(len(entries)), random.randrange(len(entries))
        entries[one], entries[other] = entries[other], entries[one]


def in_list(key: str, change: Callable[[list[Any], Random], None]) -> Mutation:
    """A change of a list of the reason."""
    return lambda document, random: change(reason(document)[key] or [], random)


def another_state(document: Document, random: Random) -> None:
    """It speaks of another state."""
    here = reason(document)["State"]
    other = near_state(document, here, random) if random.random() < 0.5 else other_state(document, random)
    reason(document)["State"] = other


def another_child(document: Document, random: Random) -> None:
    """An edge of a node leads elsewhere, where the order of levels allows it; else to a leaf."""
    section = reason(document)
    if not section["Nodes"]:
        return
    number, base = random.randrange(len(section["Nodes"])), len(section["Leaves"])
    level, below = section["Nodes"][number]
    target = random.randrange(base + number)
    if target >= base and section["Nodes"][target - base][0] <= level:
        target = random.randrange(base)
    below[random.randrange(len(below))] = target


def another_executed(document: Document, random: Random) -> None:
    """A goal was executed with an action more or less."""
    if goals := reason(document)["Goals"]:
        goal, action = random.choice(goals), random.choice(document["Actions"])
        goal["Executed"] = sorted({*goal["Executed"]} ^ {action})


def other_bodies(document: Document, random: Random) -> None:
    """A goal has a body less, or those of another one."""
    if goals := reason(document)["Goals"]:
        goal = random.choice(goals)
        goal["Bodies"] = random.choice((goal["Bodies"][1:], random.choice(goals)["Bodies"]))
