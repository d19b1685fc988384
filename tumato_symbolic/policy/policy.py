"""`Policy`, with the methods that users call."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from tumato_symbolic.diagnostics.one_line import InOneLine
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.policy.formats import policy_fields
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, PolicyFields, Table, Vocabulary
from tumato_symbolic.policy.text import read_text
from tumato_symbolic.spec import Ordering, Restoration, Spec, Value

if TYPE_CHECKING:
    from networkx import DiGraph
    from pandas import DataFrame

    from tumato_symbolic.policy.lookup import Decider

MOST_ROWS = 100_000
"""A table of a policy has so many rows at most, unless more are asked for."""

MOST_NODES = 10_000
"""A graph has so many nodes that the policy decides at most, unless more are asked for."""


class Policy(InOneLine, frozen=True, dict=True):
    """What to do in every valid state.

    `digest` identifies the meaning of the specification that the policy was made for; it, the effect ordering and
    the certificate are None in a policy that does not record them (such as one made by Tumato 2.0).
    `restoration` is how it was made to restore safety. `certificate_problem` tells why a certificate that came with
    the policy was set aside.
    """

    vocabulary: Vocabulary
    decisions: Table | DecisionDiagram
    ordering: Ordering | None = None
    digest: str | None = None
    certificate: Certificate | None = None
    certificate_problem: str | None = None
    restoration: Restoration = "one_step"

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Policy:
        """Read a policy file (`-` is standard input). Raises `UserError` where it cannot be used."""
        return cls(*policy_fields(*read_text(os.fspath(path))))

    @property
    def fields(self) -> PolicyFields:
        """What its file holds."""
        return PolicyFields(*(getattr(self, name) for name in PolicyFields._fields))

    def decide(self, state: Mapping[str, Value]) -> tuple[str, ...]:
        """The actions to execute in `state` (value by variable), in the order of declaration; `()` is: none.

        A value that is a number may be given as a number, or as the specification writes it.

        Raises `UndecidedState` where the policy says nothing of the state, and `UserError` where `state` does not
        give every variable of the policy one of its values, and nothing else.
        """
        return self._decider.decide(state)

    @cached_property
    def _decider(self) -> Decider:
        from tumato_symbolic.policy.lookup import make_decider

        return make_decider(self.vocabulary, self.decisions)

    def __repr__(self) -> str:
        names, decisions = self.vocabulary, self.decisions
        states = count(decisions.count(names.sizes), "state")
        form = "table" if isinstance(decisions, Table) else "diagram"
        sizes = f"{count(len(names.variables), 'variable')}, {count(len(names.actions), 'action')}"
        return f"<Policy: {states} decided, {sizes}, a {form}>"

    def _repr_html_(self) -> str:
        from tumato_symbolic.notebook import policy_html

        return policy_html(self)

    def to_dataframe(self, spec: Spec, max_states: int = MOST_ROWS) -> DataFrame:
        """The decisions as a table of pandas: a row for every state that is decided.

        The index is the state: a level for every variable, with values that are numbers as numbers. The columns are
        `actions` (tuples of names, in the order of declaration) and `safe` (whether the state satisfies all state rules
        of `spec`). Raises `UserError` where the policy does not fit `spec` or decides more than `max_states` (TUM508),
        `MissingPackageError` without pandas.
        """
        from tumato_symbolic.notebook import to_dataframe

        return to_dataframe(self, spec, max_states)

    def to_networkx(self, spec: Spec, max_states: int = MOST_NODES) -> DiGraph:
        """The closed loop as a graph of networkx: states, and what one decision of the policy may make of them.

        A node is a state, as the tuple of its values in the order of `graph.graph["variables"]`. It has `actions`, the
        decision (None: undecided), and `safe`. An edge has a `kind`: `nominal` leads to where all nominal effects lead,
        `deviation` to any other outcome, such as after some of the effects. What the environment does is not there.
        Raises what `to_dataframe` does, with networkx in place of pandas.
        """
        from tumato_symbolic.notebook import to_networkx

        return to_networkx(self, spec, max_states)
