"""Why a state is not guaranteed more: outcomes that can go on for ever, or that lead away from the goal.

See `docs/semantics.md`, section 11.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import islice

from msgspec import Struct

from tumato_symbolic.semantics.goals import Residual, reached, residual_goal
from tumato_symbolic.semantics.guarantees import Guarantee
from tumato_symbolic.semantics.states import ActionSet, State
from tumato_symbolic.semantics.step import nominal_agrees, outcomes_in_turn, successor
from tumato_symbolic.semantics.traces import Move, moves_from
from tumato_symbolic.spec import Ordering, Spec

MOST_OUTCOMES = 2_000
"""Of a step, so many outcomes are looked at for a short example, before the first that serves is taken."""


class Shortcoming(Struct, frozen=True):
    """Why a state is not guaranteed the next level up: `moves` from it.

    With `loop`, the moves from that one on lead back to where it began, without meeting the goal, and can go on for
    ever: the state is fair at most. Otherwise the goal is not met after them, unless something deviates again: `rest`
    are the states of the nominal run from there, the last of which was met before, or is not decided.
    """

    state: State
    moves: tuple[Move, ...]
    loop: int | None = None
    rest: tuple[State, ...] = ()

    @property
    def deviations(self) -> int:
        """How many moves deviate."""
        return sum(move.deviation is not None for move in self.moves)


class Shortcomings:
    """Tells why the guarantee of a state is no stronger.

    Of a state where `goal` is still pending: `endures` tells with how many deviations it is met (`Prospects.endures`),
    `forced` whether it is met whatever happens. Where they are right, every answer is replayed by `shows`.
    """

    def __init__(
        self,
        spec: Spec,
        policy: Mapping[State, ActionSet],
        ordering: Ordering,
        endures: Callable[[State], float],
        forced: Callable[[State], bool],
    ) -> None:
        self._spec, self._policy, self._ordering = spec, policy, ordering
        self._endures, self._forced = endures, forced

    def of(self, state: State, guarantee: Guarantee) -> Shortcoming | None:
        """What is missing for the next level; None where the state is guaranteed."""
        match guarantee.kind:
            case "guaranteed":
                return None
            case "fair":
                return self._endless(state)
            case _:
                return self._led_astray(state, guarantee.deviations or 0)

    def _moves(self, state: State) -> Iterator[Move]:
        return moves_from(self._spec, state, self._policy[state], self._ordering)

    def _endless(self, state: State) -> Shortcoming:
        """Outcomes from where the goal is never forced, until a state is met again; soon, where that is easy."""
        places, moves, here = {state: 0}, list[Move](), state
        while True:
            open_moves = (move for move in self._moves(here) if not self._forced(move.after))
            first = next(open_moves)
            back = (move for move in (first, *islice(open_moves, MOST_OUTCOMES)) if move.after in places)
            move = next(back, first)
            moves.append(move)
            here = move.after
            if here in places:
                return Shortcoming(state, tuple(moves), loop=places[here])
            places[here] = len(moves)

    def _led_astray(self, state: State, survived: int) -> Shortcoming:
        """As many deviations as are needed, each as soon as it does harm, and nominal steps between them."""
        moves, here, left = list[Move](), state, survived
        while left >= 0:
            nominal, *_ = islice(self._moves(here), 1)
            deviations = (move for move in self._moves(here) if move.deviation is not None)
            harmful = next((move for move in deviations if self._endures(move.after) < left), None)
            left -= harmful is not None
            moves.append(harmful or nominal)
            here = moves[-1].after
        return Shortcoming(state, tuple(moves), rest=nominal_run(self._spec, self._policy, here))


def nominal_run(spec: Spec, policy: Mapping[State, ActionSet], start: State) -> tuple[State, ...]:
    """The states of the nominal run from `start`, whatever the goals: to one that was met before, or is not decided."""
    states, met = [start], set[State]()
    while states[-1] not in met:
        here = states[-1]
        met.add(here)
        chosen = policy.get(here)
        if chosen is None or not nominal_agrees(spec, chosen):
            break
        states.append(successor(spec, here, chosen))
    return tuple(states)


def shows(
    spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering, guarantee: Guarantee, found: Shortcoming
) -> bool:
    """Whether a shortcoming, replayed, shows that a state is guaranteed no more than `guarantee`."""
    goal = residual_goal(spec, found.state, policy[found.state])
    if not found.moves or not _is_run(spec, policy, ordering, goal, found):
        return False
    end = found.moves[-1].after
    if found.loop is not None:
        begin = found.state if found.loop == 0 else found.moves[found.loop - 1].after
        return guarantee.kind == "fair" and 0 <= found.loop < len(found.moves) and end == begin
    return (
        guarantee.kind in ("survives", "nominal")
        and found.deviations == (guarantee.deviations or 0) + 1
        and found.rest == nominal_run(spec, policy, end)
        and not any(reached(spec, goal, state) for state in found.rest)
    )


def _is_run(
    spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering, goal: Residual, found: Shortcoming
) -> bool:
    """Whether every move is a step of the policy, with an outcome of it that does not meet the goal."""
    here = found.state
    for move in found.moves:
        if policy.get(here) != move.decision or reached(spec, goal, move.after):
            return False
        nominal = successor(spec, here, move.decision)
        if move.deviation is None:
            possible = move.after == nominal
        else:
            ways = dict(outcomes_in_turn(spec, here, move.decision, ordering))
            possible = move.after != nominal and ways.get(move.after) == move.deviation
        if not possible:
            return False
        here = move.after
    return True
