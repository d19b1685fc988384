"""The largest part of the valid states for which there is a policy."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.explain.demands import Demands
from tumato_symbolic.explain.failing_states import restricted
from tumato_symbolic.explain.predicates import predicate_text, shortest_formula
from tumato_symbolic.explain.trial import trial
from tumato_symbolic.game import Problem, winning_alone
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula, Rule, Spec
from tumato_symbolic.symbolic import Bdd, targets
from tumato_symbolic.synthesis import Realizable, Unrealizable

CHOICES = 200
"""So many ways out of conflicts are tried at most."""


@dataclass(frozen=True)
class Part:
    """States which, taken as an assumption, make the specification realizable.

    `unique`: it is the greatest such set, and every other one is a part of it. Where goals conflict there may be
    several maximal ones; `largest` then says that none has more states. `formula` is the assumption to add.
    """

    states: Bdd
    count: int
    formula: Formula
    unique: bool
    largest: bool


def largest_part(demands: Demands) -> Part | None:
    """The largest realizable part, None where nothing remains.

    Every realizable part lies in the greatest set in which no state fails. Where goals conflict there, every one leaves
    out a state of the conflict: the larger sets are tried first, so the first realizable one is the largest.
    """
    count = demands.encoding.count_states
    whole = _without_failing(demands, demands.valid)
    waiting: list[tuple[int, int, Bdd]] = [(-count(whole), 0, whole)]
    seen, tried, largest = {whole}, 0, True
    while waiting:
        states = heapq.heappop(waiting)[2]
        if states == demands.false:
            return None
        tried += 1
        formula = assumption(demands, states)
        blamed = _conflict(demands, formula)
        if blamed is None:
            return Part(states, count(states), formula, states == whole, largest)
        if tried >= CHOICES:
            waiting, largest = [], False
        for state in blamed:
            smaller = _without_failing(demands, states & ~demands.encoding.state_cube(state))
            if smaller not in seen:
                seen.add(smaller)
                heapq.heappush(waiting, (-count(smaller), len(seen), smaller))
    return None


def _without_failing(demands: Demands, states: Bdd) -> Bdd:
    """`ν X. {s ∈ states ∩ X : s does not fail when outcomes have to stay in X}`."""
    while states != demands.false:
        problem = _within(demands, states)
        kept = states & winning_alone(problem, demands.compatible)
        if kept == states:
            break
        states = kept
    return states


def _within(demands: Demands, states: Bdd) -> Problem:
    """The problem with these states as an assumption."""
    steps = demands.steps_within(states)
    regions = restricted(demands.regions, states, demands.false)
    spec = replace(steps.encoding.spec, max_plan_length=demands.spec.max_plan_length)
    return Problem(spec, steps, regions, tuple(targets(steps, regions)))


def _conflict(demands: Demands, formula: Formula) -> tuple[State, ...] | None:
    """States that no policy serves together under an assumption; None where it makes the specification realizable.

    Where synthesis gives up, any state may be to blame, and the first few are.
    """
    outcome = trial(demands, assuming(demands.spec, formula))
    if isinstance(outcome, Realizable):
        return None
    if isinstance(outcome, Unrealizable):
        return outcome.failures[0].states
    return tuple(_first(demands.encoding.states_in(demands.formula(formula)), 3))


def _first(states: Iterator[State], count: int) -> Iterator[State]:
    yield from (state for _, state in zip(range(count), states, strict=False))


def assumption(demands: Demands, states: Bdd) -> Formula:
    """What to assume beside the assumptions so that exactly these states are valid."""
    return shortest_formula(demands.encoding, states, demands.encoding.domain() & ~demands.valid)


def assuming(spec: Spec, formula: Formula) -> Spec:
    """The specification with one more assumption."""
    rule = Rule(formula, predicate_text(spec, formula), Span(1, 1, 1, 1))
    return replace(spec, assumptions=(*spec.assumptions, rule))
