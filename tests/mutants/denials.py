"""Mutations of a certificate for the answer no, as a JSON object: its cubes, its layers, its conflict."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from random import Random
from typing import Any

Document = dict[str, Any]
Mutation = Callable[[Document, Random], None]
"""Changes a document in place; where it finds nothing to change, it leaves it as it is."""


def _reason(document: Document) -> Document:
    found: Document = document["Reason"]
    return found


def _other_state(document: Document, random: Random) -> Document:
    """Any state."""
    return {name: random.choice([*values]) for name, values in document["States"].items()}


def _near_state(document: Document, state: Document, random: Random) -> Document:
    """A state that differs in one variable."""
    name = random.choice([*state])
    return {**state, name: random.choice([*document["States"][name]])}


def _reference(section: Document, random: Random) -> int:
    return random.randrange(len(section["Leaves"]) + len(section["Nodes"]))


def _dropped(entries: list[Any], random: Random) -> None:
    if entries:
        entries.pop(random.randrange(len(entries)))


def _doubled(entries: list[Any], random: Random) -> None:
    if entries:
        entries.insert(random.randrange(len(entries) + 1), deepcopy(random.choice(entries)))


def _swapped(entries: list[Any], random: Random) -> None:
    if entries:
        one, other = random.randrange(len(entries)), random.randrange(len(entries))
        entries[one], entries[other] = entries[other], entries[one]


def _in_list(key: str, change: Callable[[list[Any], Random], None]) -> Mutation:
    """A change of a list of the reason."""
    return lambda document, random: change(_reason(document)[key] or [], random)


def _state(document: Document, random: Random) -> None:
    """It speaks of another state."""
    reason = _reason(document)
    other = _near_state(document, reason["State"], random) if random.random() < 0.5 else _other_state(document, random)
    reason["State"] = other


def _child(document: Document, random: Random) -> None:
    """An edge of a node leads elsewhere, where the order of levels allows it; else to a leaf."""
    section = _reason(document)
    if not section["Nodes"]:
        return
    number, base = random.randrange(len(section["Nodes"])), len(section["Leaves"])
    level, below = section["Nodes"][number]
    target = random.randrange(base + number)
    if target >= base and section["Nodes"][target - base][0] <= level:
        target = random.randrange(base)
    below[random.randrange(len(below))] = target


def _executed(document: Document, random: Random) -> None:
    """A goal was executed with an action more or less."""
    if goals := _reason(document)["Goals"]:
        goal, action = random.choice(goals), random.choice(document["Actions"])
        goal["Executed"] = sorted({*goal["Executed"]} ^ {action})


def _bodies(document: Document, random: Random) -> None:
    """A goal has a body less, or those of another one."""
    if goals := _reason(document)["Goals"]:
        goal = random.choice(goals)
        goal["Bodies"] = random.choice((goal["Bodies"][1:], random.choice(goals)["Bodies"]))


def _ordering(document: Document, random: Random) -> None:
    document["EffectOrdering"] = random.choice(("any", "first"))


ANY: dict[str, Mutation] = {"another ordering": _ordering}


# Cubes.


def _cube(document: Document, random: Random) -> Document | None:
    cubes = _reason(document)["Cubes"]
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
            _reason(document)["Cubes"].append(other)


def _merged(document: Document, random: Random) -> None:
    """A settled action is left open, and the cubes that are part of the new one are dropped."""
    if cube := _cube(document, random):
        if not (settled := [*cube["Executed"], *cube["Idle"]]):
            return
        action = random.choice(settled)
        for key in ("Executed", "Idle"):
            cube[key] = [name for name in cube[key] if name != action]
        _reason(document)["Cubes"] = [
            other
            for other in _reason(document)["Cubes"]
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
    struck = [cube for cube in _reason(document)["Cubes"] or () if cube["Violation"].get("Outcome")]
    if not struck:
        return
    outcome = random.choice(struck)["Violation"]["Outcome"]
    match random.randrange(5):
        case 0:
            _dropped(outcome, random)
        case 1:
            _doubled(outcome, random)
        case 2:
            outcome.reverse()
        case 3:
            random.choice(outcome)["Action"] = random.choice(document["Actions"])
        case _:
            effect = random.choice(outcome)["Effect"]
            for name in random.sample([*effect], min(1, len(effect))):
                effect[name] = random.choice([*document["States"][name]])


def _no_cubes(document: Document, random: Random) -> None:
    _reason(document)["Cubes"] = None
    if random.random() < 0.5:
        _state(document, random)


CUBES: dict[str, Mutation] = {
    "another state": _state,
    "a cube dropped": _in_list("Cubes", _dropped),
    "a cube twice": _in_list("Cubes", _doubled),
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
        if goals := _reason(document)["Goals"]:
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
    if goals := _reason(document)["Goals"]:
        layers = random.choice(goals)["Layers"]
        if layers:
            layers[random.randrange(len(layers))] = _reference(_reason(document), random)


def _layers_exchanged(document: Document, random: Random) -> None:
    """Two goals exchange their layers."""
    if goals := _reason(document)["Goals"]:
        one, other = random.choice(goals), random.choice(goals)
        one["Layers"], other["Layers"] = other["Layers"], one["Layers"]


LAYERS: dict[str, Mutation] = {
    "another state": _state,
    "a goal dropped": _in_list("Goals", _dropped),
    "a goal twice": _in_list("Goals", _doubled),
    "the last layer dropped": _layers(_last_dropped),
    "the first layer dropped": _layers(_first_dropped),
    "a layer dropped": _layers(_dropped),
    "a layer twice": _layers(_doubled),
    "two layers swapped": _layers(_neighbours_swapped),
    "a layer exchanged": _layer,
    "layers of two goals exchanged": _layers_exchanged,
    "a node's child": _child,
    "`Executed`": _executed,
    "the bodies of a goal": _bodies,
}


# Conflicts.


def _choice(document: Document, random: Random) -> Document:
    found: Document = random.choice(_reason(document)["Choices"])
    return found


def _choice_state(document: Document, random: Random) -> None:
    choice = _choice(document, random)
    choice["State"] = _near_state(document, choice["State"], random)


def _options(change: Callable[[list[Any], Random], None]) -> Mutation:
    return lambda document, random: change(_choice(document, random)["Options"], random)


def _option(document: Document, random: Random) -> None:
    """An option leads elsewhere, or owes another goal."""
    if options := _choice(document, random)["Options"]:
        option = random.choice(options)
        if random.random() < 0.5:
            option["Successor"] = _near_state(document, option["Successor"], random)
        else:
            option["Goal"] = random.randrange(len(_reason(document)["Goals"]))


def _cut(document: Document, random: Random) -> Document | None:
    cuts = _reason(document)["Cuts"]
    return random.choice(cuts) if cuts else None


def _run(document: Document, random: Random) -> None:
    """The run of a cut: a state less or more, another one, turned."""
    if cut := _cut(document, random):
        run, count = cut["States"], len(_reason(document)["Choices"])
        match random.randrange(5) if run else 1:
            case 0:
                _dropped(run, random)
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
        on_the_way = _reason(document)["Choices"][random.choice(cut["States"])]["State"]
        cut["End"] = random.choice(
            (on_the_way, _near_state(document, cut["End"], random), _other_state(document, random))
        )


def _kind(document: Document, random: Random) -> None:
    """A loop becomes a path, or the other way round."""
    if cut := _cut(document, random):
        if cut["Kind"] == "path":
            cut["Kind"] = "loop"
            del cut["End"]
        else:
            state = random.choice(_reason(document)["Choices"])["State"]
            cut.update(Kind="path", End=random.choice((state, _other_state(document, random))))


def _goal_of_a_cut(document: Document, random: Random) -> None:
    if cut := _cut(document, random):
        cut["Goal"] = random.randrange(len(_reason(document)["Goals"]))


def _path_cut_short(document: Document, random: Random) -> None:
    """A path ends one state earlier, at its last state."""
    paths = [cut for cut in _reason(document)["Cuts"] if cut["Kind"] == "path" and len(cut["States"]) > 1]
    if paths:
        cut = random.choice(paths)
        cut["End"] = _reason(document)["Choices"][cut["States"].pop()]["State"]


def _distance(document: Document, random: Random) -> None:
    """A distance is one more or one less, or infinite."""
    leaves = _reason(document)["Leaves"]
    place = random.randrange(len(leaves))
    leaf = leaves[place] or 0
    leaves[place] = random.choice((leaf + 1, max(0, leaf - 1), None))


def _distances_stretched(document: Document, random: Random) -> None:
    leaves, more = _reason(document)["Leaves"], random.choice((1, 2))
    leaves[:] = [leaf and leaf + more for leaf in leaves]


def _root(document: Document, random: Random) -> None:
    """A goal has the root of another one, or any."""
    goals = _reason(document)["Goals"]
    other = random.choice(goals)["Root"] if random.random() < 0.6 else _reference(_reason(document), random)
    random.choice(goals)["Root"] = other


def _roots_swapped(document: Document, random: Random) -> None:
    goals = _reason(document)["Goals"]
    one, other = random.choice(goals), random.choice(goals)
    one["Root"], other["Root"] = other["Root"], one["Root"]


def _starts(document: Document, random: Random) -> None:
    starts, count = _reason(document)["Starts"], len(_reason(document)["Choices"])
    if starts and random.random() < 0.5:
        starts.pop(random.randrange(len(starts)))
    else:
        starts.append(random.randrange(count))


CONFLICT: dict[str, Mutation] = {
    "the starts": _starts,
    "another state": _choice_state,
    "an option dropped": _options(_dropped),
    "an option twice": _options(_doubled),
    "an option changed": _option,
    "two choices swapped": _in_list("Choices", _swapped),
    "a cut dropped": _in_list("Cuts", _dropped),
    "a cut twice": _in_list("Cuts", _doubled),
    "the run of a cut": _run,
    "the end of a path": _end,
    "a path cut short": _path_cut_short,
    "the kind of a cut": _kind,
    "the goal of a cut": _goal_of_a_cut,
    "a distance": _distance,
    "distances stretched": _distances_stretched,
    "a node's child": _child,
    "a root": _root,
    "two roots swapped": _roots_swapped,
    "`Executed`": _executed,
    "the bodies of a goal": _bodies,
}

BY_KIND: dict[str, dict[str, Mutation]] = {
    "no-allowed-set": {**ANY, **CUBES},
    "no-plan": {**ANY, **LAYERS},
    "conflict": {**ANY, **CONFLICT},
}
