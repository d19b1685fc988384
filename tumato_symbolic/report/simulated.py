"""What executions of a policy came to, for a person and a program."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec import Struct

from tumato_symbolic.report.layout import count
from tumato_symbolic.report.objections import Place
from tumato_symbolic.report.traces import trace_json, trace_lines
from tumato_symbolic.semantics import End, Trace, duration
from tumato_symbolic.simulation import Faults, Spread, Summary

_EVENTS = 12
"""So many events of an execution are shown."""

_ENDS: dict[End, str] = {
    "goal": "met the goal",
    "bound": "did not meet it within the number of steps",
    "loop": "go round in a loop",
    "undefined": "came to a state that the policy does not decide",
}


class Simulated(Struct, frozen=True):
    """The summary of executions with how they were made; `trace` is the only one, or the first that missed its goal."""

    place: Place
    policy: str
    faults: Faults
    disturb: float
    seed: int
    summary: Summary
    trace: Trace | None


class WorstCase(Struct, frozen=True):
    """The longest way to the goal; `starts` tells how many states it was looked for from."""

    place: Place
    policy: str
    starts: int
    trace: Trace


def as_text(done: Simulated) -> str:
    """The summary, with one execution."""
    place, summary = done.place, done.summary
    if summary.runs == 1 and done.trace is not None:
        return "\n".join(trace_lines(place, done.trace))
    lines = [f"{count(summary.runs, 'run')} of {done.policy}: {', '.join(_conditions(done))}"]
    for end, number in summary.ends.items():
        lines.append(f"  {count(number, 'run')}: {_ENDS[end]}")
    lines += _spread("steps to the goal", summary.steps)
    lines += _spread("duration until then", summary.durations)
    lines.append(f"  restorations of safety: {summary.restorations:,}")
    lines.append(f"  deviations: {summary.deviations:,}; disturbances: {summary.disturbances:,}")
    if summary.unsafe:
        lines.append(f"  steps from a safe state to an unsafe one: {summary.unsafe:,}; `verify` says why")
    if summary.missed is not None:
        number, trace = summary.missed
        lines.append(f"The first that did not meet its goal is run {number:,}:")
        lines += [f"  {line}" for line in trace_lines(place, trace, _EVENTS)]
    return "\n".join(lines)


def _conditions(done: Simulated) -> Iterator[str]:
    yield {"none": "nominal effects", "random": "effects at random"}[done.faults]
    if done.disturb:
        yield f"disturbed with probability {done.disturb:g}"
    yield f"seed {done.seed}"


def _spread(what: str, spread: Spread) -> Iterator[str]:
    if spread.counts:
        least, most = min(spread.counts), max(spread.counts)
        between = f"{least:,}" if least == most else f"{least:,} to {most:,}, {spread.mean:.2f} on average"
        yield f"  {what}: {between}"


def as_json(done: Simulated) -> dict[str, object]:
    """The same for a program."""
    summary = done.summary
    return {
        "verdict": "met" if summary.met == summary.runs else "missed",
        "policy": done.policy,
        "specification": done.place.file,
        "faults": done.faults,
        "disturb": done.disturb,
        "seed": done.seed,
        "runs": summary.runs,
        "ends": {end: summary.ends.get(end, 0) for end in _ENDS},
        "steps": _spread_json(summary.steps),
        "durations": _spread_json(summary.durations),
        "deviations": summary.deviations,
        "disturbances": summary.disturbances,
        "restorations": summary.restorations,
        "unsafe": summary.unsafe,
        "trace": None if done.trace is None else trace_json(done.place.spec, done.trace),
    }


def _spread_json(spread: Spread) -> list[dict[str, int]]:
    return [{"value": number, "runs": runs} for number, runs in spread.counts.items()]


def worst_as_text(done: WorstCase) -> str:
    """The longest way, for a person."""
    trace, place = done.trace, done.place
    of = "" if done.starts == 1 else f" from each of {done.starts:,} states"
    steps = count(len(trace.moves), "step")
    match trace.end:
        case "goal":
            time = sum(duration(place.spec, move.decision) for move in trace.moves)
            heading = f"Whatever happens, the goal is met within {steps}{of}. The longest way (duration {time}):"
        case "loop":
            heading = "The goal may be missed for ever:"
        case _:
            heading = "The goal may be missed, in a state that the policy does not decide:"
    return "\n".join((heading, *(f"  {line}" for line in trace_lines(place, trace))))


def worst_as_json(done: WorstCase) -> dict[str, object]:
    """The same for a program; `steps` is null where the goal may never be met."""
    met = done.trace.end == "goal"
    return {
        "verdict": "met" if met else "missed",
        "policy": done.policy,
        "specification": done.place.file,
        "faults": "worst",
        "starts": done.starts,
        "steps": len(done.trace.moves) if met else None,
        "trace": trace_json(done.place.spec, done.trace),
    }
