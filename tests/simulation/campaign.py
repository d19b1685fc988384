"""Executions of generated policies against the explicit meaning, and the worst of them against what is guaranteed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from random import Random

from msgspec import Struct, field

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.simulation.replay import faults
from tests.verify.policies import near_policies
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import ActionSet, Guarantee, State, Trace, allowed, is_valid
from tumato_symbolic.semantics.guarantees import steps_from
from tumato_symbolic.simulation import Dice, Simulation, executed, worst_case
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.guarantees.prospects import WalkProspects

Rows = Mapping[State, ActionSet]

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


class Tally(Struct):
    """How much was looked at, and what is wrong.

    `states` of which the worst case was held against what is guaranteed, by the kind of guarantee; `without` those of
    which nothing is guaranteed; `traces` that were replayed, by how they end.
    """

    states: Counter[str] = field(default_factory=Counter)
    without: int = 0
    traces: Counter[str] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


def examine(seed: int, tally: Tally) -> None:
    """One specification under one ordering: a policy, right where there is one; its worst cases, and its runs."""
    profiles = sorted(PROFILES)
    profile, ordering = profiles[seed % len(profiles)], ORDERINGS[seed // len(profiles) % 2]
    spec, random = random_spec(seed, PROFILES[profile]), Random(seed)
    rows = next(iter(near_policies(spec, ordering, random, count=0)))
    rows = {state: chosen for state, chosen in rows.items() if is_valid(spec, state)}
    found = [*worst_cases(spec, rows, ordering, tally), *_runs(spec, rows, ordering, seed, tally)]
    tally.complaints += [f"{profile}, {seed}, {ordering}: {each}" for each in found]


def worst_cases(spec: Spec, rows: Rows, ordering: Ordering, tally: Tally) -> list[str]:
    """State by state: as many steps as are guaranteed, or a way that misses the goal where none are.

    What is guaranteed is told of policies whose decisions are allowed: so it is asked of states from which no other
    decision can be reached. In all others, the worst case only has to be an execution.
    """
    told, complaints = _guaranteed(spec, rows, ordering), []
    for state in rows:
        trace = worst_case(spec, rows, [state], ordering, Context())
        assert trace is not None
        wrong = faults(spec, rows, ordering, trace)
        tally.traces[str(trace.end)] += 1
        if not _all_allowed(spec, rows, ordering, state):
            tally.without += 1
        else:
            guarantee = told[state]
            tally.states[guarantee.kind if guarantee else "none"] += 1
            if not _agree(guarantee, trace):
                wrong.append(f"{guarantee}, and the worst case ends with {trace.end} after {len(trace.moves)} steps")
        complaints += [f"from {state}: {each}" for each in wrong]
    return complaints


def _agree(guarantee: Guarantee | None, trace: Trace) -> bool:
    if guarantee is not None and guarantee.kind == "guaranteed":
        return (trace.end, len(trace.moves)) == ("goal", guarantee.steps)
    return trace.end in ("loop", "undefined")


def _all_allowed(spec: Spec, rows: Rows, ordering: Ordering, state: State) -> bool:
    steps = steps_from(spec, rows, [state], ordering)
    assert steps is not None
    met = {state, *steps, *(after for step in steps.values() for after in step.following)}
    return all(allowed(spec, each, rows[each], ordering) for each in met if each in rows)


def _guaranteed(spec: Spec, rows: Rows, ordering: Ordering) -> dict[State, Guarantee | None]:
    """What `verify --guarantees` finds, state by state."""
    model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, rows)), ordering)
    goals, found = WalkGoals(model), dict[State, Guarantee | None]()
    for goal, pending in goals.residuals(model.decided, model.policy):
        for guarantee, states in WalkProspects(model, goals, goal).levels(pending):
            found |= {state: guarantee for state in rows if model.holds(states, state, frozenset())}
    return found


def _runs(spec: Spec, rows: Rows, ordering: Ordering, seed: int, tally: Tally) -> list[str]:
    """Runs by chance, with and without disturbances, from some states."""
    dice, complaints = Dice(seed), list[str]()
    starts: Sequence[State] = Random(seed).sample(sorted(rows), min(3, len(rows)))
    for start in starts:
        for disturb in (0.0, 0.3):
            trace = executed(Simulation(spec, rows, ordering, "random", disturb, 40), start, dice)
            tally.traces[str(trace.end)] += 1
            complaints += [f"a run from {start}: {each}" for each in faults(spec, rows, ordering, trace)]
    return complaints
