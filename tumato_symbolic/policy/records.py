"""The fields of policies and of their certificates, independent of any specification."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol, Self, TypeAlias, TypeVar

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import Diagram, Reference, count_true, rebuild
from tumato_symbolic.semantics import ActionSet, Effort, State
from tumato_symbolic.spec import Ordering, Restoration, Spec

Drawing: TypeAlias = tuple[Diagram[Any], tuple[Reference, ...]]
"""A diagram with its roots."""


class Drawn(Protocol):
    """A record that holds a diagram and leads into it."""

    @property
    def drawing(self) -> Drawing:
        """The diagram, and every reference to it."""

    def drawn(self, diagram: Diagram[Any], roots: tuple[Reference, ...]) -> Self:
        """The same record with another diagram, and the references to it in the same order."""


SomeDrawn = TypeVar("SomeDrawn", bound=Drawn)


def canonical(record: SomeDrawn) -> SomeDrawn:
    """The same record with its diagram in canonical form, as files hold it."""
    return record.drawn(*rebuild(*record.drawing))


class Vocabulary(Struct, frozen=True):
    """The names that a policy uses: `(variable, its values)` and the actions, in the policy's own order."""

    variables: tuple[tuple[str, tuple[str, ...]], ...]
    actions: tuple[str, ...]

    @classmethod
    def of(cls, spec: Spec) -> Vocabulary:
        """The names of a specification, in its order of declaration."""
        return cls(
            tuple((variable.name, variable.values) for variable in spec.variables),
            spec.action_names,
        )

    @property
    def sizes(self) -> tuple[int, ...]:
        """How many values each variable has."""
        return tuple(len(values) for _, values in self.variables)


class Table(Struct, frozen=True):
    """One row for every state that is decided."""

    rows: Mapping[State, ActionSet]

    def count(self, sizes: Sequence[int]) -> int:  # noqa: ARG002 - a diagram needs them
        """How many states are decided."""
        return len(self.rows)


class DecisionDiagram(Struct, frozen=True):
    """The same, shared: `roots[a]` tells in which states action `a` is executed, `defined` which states are decided.

    The leaves are `(False, True)`. What `roots` say of a state that is not defined means nothing.
    """

    diagram: Diagram[bool]
    roots: tuple[Reference, ...]
    defined: Reference

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.diagram, (*self.roots, self.defined)

    def count(self, sizes: Sequence[int]) -> int:
        """How many states are decided, where variables have so many values."""
        return count_true(self.diagram, self.defined, sizes)

    def drawn(self, diagram: Diagram[bool], roots: tuple[Reference, ...]) -> DecisionDiagram:
        """See `Drawn`."""
        return DecisionDiagram(diagram, roots[:-1], roots[-1])


class RankedGoal(Struct, frozen=True):
    """The ranks of one residual goal under the policy.

    `bodies` are the active goal bodies in canonical text, sorted; `executed` the actions of the first set that the
    bodies speak of, sorted names. `root` leads to the rank of a state `t`: the least number of nominal steps `k ≥ 0`
    after which the run of the policy from `t` satisfies the residual goal; None where it never does.
    """

    bodies: tuple[str, ...]
    executed: tuple[str, ...]
    root: Reference


def rooted(goals: tuple[RankedGoal, ...], roots: tuple[Reference, ...]) -> tuple[RankedGoal, ...]:
    """The same goals with other roots."""
    return tuple(RankedGoal(goal.bodies, goal.executed, root) for goal, root in zip(goals, roots, strict=True))


class Deviation(Struct, frozen=True):
    """Why a state is not restored better: with the set `better` in it, the run from `missed` misses its goal."""

    state: State
    better: ActionSet
    missed: State


class Restoring(Struct, frozen=True):
    """How a policy restores safety in several steps.

    `worst` leads to `w` of an unsafe state, (duration, steps), or to None where it is infinite; `nominal` to the sum
    of (duration, 1) along its nominal run until it is restored, where `worst` is None (under `fair`). Elsewhere both
    mean nothing.
    """

    efforts: Diagram[Effort | None]
    worst: Reference
    nominal: Reference
    deviations: tuple[Deviation, ...] = ()

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.efforts, (self.worst, self.nominal)

    def drawn(self, diagram: Diagram[Effort | None], roots: tuple[Reference, ...]) -> Restoring:
        """See `Drawn`."""
        worst, nominal = roots
        return Restoring(diagram, worst, nominal, self.deviations)


class Certificate(Struct, frozen=True):
    """What a proof needs beside the policy (`docs/certificate.md`).

    Ranks per residual goal, of every safe state; where safety may take several steps to restore, of every valid one,
    and `restoring`.
    """

    ranks: Diagram[int | None]
    goals: tuple[RankedGoal, ...]
    restoring: Restoring | None = None

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.ranks, tuple(goal.root for goal in self.goals)

    def drawn(self, diagram: Diagram[int | None], roots: tuple[Reference, ...]) -> Certificate:
        """See `Drawn`."""
        return replace(self, ranks=diagram, goals=rooted(self.goals, roots))


class PolicyFields(NamedTuple):
    """The fields of a `Policy`, as its file holds them."""

    vocabulary: Vocabulary
    decisions: Table | DecisionDiagram
    ordering: Ordering | None
    digest: str | None
    certificate: Certificate | None
    certificate_problem: str | None
    restoration: Restoration
