"""Policies and certificates as data, independent of any specification."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from tumato_symbolic.policy.diagram import Diagram, Reference
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Ordering, Spec

if TYPE_CHECKING:
    from tumato_symbolic.policy.decide import Decider


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


@dataclass(frozen=True, slots=True)
class Policy:
    """What to do in every valid state.

    `digest` identifies the meaning of the specification that the policy was made for; it, the effect ordering and
    the certificate are None in a policy that does not record them (such as one made by Tumato 2.0).
    `certificate_problem` tells why a certificate that came with the policy was set aside.
    """

    vocabulary: Vocabulary
    decisions: Table | DecisionDiagram
    ordering: Ordering | None = None
    digest: str | None = None
    certificate: Certificate | None = None
    certificate_problem: str | None = None
    _decider: Decider | None = field(default=None, init=False, repr=False, compare=False)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Policy:
        """Read a policy file (`-` is standard input). Raises `UserError` where it cannot be used."""
        from tumato_symbolic.policy.files import load

        return load(os.fspath(path))

    def decide(self, state: Mapping[str, str]) -> tuple[str, ...]:
        """The actions to execute in `state` (value by variable), in the order of declaration; `()` is: none.

        Raises `UndecidedState` where the policy says nothing of the state, and `UserError` where `state` does not
        give every variable of the policy one of its values, and nothing else.
        """
        decider = self._decider
        if decider is None:
            from tumato_symbolic.policy.decide import make_decider

            decider = make_decider(self)
            object.__setattr__(self, "_decider", decider)
        return decider.decide(state)
