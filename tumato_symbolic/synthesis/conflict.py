"""What proves that goals are in conflict: the options of states, and the runs that fail with them."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.game import Layers
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.symbolic import Target


class Option(Struct, frozen=True):
    """One way to act in a state: where it nominally leads, its target, and the preferred set that does so.

    `following` are the outcomes that are not restored, where these matter.
    """

    successor: State
    target: int
    chosen: ActionSet
    following: frozenset[State] = frozenset()


class FailingRun(Struct, frozen=True):
    """A run whose first step leaves `target` pending: along `states` to `end`, too far away, or among them for ever.

    Where there is a `back`, outcomes lead along the states, from the last one to that at this place, for ever.
    """

    target: int
    states: tuple[State, ...]
    end: State | None
    back: int | None = None


class RepairConflict(Struct, frozen=True):
    """Valid states that no policy serves together, though it does so without any one of them.

    The proof: all options of every state that the cuts mention, and cuts that no choice among these options respects.
    `aims` are the targets by which these know their goals, each with its distances.
    """

    states: tuple[State, ...]
    options: dict[State, tuple[Option, ...]]
    cuts: tuple[FailingRun, ...]
    aims: tuple[tuple[Target, Layers], ...]
