"""What many executions came to, counted: how they ended, and what happened in all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from msgspec import Struct

from tumato_symbolic.semantics import Disturbance, End, State, Trace, duration, is_safe
from tumato_symbolic.spec import Spec


class Spread(Struct, frozen=True):
    """How often each of some numbers came, in ascending order."""

    counts: Mapping[int, int]

    @classmethod
    def of(cls, counter: Counter[int]) -> Spread:
        """What a counter has counted."""
        return cls(dict(sorted(counter.items())))

    @property
    def mean(self) -> float:
        """Their mean; 0 where there are none."""
        return sum(number * times for number, times in self.counts.items()) / (sum(self.counts.values()) or 1)


class Summary(Struct, frozen=True):
    """The executions by how they ended, and what happened in all of them together.

    `steps` and `durations` are of those that met their goal. A restoration is a step from an unsafe state to a safe
    one; `unsafe` counts the steps from a safe state to an unsafe one, which a policy that is proved never takes.
    `missed` is the first execution that did not meet its goal, with its number from 1 on.
    """

    ends: Mapping[End, int]
    steps: Spread
    durations: Spread
    deviations: int
    disturbances: int
    restorations: int
    unsafe: int
    missed: tuple[int, Trace] | None

    @property
    def runs(self) -> int:
        """How many executions there were."""
        return sum(self.ends.values())

    @property
    def met(self) -> int:
        """How many met their goal."""
        return self.ends.get("goal", 0)


def summarized(spec: Spec, traces: Iterable[Trace]) -> Summary:
    """What executions came to; they are looked at one by one, and not kept."""
    ends, steps, durations, happened = Counter[End](), Counter[int](), Counter[int](), Counter[str]()
    missed: tuple[int, Trace] | None = None
    for number, trace in enumerate(traces, 1):
        if trace.end is not None:
            ends[trace.end] += 1
        if trace.end == "goal":
            steps[len(trace.moves)] += 1
            durations[sum(duration(spec, move.decision) for move in trace.moves)] += 1
        elif missed is None:
            missed = number, trace
        happened.update(_happened(spec, trace))
    return Summary(
        dict(ends),
        Spread.of(steps),
        Spread.of(durations),
        happened["deviation"],
        happened["disturbance"],
        happened["restoration"],
        happened["unsafe"],
        missed,
    )


def _happened(spec: Spec, trace: Trace) -> Counter[str]:
    """Everything in one execution that is counted."""
    found, known = Counter[str](), dict[State, bool]()
    for state in trace.states:
        known[state] = known[state] if state in known else is_safe(spec, state)
    for before, event in zip(trace.states, trace.events, strict=False):
        if isinstance(event, Disturbance):
            found["disturbance"] += 1
            continue
        found["deviation"] += event.deviation is not None
        found["restoration"] += known[event.after] and not known[before]
        found["unsafe"] += known[before] and not known[event.after]
    return found
