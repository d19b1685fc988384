"""An execution of a policy, for a person, for a program, and in the trace format of Apalache (ITF)."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.report.layout import count
from tumato_symbolic.report.objections import Place, broken_here, effects_text, outcome_json
from tumato_symbolic.semantics import Disturbance, Event, Move, State, Trace, action_names, in_json
from tumato_symbolic.spec import Spec

_EXECUTED, _HAPPENED = "tumato::executed", "tumato::happened"
"""Variables of an ITF trace beside those of the specification, in whose names no colon stands."""


def move_text(place: Place, here: State, move: Move) -> str:
    """How the effects of a step happened."""
    if move.deviation is None:
        return f"as intended ({place.assignment(_changed(here, move.after))})"
    return effects_text(place, move.deviation) or "nothing happens"


def event_text(place: Place, here: State, event: Event) -> str:
    """A step or a disturbance, and what is wrong with the state after it."""
    if isinstance(event, Disturbance):
        text = f"disturbance: {place.assignment(_changed(here, event.after))}"
    else:
        text = f"{place.actions(event.decision)}: {move_text(place, here, event)}"
    broken = broken_here(place, event.after)
    return f"{text}; {broken}" if broken else text


def trace_lines(place: Place, trace: Trace, most: int | None = None) -> Iterator[str]:
    """The events, numbered from 1 (`most` of them, and the last one), and how it ended."""
    broken = broken_here(place, trace.start)
    yield f"start: {place.state(trace.start)}{broken and f' ({broken})'}"
    for number, (here, event) in enumerate(zip(trace.states, trace.events, strict=False), 1):
        if most is None or number <= most or number == len(trace.events):
            yield f"{number}. {event_text(place, here, event)}"
        elif number == most + 1:
            yield f"… and {count(len(trace.events) - most - 1, 'more event')}"
    steps = count(len(trace.moves), "step")
    match trace.end:
        case "goal":
            yield f"The goal is met after {steps}."
        case "bound":
            yield f"The goal is not met within {steps}."
        case "loop":
            yield f"And again from step {(trace.loop or 0) + 1}, possibly for ever, without meeting the goal."
        case "undefined":
            yield f"The policy does not decide {place.state(trace.last)}."


def move_json(spec: Spec, move: Move) -> dict[str, object]:
    """A step for a program."""
    return {
        "decision": list(action_names(spec, move.decision)),
        "deviation": None if move.deviation is None else outcome_json(spec, move.deviation),
        "after": in_json(spec, move.after),
    }


def trace_json(spec: Spec, trace: Trace) -> dict[str, object]:
    """The same for a program; what has no `decision` is a disturbance. `loop` is an event, counted from 0."""
    return {
        "start": in_json(spec, trace.start),
        "events": [
            move_json(spec, event)
            if isinstance(event, Move)
            else {"decision": None, "deviation": None, "after": in_json(spec, event.after)}
            for event in trace.events
        ],
        "end": trace.end,
        "loop": trace.loop,
    }


def trace_itf(place: Place, trace: Trace) -> dict[str, object]:
    """The same as an ITF trace: states with what led to each; a loop leaves out the state that it comes back to."""
    spec = place.spec
    told = (event_text(place, here, event) for here, event in zip(trace.states, trace.events, strict=False))
    entries: list[tuple[State, Event | None, str]] = [
        (trace.start, None, "start"),
        *((event.after, event, text) for event, text in zip(trace.events, told, strict=True)),
    ]
    if trace.loop is not None:
        entries = entries[:-1]
    names = [variable.name for variable in spec.variables]
    return {
        "#meta": {"format": "ITF", "description": f"an execution of a policy for {place.file}", "end": trace.end},
        "vars": [*names, _EXECUTED, _HAPPENED],
        "states": [
            {
                "#meta": {"index": index},
                **in_json(spec, state),
                _EXECUTED: {"#set": list(action_names(spec, event.decision)) if isinstance(event, Move) else []},
                _HAPPENED: text,
            }
            for index, (state, event, text) in enumerate(entries)
        ],
        **({} if trace.loop is None else {"loop": trace.loop}),
    }


def _changed(before: State, after: State) -> tuple[tuple[int, int], ...]:
    return tuple((number, value) for number, value in enumerate(after) if value != before[number])
