"""What happened, step by step: executions of a policy, nominal or not (`docs/semantics.md`, sections 3 and 11)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.semantics.runs import End
from tumato_symbolic.semantics.states import ActionSet, State
from tumato_symbolic.semantics.step import EffectSequence, outcomes_in_turn, successor
from tumato_symbolic.spec import Ordering, Spec


class Move(Struct, frozen=True):
    """A step of the policy with one of its outcomes: the nominal one, or a deviation with the way to it."""

    decision: ActionSet
    after: State
    deviation: EffectSequence | None = None


class Disturbance(Struct, frozen=True):
    """A change of the state that no action made."""

    after: State


Event: TypeAlias = Move | Disturbance


class Trace(Struct, frozen=True):
    """An execution from `start`: its events in turn, each with the state after it.

    `end` tells how it ended, as in a `Run`; None: nobody waited for an end. With `loop`, the state after the last event
    is the one that was there before the event of that number, and what happened since can go on for ever.
    """

    start: State
    events: tuple[Event, ...] = ()
    end: End | None = None
    loop: int | None = None

    @property
    def last(self) -> State:
        """The state in which it ended."""
        return self.events[-1].after if self.events else self.start

    @property
    def states(self) -> tuple[State, ...]:
        """The state at the start, and after every event."""
        return (self.start, *(event.after for event in self.events))

    @property
    def moves(self) -> tuple[Move, ...]:
        """The steps of the policy."""
        return tuple(event for event in self.events if isinstance(event, Move))

    def then(self, event: Event) -> Trace:
        """With one more event."""
        return replace(self, events=(*self.events, event))


def moves_from(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> Iterator[Move]:
    """Every outcome of a set whose nominal effects agree: the nominal one, then the others, the shortest ways first."""
    nominal = successor(spec, state, chosen)
    yield Move(chosen, nominal)
    for after, way in outcomes_in_turn(spec, state, chosen, ordering):
        if after != nominal:
            yield Move(chosen, after, way)
