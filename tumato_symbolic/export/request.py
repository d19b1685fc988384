"""What every target is given, and the comment at its top: what is guaranteed, what the robot's code must do."""

from __future__ import annotations

from textwrap import fill

from msgspec import Struct

from tumato_symbolic.policy import Policy
from tumato_symbolic.spec import Ordering, Spec

_PROMISE = (
    "Where `tumato-sym verify` proves the policy, every set of actions decided here is safe to execute in the state "
    "that was asked about, {whatever}, and nominal effects reach the goals; for that, the robot's code must ask only "
    "when nothing is being executed, with the state that it sees then, start exactly the actions of the set, {again}, "
    "and keep an action that it halted from having an effect later."
)

_FROM_STARTS = (
    " Such a policy decides the starts of the specification, and all states that the robot's actions may lead to from"
    " any decided one; what else changes the state may lead to one that is undecided, and no action is known to be "
    "safe there."
)


def commented(text: str, mark: str) -> str:
    """A text as lines of a comment that each begin with `mark`."""
    return fill(text, 117, initial_indent=mark, subsequent_indent=mark)


class Request(Struct, frozen=True):
    """A policy in the names of its specification, and how it is to be written.

    `name` is that of the file, without its ending. `check` asks for the program that checks what is written.
    """

    policy: Policy
    spec: Spec
    ordering: Ordering
    name: str
    check: bool = False

    @property
    def promise(self) -> str:
        """What is guaranteed, and what the code around a decision must do: a sentence for every file."""
        whatever, again = "whatever effects occur, in any order", "see every effect before it asks again"
        if self.ordering == "first":
            whatever = "whatever effect occurs first"
            again = "halt the others as soon as one of them has an effect, see that effect before it asks again"
        return _PROMISE.format(whatever=whatever, again=again) + self.from_starts

    @property
    def from_starts(self) -> str:
        """Which states are decided, where that is not every valid one: a sentence more for every file."""
        return _FROM_STARTS if self.spec.starts else ""
