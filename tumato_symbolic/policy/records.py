"""What policies and certificates are made of, independent of any specification."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names that a policy speaks of: `(variable, its values)` and the actions, in the policy's own order."""

    variables: tuple[tuple[str, tuple[str, ...]], ...]
    actions: tuple[str, ...]

    @classmethod
    def of(cls, spec: Spec) -> Vocabulary:
        """The names of a specification, in its order of declaration."""
        return cls(
            tuple((variable.name, variable.values) for variable in spec.variables),
            tuple(action.name for action in spec.actions),
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
class Certificate:
    """What a proof needs beside the policy: ranks of every safe state, per residual goal (`docs/certificate.md`)."""

    ranks: Diagram[int | None]
    goals: tuple[RankedGoal, ...]
