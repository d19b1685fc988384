"""Mutations of the conflict in a certificate of unrealizability, as a JSON object."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

from tests.mutants.changes import (
    Document,
    Mutation,
    another_child,
    another_executed,
    doubled,
    dropped,
    in_list,
    near_state,
    other_bodies,
    other_state,
    reason,
    some_reference,
    swapped,
)


def _choice(document: Document, random: Random) -> Document:
    found: Document = random.choice(reason(document)["Choices"])
    return found


def _choice_state(document: Document, random: Random) -> None:
    choice = _choice(document, random)
    choice["State"] = near_state(document, choice["State"], random)


def _options(change: Callable[[list[Any], Random], None]) -> Mutation:
    return lambda document, random: change(_choice(document, random)["Options"], random)


def _option(document: Document, random: Random) -> None:
    """An option leads elsewhere, or has another goal."""
    if options := _choice(document, random)["Options"]:
        option = random.choice(options)
        if random.random() < 0.5:
            option["Successor"] = near_state(document, option["Successor"], random)
        else:
            option["Goal"] = random.randrange(len(reason(document)["Goals"]))


def _cut(document: Document, random: Random) -> Document | None:
    cuts = reason(document)["Cuts"]
    return random.choice(cuts) if cuts else None


def _run(document: Document, random: Random) -> None:
    """The run of a cut: a state less or more, another one, turned."""
    if cut := _cut(document, random):
        run, count = cut["States"], len(reason(document)["Choices"])
        match random.randrange(5) if run else 1:
            case 0:
                dropped(run, random)
            case 1:
                run.insert(random.randrange(len(run) + 1), random.randrange(count))
            case 2:
                run[random.randrange(len(run))] = random.randrange(count)
            case 3:
                run.append(run.pop(0))
            case _:
                run.reverse()


def _end(document: Document, random: Random) -> None:
    """A path ends elsewhere: at a state of its run, near its end, anywhere."""
    if (cut := _cut(document, random)) and "End" in cut and cut["States"]:
        on_the_way = reason(document)["Choices"][random.choice(cut["States"])]["State"]
        cut["End"] = random.choice(
            (on_the_way, near_state(document, cut["End"], random), other_state(document, random))
        )


def _kind(document: Document, random: Random) -> None:
    """A loop becomes a path, or the other way round; outcomes become one of them."""
    if cut := _cut(document, random):
        if cut["Kind"] == "outcomes":
            cut["Goal"] = 0
        if cut["Kind"] == "path":
            cut["Kind"] = "loop"
            del cut["End"]
        else:
            state = random.choice(reason(document)["Choices"])["State"]
            cut.update(Kind="path", End=random.choice((state, other_state(document, random))))


def _goal_of_a_cut(document: Document, random: Random) -> None:
    if (cut := _cut(document, random)) and "Goal" in cut:
        cut["Goal"] = random.randrange(len(reason(document)["Goals"]))


def _path_cut_short(document: Document, random: Random) -> None:
    """A path ends one state earlier, at its last state."""
    paths = [cut for cut in reason(document)["Cuts"] if cut["Kind"] == "path" and len(cut["States"]) > 1]
    if paths:
        cut = random.choice(paths)
        cut["End"] = reason(document)["Choices"][cut["States"].pop()]["State"]


def _distance(document: Document, random: Random) -> None:
    """A distance is one more or one less, or infinite."""
    leaves = reason(document)["Leaves"]
    place = random.randrange(len(leaves))
    leaf = leaves[place] or 0
    leaves[place] = random.choice((leaf + 1, max(0, leaf - 1), None))


def _distances_stretched(document: Document, random: Random) -> None:
    leaves, more = reason(document)["Leaves"], random.choice((1, 2))
    leaves[:] = [leaf and leaf + more for leaf in leaves]


def _root(document: Document, random: Random) -> None:
    """A goal has the root of another one, or any."""
    goals = reason(document)["Goals"]
    other = random.choice(goals)["Root"] if random.random() < 0.6 else some_reference(reason(document), random)
    random.choice(goals)["Root"] = other


def _roots_swapped(document: Document, random: Random) -> None:
    goals = reason(document)["Goals"]
    one, other = random.choice(goals), random.choice(goals)
    one["Root"], other["Root"] = other["Root"], one["Root"]


def _starts(document: Document, random: Random) -> None:
    starts, count = reason(document)["Starts"], len(reason(document)["Choices"])
    if starts and random.random() < 0.5:
        starts.pop(random.randrange(len(starts)))
    else:
        starts.append(random.randrange(count))


def _outcomes(document: Document, random: Random) -> None:
    """What an option may lead to as well: a state less or more, another one; of all options, nothing."""
    choice = _choice(document, random)
    if not choice["Options"]:
        return
    if "Outcomes" in choice and random.random() < 0.2:
        del choice["Outcomes"]
        return
    led = random.choice(choice.setdefault("Outcomes", [[] for _ in choice["Options"]]))
    if led and random.random() < 0.5:
        dropped(led, random)
    else:
        led.append(random.choice((random.choice(reason(document)["Choices"])["State"], other_state(document, random))))


def _back(document: Document, random: Random) -> None:
    """Outcomes lead back elsewhere; or a loop becomes one of outcomes."""
    if (cut := _cut(document, random)) and cut["Kind"] != "path":
        cut["Kind"], cut["Back"] = "outcomes", random.randrange(len(cut["States"]) + 1)
        cut.pop("Goal", None)


CONFLICT: dict[str, Mutation] = {
    "the starts": _starts,
    "another state": _choice_state,
    "an option dropped": _options(dropped),
    "an option twice": _options(doubled),
    "an option changed": _option,
    "two choices swapped": in_list("Choices", swapped),
    "a cut dropped": in_list("Cuts", dropped),
    "a cut twice": in_list("Cuts", doubled),
    "the run of a cut": _run,
    "the end of a path": _end,
    "a path cut short": _path_cut_short,
    "the kind of a cut": _kind,
    "the goal of a cut": _goal_of_a_cut,
    "outcomes": _outcomes,
    "the way back": _back,
    "a distance": _distance,
    "distances stretched": _distances_stretched,
    "a node's child": another_child,
    "a root": _root,
    "two roots swapped": _roots_swapped,
    "`Executed`": another_executed,
    "the bodies of a goal": other_bodies,
}
