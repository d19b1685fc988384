"""What refutes a certificate that there is no policy."""

from __future__ import annotations

from tumato_symbolic.semantics import ActionSet, State


class FalseClaimError(Exception):
    """A certificate claims what is not so; `state` and `chosen` show it, where a state and an allowed set can."""

    def __init__(self, reason: str, state: State | None = None, chosen: ActionSet | None = None) -> None:
        super().__init__(reason)
        self.reason = reason
        self.state = state
        self.chosen = chosen
