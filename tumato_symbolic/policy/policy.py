"""A policy."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field

from tumato_symbolic.policy.formats import policy_fields
from tumato_symbolic.policy.lookup import Decider, make_decider
from tumato_symbolic.policy.records import Certificate, DecisionDiagram, PolicyFields, Table, Vocabulary
from tumato_symbolic.policy.text import read_text
from tumato_symbolic.spec import Ordering, Restoration, Value


@dataclass(frozen=True, slots=True)
class Policy:
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
    _decider: Decider | None = field(default=None, init=False, repr=False, compare=False)

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
        decider = self._decider
        if decider is None:
            decider = make_decider(self.vocabulary, self.decisions)
            object.__setattr__(self, "_decider", decider)
        return decider.decide(state)
