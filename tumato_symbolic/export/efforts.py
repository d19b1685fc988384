"""How much effort nominal runs take back to safety, for all unsafe states at once."""

from __future__ import annotations

from collections.abc import Mapping

from tumato_symbolic.semantics import (
    AT_ONCE,
    ActionSet,
    Effort,
    State,
    duration,
    is_safe,
    longer,
    nominal_agrees,
    restored,
    successor,
)
from tumato_symbolic.spec import Spec


def nominal_sums(spec: Spec, rows: Mapping[State, ActionSet]) -> dict[State, Effort]:
    """For every unsafe state that the nominal run by `rows` restores, the sum of (duration, 1) until it does.

    Each state of a run is judged by its own level.
    """
    sums: dict[State, Effort] = {}
    lost: set[State] = set()
    for start in rows:
        path: list[State] = []
        here, effort = start, None
        while here not in lost and not is_safe(spec, here):
            chosen = rows.get(here)
            if chosen is None or not nominal_agrees(spec, chosen):
                break
            effort = sums.get(here)
            if effort is not None:
                break
            path.append(here)
            lost.add(here)
            after = successor(spec, here, chosen)
            if restored(spec, here, after):
                effort = AT_ONCE
                break
            here = after
        if effort is not None:
            for state in reversed(path):
                effort = longer(effort, duration(spec, rows[state]))
                sums[state] = effort
            lost.difference_update(path)
    return sums
