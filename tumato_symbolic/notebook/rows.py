"""The states that a policy decides, one by one."""

from __future__ import annotations

from collections.abc import Mapping

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.policy import Policy, as_table, count_defined
from tumato_symbolic.semantics import ActionSet, State


def few_rows(policy: Policy, limit: int, what: str) -> Mapping[State, ActionSet]:
    """The decision of every state that is decided. Raises `UserError` (TUM508) where there are more than `limit`."""
    found = as_table(policy, limit)
    if found is None:
        message = f"the policy decides {count(count_defined(policy), 'state')}, and a {what} holds {limit:,} at most"
        help_ = "allow more with `max_states`, or look at a part: `tumato-sym show`"
        raise UserError((Diagnostic(Code.TUM508, message, help=help_),))
    return found.rows
