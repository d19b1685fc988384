"""Policies and certificates as data, independent of any specification."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tumato_symbolic.policy.diagram import Diagram, Reference
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Ordering


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names that a policy speaks of: `(variable, its values)` and the actions, in the policy's own order."""

    variables: tuple[tuple[str, tuple[str, ...]], ...]
    actions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """One row for every state that is decided."""

    rows: Mapping[State, ActionSet]


@dataclass(frozen=True, slots=True)
class DecisionDiagram:
    """The same, shared: `roots[a]` tells in which states action `a` is executed, `defined` which states are decided.

    What `roots` say of a state that is not defined means nothing.
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


@dataclass(frozen=True, slots=True)
class Policy:
    """What to do in every valid state.

    `digest` identifies the meaning of the specification that the policy was made for; it, the effect ordering and
    the certificate are None in a policy that does not record them (such as one made by Tumato 2.0).
    """

    vocabulary: Vocabulary
    decisions: Table | DecisionDiagram
    ordering: Ordering | None = None
    digest: str | None = None
    certificate: Certificate | None = None
