"""What a policy guarantees in one state, and why no more (`docs/semantics.md`, section 11)."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec import Struct

from tumato_symbolic.semantics import (
    ActionSet,
    Guarantee,
    Prospects,
    Shortcoming,
    Shortcomings,
    State,
    residual_goal,
    shows,
    steps_from,
)
from tumato_symbolic.spec import Ordering, Spec

MOST_OUTCOMES = 50_000
"""So many outcomes are followed, state by state; beyond, `verify --guarantees` has to be asked."""


class Guaranteed(Struct, frozen=True):
    """The guarantee of a state, None where not even the nominal run meets its goal, and why it is no stronger."""

    guarantee: Guarantee | None
    shortcoming: Shortcoming | None = None


def guaranteed(spec: Spec, policy: Mapping[State, ActionSet], state: State, ordering: Ordering) -> Guaranteed | None:
    """What is guaranteed in a state that the policy decides; None where too much can follow."""
    steps = steps_from(spec, policy, [state], ordering, MOST_OUTCOMES)
    if steps is None:
        return None
    if state not in steps:
        return Guaranteed(None)
    prospects = Prospects(spec, residual_goal(spec, state, policy[state]), steps)
    guarantee = prospects.of(steps[state])
    if guarantee is None:
        return Guaranteed(None)
    told = Shortcomings(spec, policy, ordering, prospects.endures, prospects.forced.__contains__)
    found = told.of(state, guarantee)
    if found is not None and not shows(spec, policy, ordering, guarantee, found):
        raise RuntimeError(f"{found} does not show that {state} is {guarantee.kind} at most")
    return Guaranteed(guarantee, found)
