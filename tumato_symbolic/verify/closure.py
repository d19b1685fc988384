"""Whether what a policy decides is closed: no decision may lead to a valid state without one."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    State,
    is_valid,
    nominal_agrees,
    outcomes_in_turn,
    replay,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.result import Departure, Refutation

MOST_OUTCOMES = 200_000
"""After so many outcomes it is left open whether decisions are closed."""


def with_departure(
    refutation: Refutation, spec: Spec, decisions: Decisions, ordering: Ordering, context: Context
) -> Refutation:
    """The refutation of *total* by the first undecided state to which a decision may lead, where there is one.

    States come in the order of declaration, the outcomes of each with the shortest ways first. Raises
    `LimitReachedError`.
    """
    rows = decisions.rows
    if rows is None:
        return refutation
    looked_at = 0
    for state, chosen in rows.items():
        context.check()
        for reached, way in _next_in_turn(spec, state, chosen, ordering):
            if reached not in rows and is_valid(spec, reached):
                return replace(refutation, state=reached, departure=Departure(state, chosen, way))
            looked_at += 1
            if looked_at > MOST_OUTCOMES:
                return refutation
    return replace(refutation, closed=True)


def _next_in_turn(
    spec: Spec, state: State, chosen: ActionSet, ordering: Ordering
) -> Iterator[tuple[State, EffectSequence]]:
    """`Next(s, A)` one by one, each with a way: under `first`, the nominal successor need not be an outcome."""
    yield from outcomes_in_turn(spec, state, chosen, ordering)
    if ordering == "first" and nominal_agrees(spec, chosen):
        nominal = ((action, spec.actions[action].nominal) for action in sorted(chosen))
        yield successor(spec, state, chosen), replay(state, ((action, effect) for action, effect in nominal if effect))
