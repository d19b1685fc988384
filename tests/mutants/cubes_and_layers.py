"""Mutations of a certificate of unrealizability, as a JSON object, by its kind; here its cubes, layers and traps."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
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
    other_bodies,
    reason,
    some_reference,
)
from tests.mutants.conflicts import CONFLICT
from tests.mutants.removals import REMOVALS


def _ordering(document: Document, random: Random) -> None:
    document["EffectOrdering"] = random.choice(("any", "first"))


ANY: dict[str, Mutation] = {"another ordering": _ordering}


# Cubes.


def _cube(document: Document, random: Random) -> Document | None:
    cubes = reason(document)["Cubes"]
    return random.choice(cubes) if cubes else None


def _settled(document: Document, random: Random) -> None:
    """An action is settled otherwise in a cube."""
    if cube := _cube(document, random):
        action = random.choice(document["Actions"])
        for key in ("Executed", "Idle"):
            cube[key] = [name for name in cube[key] if name != action]
        if home := random.choice(("Executed", "Idle", None)):
            cube[home].append(action)


def _split(document: Document, random: Random) -> None:
    """A cube becomes two: right where the violation does not mind."""
    if cube := _cube(document, random):
        left = [name for name in document["Actions"] if name not in (*cube["Executed"], *cube["Idle"])]
        if left:
            action, other = random.choice(left), deepcopy(cube)
            cube["Executed"].append(action)
            other["Idle"].append(action)
            reason(document)["Cubes"].append(other)


def _merged(document: Document, random: Random) -> None:
    """A settled action is left open, and the cubes that are part of the new one are dropped."""
    if cube := _cube(document, random):
        if not (settled := [*cube["Executed"], *cube["Idle"]]):
            return
        action = random.choice(settled)
        for key in ("Executed", "Idle"):
            cube[key] = [name for name in cube[key] if name != action]
        reason(document)["Cubes"] = [
            other
            for other in reason(document)["Cubes"]
            if other is cube or not all({*cube[key]} <= {*other[key]} for key in ("Executed", "Idle"))
        ]


def _violation(document: Document, random: Random) -> None:
    """Another violation, with what the old one named or some actions."""
    if cube := _cube(document, random):
        kind = random.choice(("precondition", "resource", "nominal-conflict", "idle", "nominal-unsafe"))
        cube["Violation"] = {"Kind": kind}
        if kind in ("precondition", "resource", "nominal-conflict"):
            names = cube["Executed"] if random.random() < 0.7 else document["Actions"]
            cube["Violation"]["Actions"] = random.sample(names, min(len(names), 1 if kind == "precondition" else 2))


def _violations_swapped(document: Document, random: Random) -> None:
    if (one := _cube(document, random)) and (other := _cube(document, random)):
        one["Violation"], other["Violation"] = other["Violation"], one["Violation"]


def _outcome(document: Document, random: Random) -> None:
    """The effects of an outcome: one less, one twice, another order, another value."""
    applied = [cube for cube in reason(document)["Cubes"] or () if cube["Violation"].get("Outcome")]
    if not applied:
        return
    outcome = random.choice(applied)["Violation"]["Outcome"]
    match random.randrange(5):
        case 0:
            dropped(outcome, random)
        case 1:
            doubled(outcome, random)
        case 2:
            outcome.reverse()
        case 3:
            random.choice(outcome)["Action"] = random.choice(document["Actions"])
        case _:
            effect = random.choice(outcome)["Effect"]
            for name in random.sample([*effect], min(1, len(effect))):
                effect[name] = random.choice([*document["States"][name]])


def _no_cubes(document: Document, random: Random) -> None:
    reason(document)["Cubes"] = None
    if random.random() < 0.5:
        another_state(document, random)


CUBES: dict[str, Mutation] = {
    "another state": another_state,
    "a cube dropped": in_list("Cubes", dropped),
    "a cube twice": in_list("Cubes", doubled),
    "an action settled otherwise": _settled,
    "a cube split": _split,
    "a cube merged": _merged,
    "another violation": _violation,
    "two violations swapped": _violations_swapped,
    "an outcome": _outcome,
    "no cubes": _no_cubes,
}


# Layers.


def _layers(change: Callable[[list[Any], Random], None]) -> Mutation:
    def mutate(document: Document, random: Random) -> None:
        if goals := reason(document)["Goals"]:
            change(random.choice(goals)["Layers"], random)

    return mutate


def _neighbours_swapped(layers: list[Any], random: Random) -> None:
    if len(layers) > 1:
        place = random.randrange(len(layers) - 1)
        layers[place : place + 2] = layers[place : place + 2][::-1]


def _last_dropped(layers: list[Any], _: Random) -> None:
    del layers[-1:]


def _first_dropped(layers: list[Any], _: Random) -> None:
    del layers[:1]


def _layer(document: Document, random: Random) -> None:
    """A layer is another set."""
    if goals := reason(document)["Goals"]:
        layers = random.choice(goals)["Layers"]
        if layers:
            layers[random.randrange(len(layers))] = some_reference(reason(document), random)


def _layers_exchanged(document: Document, random: Random) -> None:
    """Two goals exchange their layers."""
    if goals := reason(document)["Goals"]:
        one, other = random.choice(goals), random.choice(goals)
        one["Layers"], other["Layers"] = other["Layers"], one["Layers"]


LAYERS: dict[str, Mutation] = {
    "another state": another_state,
    "a goal dropped": in_list("Goals", dropped),
    "a goal twice": in_list("Goals", doubled),
    "the last layer dropped": _layers(_last_dropped),
    "the first layer dropped": _layers(_first_dropped),
    "a layer dropped": _layers(dropped),
    "a layer twice": _layers(doubled),
    "two layers swapped": _layers(_neighbours_swapped),
    "a layer exchanged": _layer,
    "layers of two goals exchanged": _layers_exchanged,
    "a node's child": another_child,
    "`Executed`": another_executed,
    "the bodies of a goal": other_bodies,
}


# Traps.


def _root(document: Document, random: Random) -> None:
    reason(document)["Root"] = some_reference(reason(document), random)


def _restoration(document: Document, random: Random) -> None:
    """What is recorded, which proves nothing."""
    document["Restoration"] = random.choice(("bounded", "fair"))


TRAP: dict[str, Mutation] = {
    "another state": another_state,
    "the root": _root,
    "a node's child": another_child,
    "another restoration": _restoration,
}


BY_KIND: dict[str, dict[str, Mutation]] = {
    "no-allowed-set": {**ANY, **CUBES},
    "no-restoration": {**ANY, **TRAP},
    "no-plan": {**ANY, **LAYERS},
    "conflict": {**ANY, **CONFLICT},
    "no-part": {**ANY, **REMOVALS},
}
