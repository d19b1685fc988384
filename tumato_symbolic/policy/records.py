"""What policies and certificates are made of, independent of any specification."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import ActionSet, Effort, State
from tumato_symbolic.spec import Ordering, Restoration, Spec


@dataclass(frozen=True, slots=True)
class Vocabulary:
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


@dataclass(frozen=True, slots=True)
class Table:
    """One row for every state that is decided."""

    rows: Mapping[State, ActionSet]


@dataclass(frozen=True, slots=True)
class DecisionDiagram:
    """The same, shared: `roots[a]` tells in which states action `a` is executed, `defined` which states are decided.

    The leaves are `(False, True)`. What `roots` say of a state that is not defined means nothing.
    """

    diagram: Diagram[bool]
    roots: tuple[Reference, ...]
    defined: Reference


@dataclass(frozen=True, slots=True)
class RankedGoal:
    """The ranks of one residual goal under the policy.

    `bodies` are the active goal bodies in canonical text, sorted; `executed` the actions of the first set that the
    bodies speak of, sorted names. `root` leads to the rank of a state `t`: the least number of nominal steps `k ≥ 0`
    after which the run of the policy from `t` satisfies the residual goal; None where it never does.
    """

    bodies: tuple[str, ...]
    executed: tuple[str, ...]
    root: Reference


@dataclass(frozen=True, slots=True)
class Deviation:
    """Why a state is not restored better: with the set `better` in it, the run from `missed` misses its goal."""

    state: State
    better: ActionSet
    missed: State


@dataclass(frozen=True, slots=True)
class Restoring:
    """How a policy restores safety in several steps.

    `worst` leads to `w` of an unsafe state, (duration, steps), or to None where it is infinite; `nominal` to the sum
    of (duration, 1) along its nominal run until it is restored, where `worst` is None (under `fair`). Elsewhere both
    mean nothing.
    """

    efforts: Diagram[Effort | None]
    worst: Reference
    nominal: Reference
    deviations: tuple[Deviation, ...] = ()


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a proof needs beside the policy (`docs/certificate.md`).

    Ranks per residual goal, of every safe state; where safety may take several steps to restore, of every valid one,
    and `restoring`.
    """

    ranks: Diagram[int | None]
    goals: tuple[RankedGoal, ...]
    restoring: Restoring | None = None


class PolicyFields(NamedTuple):
    """The fields of a `Policy`, as its file holds them."""

    vocabulary: Vocabulary
    decisions: Table | DecisionDiagram
    ordering: Ordering | None
    digest: str | None
    certificate: Certificate | None
    certificate_problem: str | None
    restoration: Restoration
