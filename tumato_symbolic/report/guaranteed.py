"""What a policy guarantees beyond nominal runs, for a person and a program."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.report.cubes import cube_json, cube_text
from tumato_symbolic.report.layout import Paint, count
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.traces import move_json, move_text
from tumato_symbolic.semantics import Guarantee, Shortcoming, in_json
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.guarantees.result import Guarantees, Level

_CUBES = 3
"""So many groups of states are told of each level."""

_MOVES = 12
"""So many steps of an example are told, and its last one."""


def guarantee_text(guarantee: Guarantee) -> str:
    """A level as a clause: `guaranteed: whatever happens, the goal is met within 4 steps`."""
    match guarantee.kind:
        case "guaranteed":
            return f"guaranteed: whatever happens, the goal is met within {count(guarantee.steps or 0, 'step')}"
        case "fair":
            return "fair: the goal is met once effects stop deviating, however often they did"
        case "survives":
            number = count(guarantee.deviations or 0, "deviation")
            return f"survives {number}: the goal is met with that many in the whole run, but not always with one more"
        case "nominal":
            return "nominal: the goal is met if no effect deviates, but not always with one deviation"


def guarantees_lines(place: Place, found: Guarantees, paint: Paint) -> Iterator[str]:
    """What is guaranteed, level by level, each with an example of why it is no more."""
    match found.status:
        case "unproved":
            yield f"guarantees: not computed, since {found.reason}"
            return
        case "undecided":
            yield f"guarantees: {paint.doubt('undecided')} ({found.reason})"
            return
    yield "guarantees:"
    for level in found.levels:
        noun = "decided state" if place.spec.starts else "valid state"
        yield f"  {count(level.states, noun)}: {guarantee_text(level.guarantee)}"
        yield f"    where {_where(place.spec, level)}"
        if level.shortcoming is not None:
            yield f"    nothing stronger, for example from {place.state(level.shortcoming.state)}:"
            yield from (f"      {line}" for line in shortcoming_lines(place, level.shortcoming))


def guarantees_summary(found: Guarantees) -> str:
    """One line."""
    if found.status != "known":
        return f"guarantees {found.status}: {found.reason}"
    return "; ".join(
        f"{count(level.states, 'valid state')} {guarantee_text(level.guarantee)}" for level in found.levels
    )


def _where(spec: Spec, level: Level) -> str:
    if level.cubes is None:
        return "(too many cases to list)"
    shown = [cube_text(spec, cube) for cube in level.cubes[:_CUBES]]
    if spec.starts and shown == ["every valid state"]:
        return "every decided state"
    more = len(level.cubes) - len(shown)
    return "; or ".join(shown) + (f"; … and {count(more, 'more case')}" if more else "")


def shortcoming_lines(place: Place, found: Shortcoming) -> Iterator[str]:
    """The moves, and what comes of them."""
    here = found.state
    for number, move in enumerate(found.moves, 1):
        if number <= _MOVES or number == len(found.moves):
            yield f"{number}. {place.actions(move.decision)}: {move_text(place, here, move)}"
        elif number == _MOVES + 1:
            yield f"… and {count(len(found.moves) - _MOVES - 1, 'more step')}"
        here = move.after
    if found.loop is not None:
        yield f"and again from step {found.loop + 1}, possibly for ever, without meeting the goal"
        return
    yield f"Then the state is {place.state(here)},"
    yield f"and the nominal run from there never meets the goal; its goal is {place.goals(here)}"


def guarantees_json(spec: Spec, found: Guarantees) -> dict[str, object]:
    """The same for a program, with the states of every level as cubes."""
    return {
        "status": found.status,
        "reason": found.reason,
        "levels": [_level_json(spec, each) for each in found.levels],
    }


def guarantee_json(guarantee: Guarantee) -> dict[str, object]:
    """A level."""
    return {"level": guarantee.kind, "steps": guarantee.steps, "deviations": guarantee.deviations}


def _level_json(spec: Spec, level: Level) -> dict[str, object]:
    return {
        **guarantee_json(level.guarantee),
        "states": level.states,
        "cubes": None if level.cubes is None else [cube_json(spec, cube) for cube in level.cubes],
        "example": None if level.shortcoming is None else shortcoming_json(spec, level.shortcoming),
    }


def shortcoming_json(spec: Spec, found: Shortcoming) -> dict[str, object]:
    """Why a state is guaranteed no more; `loop` is where the moves begin that may recur, counted from 0."""
    return {
        "state": in_json(spec, found.state),
        "moves": [move_json(spec, move) for move in found.moves],
        "loop": found.loop,
        "rest": None if found.loop is not None else [in_json(spec, state) for state in found.rest],
    }
