"""What an engine may be asked. One that claims to follow a rule answers by the most direct of these that it has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol, runtime_checkable

from msgspec import Struct

from tests.conformance.world import World
from tumato_symbolic.policy.unrealizability import Unrealizability
from tumato_symbolic.semantics import ActionSet, Effort, Guarantee, State

Rows = Mapping[State, ActionSet]

PROPERTIES = ("total", "safe", "restoring", "goals", "minimal")
"""What a policy is judged by."""


class Engine(Protocol):
    """Something that implements a part of docs/semantics.md."""

    name: str


@runtime_checkable
class Reader(Engine, Protocol):
    """Refuses what is no specification."""

    def refuses(self, text: str) -> bool:
        """Whether a specification is in error."""


@runtime_checkable
class Stepper(Engine, Protocol):
    """Knows states and single steps."""

    def valid(self, world: World, state: State) -> bool:
        """`s ∈ V`."""

    def safe(self, world: World, state: State) -> bool:
        """`s ∈ S`."""

    def allowed(self, world: World, state: State, chosen: ActionSet) -> bool:
        """`Ok(s, A)`, in a valid state."""

    def successor(self, world: World, state: State, chosen: ActionSet) -> State:
        """`δ(s, A)`, where conditions 1 to 3 of section 3 hold."""

    def meets(self, world: World, state: State, chosen: ActionSet, there: State) -> bool:
        """Whether `there` satisfies the residual goal of `state` with `chosen` as the first set."""


@runtime_checkable
class Judge(Engine, Protocol):
    """Judges policies."""

    def faults(self, world: World, rows: Rows) -> set[str]:
        """Which of `PROPERTIES` fail."""


class Answer(Struct, frozen=True):
    """What there is: a policy with the length of its longest run, or the failing states by kind."""

    policy: Rows | None
    failures: Mapping[str, frozenset[State]]
    longest: int | None = None


@runtime_checkable
class Decider(Engine, Protocol):
    """Finds policies."""

    def answer(self, world: World) -> Answer:
        """The preferred policy, or why there is none."""


@runtime_checkable
class Refuter(Engine, Protocol):
    """Judges certificates that there is no policy."""

    def believes(self, world: World, certificate: Unrealizability) -> bool:
        """Whether a certificate proves that the specification has no policy."""


@runtime_checkable
class Restorer(Engine, Protocol):
    """Knows how safety is restored in several steps, and by severity."""

    def following(self, world: World, state: State, chosen: ActionSet) -> set[State]:
        """`Next(s, A)`."""

    def level(self, world: World, state: State) -> int:
        """The level of a valid state."""

    def efforts(self, world: World, rows: Rows) -> Mapping[State, Effort]:
        """`w` in the unsafe states of a policy for all valid states, where it is finite."""


@runtime_checkable
class Guarantor(Engine, Protocol):
    """Knows what policies guarantee beyond their nominal runs."""

    def guarantees(self, world: World, rows: Rows) -> Mapping[State, Guarantee | None]:
        """The strongest that holds of each valid state, where all nominal runs of a total policy meet their goals."""


ROLES: dict[str, type] = {
    "reader": Reader,
    "stepper": Stepper,
    "judge": Judge,
    "decider": Decider,
    "refuter": Refuter,
    "restorer": Restorer,
    "guarantor": Guarantor,
}
"""The fixture by which a test asks for every engine of a role."""
