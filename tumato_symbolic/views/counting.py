"""In how many states two policies decide otherwise, and nothing else of how they differ."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy
from tumato_symbolic.views.compared import states_changed
from tumato_symbolic.views.placing import placed_together


class Counted(Struct, frozen=True):
    """Numbers of states, of the names of both policies.

    `compared` are those that one of them decides, `changed` those with different decisions; of these, the old policy
    alone decides `lost`, and the new one alone `won`.
    """

    compared: int
    changed: int
    lost: int
    won: int


def counted(old: Policy, new: Policy, context: Context) -> Counted:
    """Count, as `difference` does without a specification. Raises `LimitReachedError`."""
    context.tell("comparing the policies")
    with placed_together(old, new, context) as (sets, _, before, after):
        looked_at = sets.either(before.decided, after.decided)
        return Counted(
            sets.count(looked_at),
            sets.count(sets.both(looked_at, states_changed(sets, before, after))),
            sets.count(sets.without(before.decided, after.decided)),
            sets.count(sets.without(after.decided, before.decided)),
        )
