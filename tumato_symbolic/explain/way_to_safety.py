"""How a policy leads back to safety from one state, where that may take several steps; by looking decisions up only."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from tumato_symbolic.semantics import (
    AT_ONCE,
    ActionSet,
    Effort,
    Move,
    Quality,
    Restorations,
    State,
    duration,
    is_safe,
    longer,
    nominal_agrees,
    outcomes,
    restored,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec

MOST_STATES = 5_000
"""So many unsafe states are looked at for one question."""


class WayToSafety(Struct, frozen=True):
    """The way from an unsafe state to a safe one: the worst case where it is bounded, else the nominal run.

    `effort` is the sum of its durations, and its steps; it is `bounded` where nothing takes longer.
    """

    effort: Effort
    bounded: bool
    steps: tuple[Move, ...]


class RestoringFrom:
    """What a policy makes of the unsafe states that runs from here meet."""

    def __init__(self, spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> None:
        self._spec = spec
        self._policy = policy
        self._ordering: Ordering = ordering
        self._met: dict[State, ActionSet] = {}
        self._restorations = Restorations(spec, {}, ordering)

    def quality(self, state: State, chosen: ActionSet) -> Quality | None:
        """How well the policy restores an unsafe state when it executes this set there, if nominal effects agree."""
        self._visit(self._next(state, chosen))
        return Restorations(self._spec, {**self._met, state: chosen}, self._ordering).quality(state, chosen)

    def way(self, state: State) -> WayToSafety | None:
        """The way from an unsafe state that is decided; None where it does not end, or is too long to look at."""
        self._visit([state])
        steps: list[Move] = []
        here, effort, bounded = state, AT_ONCE, True
        while not is_safe(self._spec, here):
            chosen = self._met.get(here)
            if chosen is None or len(steps) > len(self._met):
                return None
            quality = self._restorations.quality(here, chosen)
            if quality is None:
                return None
            bounded = bounded and quality[0] < 2
            steps.append(self._worst_step(here, chosen) if bounded else self._nominal_step(here, chosen))
            effort = longer(effort, duration(self._spec, chosen))
            here = steps[-1].after
        return WayToSafety(effort, bounded, tuple(steps))

    def _worst_step(self, state: State, chosen: ActionSet) -> Move:
        """The step into one of the worst states that a set may lead to; nominal where that is one of them."""
        worst = self._restorations.worst

        def effort(after: State) -> Effort:
            return AT_ONCE if restored(self._spec, state, after) else worst[after]

        nominal = self._nominal_step(state, chosen)
        ways = outcomes(self._spec, state, chosen, self._ordering)
        after = max(ways, key=effort, default=nominal.after)
        return nominal if effort(nominal.after) >= effort(after) else Move(chosen, after, ways[after])

    def _nominal_step(self, state: State, chosen: ActionSet) -> Move:
        return Move(chosen, successor(self._spec, state, chosen))

    def _next(self, state: State, chosen: ActionSet) -> list[State]:
        return [*outcomes(self._spec, state, chosen, self._ordering), successor(self._spec, state, chosen)]

    def _visit(self, states: list[State]) -> None:
        """Look up the unsafe states that the policy leads to from some states, and what it makes of them."""
        known = len(self._met)
        waiting = list(states)
        while waiting and len(self._met) < MOST_STATES:
            here = waiting.pop()
            if here in self._met or is_safe(self._spec, here):
                continue
            try:
                chosen = self._policy[here]
            except KeyError:
                continue
            self._met[here] = chosen
            if nominal_agrees(self._spec, chosen):
                waiting += self._next(here, chosen)
        if len(self._met) > known:
            self._restorations = Restorations(self._spec, self._met, self._ordering)
