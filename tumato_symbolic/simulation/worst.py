"""The longest way to the goal that outcomes can force, from one state or the worst of several."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import (
    ActionSet,
    Move,
    Prospects,
    Residual,
    State,
    Trace,
    moves_from,
    residual_goal,
    steps_from,
)
from tumato_symbolic.semantics.guarantees import Steps
from tumato_symbolic.spec import Ordering, Spec

MOST_OUTCOMES = 200_000
"""So many outcomes are followed, state by state."""


def worst_case(
    spec: Spec, policy: Mapping[State, ActionSet], starts: Sequence[State], ordering: Ordering, context: Context
) -> Trace | None:
    """The worst that outcomes, in any order, can make of the policy, from the worst of some states that it decides.

    Never to meet the goal is worse than any number of steps: then the trace ends in a loop, or where nothing is
    decided. Of ways that are equally bad, from the first state in the order of `starts`. None where too much can
    follow.
    """
    context.tell("following every outcome")
    steps = steps_from(spec, policy, starts, ordering, MOST_OUTCOMES)
    if steps is None:
        return None
    game = _Game(spec, policy, ordering, steps)
    worst, most = starts[0], -1
    for start in starts:
        context.check()
        length = game.length(start)
        if length is None:
            return game.endless(start)
        if length > most:
            worst, most = start, length
    return game.longest(worst)


class _Game:
    """The policy against an opponent who chooses every outcome."""

    def __init__(self, spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering, steps: Steps) -> None:
        self._spec, self._policy, self._ordering, self._steps = spec, policy, ordering, steps
        self._forced: dict[Residual, dict[State, int]] = {}

    def _layers(self, start: State) -> dict[State, int]:
        """The states from where the goal of `start` is met whatever happens, by the number of steps."""
        goal = residual_goal(self._spec, start, self._policy[start])
        if goal not in self._forced:
            self._forced[goal] = Prospects(self._spec, goal, self._steps).forced
        return self._forced[goal]

    def length(self, start: State) -> int | None:
        """After how many steps from `start`, at least one, its goal is met at worst; None where it need not be."""
        if start not in self._steps:
            return None
        forced, following = self._layers(start), self._steps[start].following
        return 1 + max(forced[after] for after in following) if following <= forced.keys() else None

    def _moves(self, state: State) -> list[Move]:
        return list(moves_from(self._spec, state, self._policy[state], self._ordering))

    def longest(self, start: State) -> Trace:
        """The longest way from a state whose goal is met whatever happens; nominal where that is as long."""
        forced, trace = self._layers(start), Trace(start, end="goal")
        while not trace.events or forced[trace.last]:
            trace = trace.then(max(self._moves(trace.last), key=lambda move: forced[move.after]))
        return trace

    def endless(self, start: State) -> Trace:
        """A way from a state whose goal need not be met: to a state that was met before, or that is not decided."""
        forced = self._layers(start) if start in self._steps else {}
        trace, met = Trace(start), {start: 0}
        while trace.last in self._steps:
            moves = [move for move in self._moves(trace.last) if move.after not in forced]
            back = (move for move in moves if move.after in met)
            trace = trace.then(next(back, moves[0]))
            if trace.last in met:
                return Trace(start, trace.events, "loop", met[trace.last])
            met[trace.last] = len(trace.events)
        return Trace(start, trace.events, "undefined")
