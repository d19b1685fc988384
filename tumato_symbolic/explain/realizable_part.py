"""The largest part of the valid states for which there is a policy."""

from __future__ import annotations

import heapq
from collections.abc import Iterator

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Span
from tumato_symbolic.explain.as_predicates import in_other_words, predicate_text, shortest_formula
from tumato_symbolic.explain.environment import Restriction, restrictions
from tumato_symbolic.explain.failing_states import restricted
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable, trial
from tumato_symbolic.game import Problem, winning_alone
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula, Rule, Spec
from tumato_symbolic.symbolic import Bdd, targets
from tumato_symbolic.synthesis import Realizable, Unrealizable

CHOICES = 200
"""So many ways out of conflicts are tried at most."""


class SteadyPart(Struct, frozen=True):
    """States that make the specification realizable, and out of which the environment alone does not lead."""

    count: int
    formula: Formula


class Part(Struct, frozen=True):
    """States which, taken as an assumption, or as the starts, make the specification realizable.

    `unique`: it is the greatest such set, and every other one is a part of it. Where goals conflict there may be
    several maximal ones; `largest` then says that none has more states. `formula` is the assumption to add, or the
    start condition to have instead of those that are there, `environment` what it takes from variables that no action
    controls. Where that is something, `steady` is a smaller part that takes nothing from them, if one was found.
    """

    states: Bdd
    count: int
    formula: Formula
    unique: bool
    largest: bool
    environment: tuple[Restriction, ...]
    steady: SteadyPart | None = None


def largest_part(requirements: Requirements) -> Part | None:
    """The largest realizable part, None where nothing remains.

    Every realizable part lies in the greatest set in which no state fails. Where goals conflict there, every one leaves
    out a state of the conflict: the larger sets are tried first, so the first realizable one is the largest. With
    starts it is they that are left out, and what a policy decides beside them is not told.
    """
    count, spec = requirements.encoding.count_states, requirements.spec
    whole = _without_failing(requirements, requirements.valid)
    whole = whole & requirements.starts if spec.starts else whole
    waiting: list[tuple[int, int, Bdd]] = [(-count(whole), 0, whole)]
    seen, tried, largest = {whole}, 0, True
    while waiting:
        states = heapq.heappop(waiting)[2]
        if states == requirements.false:
            return None
        tried += 1
        formula = assumption(requirements, states)
        blamed = _conflict(requirements, starting(spec, formula) if spec.starts else assuming(spec, formula), states)
        if blamed is None:
            assumed = restrictions(requirements, states)
            steady = _steady_part(requirements, states) if assumed else None
            return Part(states, count(states), formula, states == whole, largest, assumed, steady)
        if tried >= CHOICES:
            waiting, largest = [], False
        for state in blamed:
            smaller = states & ~requirements.encoding.state_cube(state)
            smaller = smaller if spec.starts else _without_failing(requirements, smaller)
            if smaller not in seen:
                seen.add(smaller)
                heapq.heappush(waiting, (-count(smaller), len(seen), smaller))
    return None


def _steady_part(requirements: Requirements, states: Bdd) -> SteadyPart | None:
    """The most of some states out of which the environment alone does not lead; None where these do not serve."""
    spec, encoding = requirements.spec, requirements.encoding
    bits = [bit for variable in sorted(spec.environment) for bit in encoding.state_bits[variable]]
    while True:
        kept = states & ~requirements.manager.exists(bits, requirements.starts & ~states)
        kept = kept if spec.starts else _without_failing(requirements, kept)
        if kept == states:
            break
        states = kept
    if states == requirements.false:
        return None
    formula = assumption(requirements, states)
    found = starting(spec, formula) if spec.starts else assuming(spec, formula)
    return SteadyPart(encoding.count_states(states), formula) if is_realizable(requirements, found) else None


def _without_failing(requirements: Requirements, states: Bdd) -> Bdd:
    """`ν X. {s ∈ states ∩ X : s does not fail when outcomes have to stay in X}`."""
    while states != requirements.false:
        problem = _within(requirements, states)
        kept = states & winning_alone(problem, requirements.compatible)
        if kept == states:
            break
        states = kept
    return states


def _within(requirements: Requirements, states: Bdd) -> Problem:
    """The problem with these states as an assumption."""
    steps = requirements.steps_within(states)
    regions = restricted(requirements.regions, states, requirements.false)
    spec = replace(steps.encoding.spec, max_plan_length=requirements.spec.max_plan_length)
    return Problem(spec, steps, regions, tuple(targets(steps, regions)))


def _conflict(requirements: Requirements, spec: Spec, states: Bdd) -> tuple[State, ...] | None:
    """Those of some states that no policy serves together in a specification; None where it is realizable.

    Where synthesis gives up, any state may be to blame, and the first few are.
    """
    outcome = trial(requirements, spec)
    if isinstance(outcome, Realizable):
        return None
    if isinstance(outcome, Unrealizable):
        return outcome.failures[0].states
    return tuple(_first(requirements.encoding.states_in(states), 3))


def _first(states: Iterator[State], count: int) -> Iterator[State]:
    yield from (state for _, state in zip(range(count), states, strict=False))


def assumption(requirements: Requirements, states: Bdd) -> Formula:
    """What to assume beside the assumptions so that exactly these states are valid.

    Not word for word a state rule: who reads both should not take the rule, which guards it, for a repetition.
    """
    spec, encoding = requirements.spec, requirements.encoding
    formula = shortest_formula(encoding, states, encoding.domain() & ~requirements.valid)
    return in_other_words(spec, formula) if formula in [rule.formula for rule in spec.state_rules] else formula


def assuming(spec: Spec, formula: Formula) -> Spec:
    """The specification with one more assumption."""
    rule = Rule(formula, predicate_text(spec, formula), Span(1, 1, 1, 1))
    return replace(spec, assumptions=(*spec.assumptions, rule))


def starting(spec: Spec, formula: Formula) -> Spec:
    """The specification with other starts."""
    return replace(spec, starts=(Rule(formula, predicate_text(spec, formula), Span(1, 1, 1, 1)),))
