"""Mutations of what a policy says of restoring safety: the section `Restoring`, its header, unsafe decisions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import islice
from random import Random

from tests.mutants.changes import another_child, doubled, dropped, near_state, other_state, some_reference
from tests.mutants.policies import Document, Mutation
from tumato_symbolic.semantics import all_states, allowed_sets, is_safe, is_valid
from tumato_symbolic.spec import Spec


def _in_section(change: Callable[[Document, Document, Random], None]) -> Mutation:
    """A change of the section, where there is one."""

    def mutate(document: Document, random: Random) -> None:
        section = (document.get("Certificate") or {}).get("Restoring")
        if section is not None:
            change(section, document, random)

    return mutate


def _shifted(by: tuple[int, ...]) -> Mutation:
    """One effort more, or less, in one of its numbers, wherever it stands."""

    def shift(section: Document, _: Document, random: Random) -> None:
        leaves = section["Leaves"]
        if places := [place for place, leaf in enumerate(leaves) if leaf is not None]:
            place, number = random.choice(places), random.randrange(2)
            effort = list(leaves[place])
            effort[number] = max(0, effort[number] + random.choice(by))
            if effort not in leaves:
                leaves[place] = effort

    return _in_section(shift)


def _null(section: Document, _: Document, random: Random) -> None:
    """One effort becomes null, wherever it stands."""
    leaves, nodes = section["Leaves"], section["Nodes"]
    place = random.randrange(len(leaves))
    if None not in leaves:
        leaves[place] = None
        return
    null = leaves.index(None)
    for node in nodes:
        node[1] = [null if child == place else child for child in node[1]]
    for name in ("Worst", "Nominal"):
        section[name] = null if section[name] == place else section[name]


def _swapped(section: Document, _: Document, random: Random) -> None:
    leaves = section["Leaves"]
    one, other = random.randrange(len(leaves)), random.randrange(len(leaves))
    leaves[one], leaves[other] = leaves[other], leaves[one]


def _stretched(section: Document, _: Document, random: Random) -> None:
    """Larger efforts that still fall: true, and more than it takes."""
    factor = random.choice((2, 3))
    section["Leaves"] = [leaf and [factor * number for number in leaf] for leaf in section["Leaves"]]


def _child(section: Document, document: Document, random: Random) -> None:
    another_child({**document, "Reason": section}, random)


def _root(section: Document, _: Document, random: Random) -> None:
    section[random.choice(("Worst", "Nominal"))] = some_reference(section, random)


def _swapped_roots(section: Document, _: Document, random: Random) -> None:
    section["Worst"], section["Nominal"] = section["Nominal"], section["Worst"]


def _no_section(_: Document, document: Document, random: Random) -> None:
    del document["Certificate"]["Restoring"]


def _some_deviation(section: Document, document: Document, random: Random) -> Document:
    """One that is listed, or a new one, of any state."""
    if not section["Deviations"]:
        _deviation_added(section, document, random)
    found: Document = random.choice(section["Deviations"])
    return found


def _deviation_added(section: Document, document: Document, random: Random) -> None:
    state = other_state(document, random)
    missed = random.choice((state, near_state(document, state, random), other_state(document, random)))
    better = random.sample(document["Actions"], random.randint(0, min(2, len(document["Actions"]))))
    section["Deviations"].append({"State": state, "Better": better, "Missed": missed})


def _deviation_dropped(section: Document, _: Document, random: Random) -> None:
    dropped(section["Deviations"], random)


def _deviation_doubled(section: Document, _: Document, random: Random) -> None:
    doubled(section["Deviations"], random)


def _another_state(section: Document, document: Document, random: Random) -> None:
    deviation, name = _some_deviation(section, document, random), random.choice(("State", "Missed"))
    deviation[name] = random.choice((near_state(document, deviation[name], random), other_state(document, random)))


def _another_set(section: Document, document: Document, random: Random) -> None:
    deviation = _some_deviation(section, document, random)
    deviation["Better"] = sorted({*deviation["Better"]} ^ {random.choice(document["Actions"])})


def _header(document: Document, random: Random) -> None:
    """The recorded way to restore safety is another one, or is missing, which is `one_step`."""
    document.pop("Restoration", None)
    if random.random() < 0.7:
        document["Restoration"] = random.choice(("bounded", "fair"))


CERTIFICATE: dict[str, Mutation] = {
    "an effort less": _shifted((-1, -1, -2, -9)),
    "an effort more": _shifted((1, 1, 2, 9)),
    "an effort dropped": _in_section(_null),
    "two efforts swapped": _in_section(_swapped),
    "efforts stretched": _in_section(_stretched),
    "a node's child in the efforts": _in_section(_child),
    "a root of the efforts": _in_section(_root),
    "the roots of the efforts swapped": _in_section(_swapped_roots),
    "no section": _in_section(_no_section),
    "a deviation added": _in_section(_deviation_added),
    "a deviation dropped": _in_section(_deviation_dropped),
    "a deviation doubled": _in_section(_deviation_doubled),
    "another state of a deviation": _in_section(_another_state),
    "another set of a deviation": _in_section(_another_set),
    "another header": _header,
}


def unsafe_decision(spec: Spec, most: int = 64) -> Mutation:
    """The decision of an unsafe state, in a table, becomes another set that keeps what has to be kept there."""

    def change(document: Document, random: Random) -> None:
        unsafe = [state for state in all_states(spec) if is_valid(spec, state) and not is_safe(spec, state)]
        random.shuffle(unsafe)
        for state in unsafe:
            sets = [*islice(allowed_sets(spec, state, spec.ordering), most)]
            named = {each.name: each.values[value] for each, value in zip(spec.variables, state, strict=True)}
            for row in _rows(document, named):
                rivals = [names for chosen in sets if (names := _names(spec, chosen)) != sorted(row["Actions"])]
                if rivals:
                    row["Actions"] = random.choice(rivals)
                    return

    return change


def _names(spec: Spec, chosen: frozenset[int]) -> list[str]:
    return sorted(spec.actions[action].name for action in chosen)


def _rows(document: Document, state: dict[str, str]) -> Iterator[Document]:
    return (row for row in document["Policy"] if state.items() <= row.items())
