"""Mutations of a certificate that no part with all starts has a policy, as a JSON object."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

from tests.mutants.changes import (
    Document,
    Mutation,
    another_child,
    another_executed,
    another_state,
    doubled,
    dropped,
    in_list,
    near_state,
    other_bodies,
    reason,
    some_reference,
    swapped,
)
from tests.mutants.conflicts import CONFLICT


def _in_some(sections: Callable[[Document], list[Document]], change: Mutation) -> Mutation:
    """The change of one of some sections of an argument, as if that were the reason."""

    def mutate(document: Document, random: Random) -> None:
        if found := [section for part in reason(document)["Parts"] for section in sections(part)]:
            change({**document, "Reason": random.choice(found)}, random)

    return mutate


def _itself(part: Document) -> list[Document]:
    return [part]


def _beginning(part: Document) -> list[Document]:
    return [part] if "State" in part else []


def _removals(part: Document) -> list[Document]:
    return list(part["Removals"])


def _conflicts(part: Document) -> list[Document]:
    return [part["Conflict"]] if "Conflict" in part else []


def _cases(part: Document) -> list[Document]:
    return list(part.get("Cases", ()))


def _root(document: Document, random: Random) -> None:
    reason(document)["Root"] = some_reference(reason(document), random)


def _root_of_a_goal(document: Document, random: Random) -> None:
    if goals := reason(document)["Goals"]:
        random.choice(goals)["Root"] = some_reference(reason(document), random)


def _leaf(document: Document, random: Random) -> None:
    """A distance is one more or one less, or infinite."""
    leaves: list[Any] = reason(document)["Leaves"]
    place = random.randrange(len(leaves))
    leaf = leaves[place] or 0
    leaves[place] = random.choice((leaf + 1, max(0, leaf - 1), None))


def _stretched(document: Document, _: Random) -> None:
    leaves: list[Any] = reason(document)["Leaves"]
    leaves[:] = [leaf and leaf + 1 for leaf in leaves]


def _kind(document: Document, random: Random) -> None:
    reason(document)["Kind"] = random.choice(("no-restoration", "no-plan"))


def _without(document: Document, random: Random) -> None:
    reason(document)["Without"] = near_state(document, reason(document)["Without"], random)


def _argument(document: Document, random: Random) -> None:
    """A case is said to be another part."""
    reason(document)["Part"] = random.randrange(5)


def _last_removal_dropped(document: Document, _: Random) -> None:
    del reason(document)["Removals"][-1:]


def _first_removal_dropped(document: Document, _: Random) -> None:
    del reason(document)["Removals"][:1]


def _ended(document: Document, random: Random) -> None:
    """A conflict gives way to a state of it that is said to be removed."""
    part = reason(document)
    if "Conflict" in part:
        conflict = part.pop("Conflict")
        del part["Cases"]
        part["Kind"], part["State"] = "start", random.choice(conflict["Choices"])["State"]


REMOVALS: dict[str, Mutation] = {
    "another state": _in_some(_beginning, another_state),
    "a removal dropped": _in_some(_itself, in_list("Removals", dropped)),
    "the first removal dropped": _in_some(_itself, _first_removal_dropped),
    "the last removal dropped": _in_some(_itself, _last_removal_dropped),
    "a removal twice": _in_some(_itself, in_list("Removals", doubled)),
    "two removals swapped": _in_some(_itself, in_list("Removals", swapped)),
    "no conflict": _in_some(_itself, _ended),
    "a case dropped": _in_some(lambda part: [part] if "Cases" in part else [], in_list("Cases", dropped)),
    "a case of another state": _in_some(_cases, _without),
    "a case of another part": _in_some(_cases, _argument),
    "a part dropped": in_list("Parts", dropped),
    "a part twice": in_list("Parts", doubled),
    "two parts swapped": in_list("Parts", swapped),
    "the root": _in_some(_removals, _root),
    "the root of a goal": _in_some(_removals, _root_of_a_goal),
    "a leaf": _in_some(_removals, _leaf),
    "distances stretched": _in_some(_removals, _stretched),
    "the kind of a removal": _in_some(_removals, _kind),
    "a node's child": _in_some(_removals, another_child),
    "a goal dropped": _in_some(_removals, in_list("Goals", dropped)),
    "`Executed`": _in_some(_removals, another_executed),
    "the bodies of a goal": _in_some(_removals, other_bodies),
    **{f"in a conflict: {name}": _in_some(_conflicts, change) for name, change in CONFLICT.items()},
}
