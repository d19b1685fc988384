"""The certificate that there is no policy: cubes, layers, runs that fail (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import prod

from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.game import Layers as Ranks
from tumato_symbolic.game import Problem
from tumato_symbolic.policy import RankedGoal, Vocabulary, minimized
from tumato_symbolic.policy.unrealizability import (
    ActionEffect,
    Choice,
    Conflict,
    Cube,
    Cut,
    Layers,
    NoAllowedSet,
    NoPlan,
    NoRestoration,
    Reason,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    Residual,
    State,
    falsified,
    holds,
    is_safe,
    nominal_agrees,
    outcomes_in_turn,
    settled_truth,
    successor,
    takes_effect,
    without_cases,
)
from tumato_symbolic.spec import Ordering, Rule, Spec, canonical_text, digest
from tumato_symbolic.symbolic import Bdd, Extractor, one_by_one
from tumato_symbolic.synthesis.certificate import goal_names
from tumato_symbolic.synthesis.conflict import FailingRun, RepairConflict

MOST_CUBES = 2_000
"""A certificate with more cubes leaves the claim to a prover."""

MOST_OUTCOMES = 3_000_000
"""A certificate that would have to look at a set with more outcomes leaves it, too."""

FEW_NODES = 1000
"""Layers with so few nodes are taken as they are: Z3 is quick with them."""


def certified(problem: Problem, reason: Reason) -> Unrealizability:
    """The certificate with this reason."""
    spec = problem.spec
    return Unrealizability(Vocabulary.of(spec), problem.steps.ordering, digest(spec), reason, spec.restoration)


def no_allowed_set(problem: Problem, state: State) -> NoAllowedSet:
    """Disjoint cubes over the actions, found by settling one action after another until a condition is violated."""
    spec = without_cases(problem.spec, state)
    cubes: list[Cube] = []
    pending: list[tuple[ActionSet, ActionSet]] = [(frozenset(), frozenset())]
    while pending:
        problem.context.check()
        executed, idle = pending.pop()
        try:
            violation = next(_violations(problem, spec, state, executed, idle), None)
        except _TooManyOutcomesError:
            return NoAllowedSet(state, None)
        if violation is not None:
            cubes.append(Cube(executed, idle, violation))
            if len(cubes) > MOST_CUBES:
                return NoAllowedSet(state, None)
            continue
        action = next(a for a in range(len(spec.actions)) if a not in executed and a not in idle)
        pending += [(executed, idle | {action}), (executed | {action}, idle)]
    return NoAllowedSet(state, tuple(cubes))


class _TooManyOutcomesError(Exception):
    """Whether a set is always safe is not found out by looking at each of its outcomes."""


def _violations(
    problem: Problem, spec: Spec, state: State, executed: ActionSet, idle: ActionSet
) -> Iterator[Violation]:
    """The conditions of section 3 that no set of a cube meets."""
    ordering = problem.steps.ordering
    for number in sorted(executed):
        if not all(holds(rule.formula, state) for rule in spec.actions[number].conditions):
            yield Violation("precondition", (number,))
    for pair in combinations(sorted(executed), 2):
        if spec.actions[pair[0]].resources & spec.actions[pair[1]].resources:
            yield Violation("resource", pair)
        if not nominal_agrees(spec, frozenset(pair)):
            yield Violation("nominal-conflict", pair)
    for rule in spec.reaction_rules:
        if settled_truth(rule.formula, state, executed, idle) is False:
            yield Violation("reaction-rule", rule=_name(spec, rule))
    settled = len(executed) + len(idle) == len(spec.actions)
    if takes_effect(spec, executed):
        yield from _by_outcomes(spec, state, executed, ordering)
    elif not takes_effect(spec, frozenset(range(len(spec.actions))) - idle) and not is_safe(spec, state):
        yield Violation("idle")
    if settled and not is_safe(spec, successor(spec, state, executed)):
        yield Violation("nominal-unsafe")


def _by_outcomes(spec: Spec, state: State, executed: ActionSet, ordering: Ordering) -> Iterator[Violation]:
    """What is wrong with what effects lead to. Raises `_TooManyOutcomesError`."""
    effects = [len(spec.actions[action].effects) for action in executed]
    if (prod(1 + count for count in effects) if ordering == "any" else sum(effects)) > MOST_OUTCOMES:
        raise _TooManyOutcomesError
    for reached, way in outcomes_in_turn(spec, state, executed, ordering):
        if not is_safe(spec, reached):
            yield Violation("unsafe", outcome=_effects(way))
    if spec.preconditions == "throughout":
        for objection in falsified(spec, state, executed, ordering):
            yield Violation("falsified", objection.actions, outcome=_effects(objection.outcome))


def _effects(way: EffectSequence) -> tuple[ActionEffect, ...]:
    return tuple((step.action, step.effect) for step in way)


def _name(spec: Spec, rule: Rule) -> str:
    return canonical_text(spec, rule.formula)


def no_restoration(problem: Problem, state: State, lost: Bdd) -> NoRestoration:
    """The states of the level of `state` that are `lost`: nothing surely leads out of them."""
    here = next(states for states, _ in problem.steps.levels if problem.encoding.contains(states, state))
    builder: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    extract = Extractor(problem.encoding, builder, default=False)
    trap, level = (extract.function([(True, states)]) for states in (lost & here, here))
    diagram = builder.finish()
    return minimized(NoRestoration(state, diagram, trap), Vocabulary.of(problem.spec).sizes, (diagram, level))


def no_plan(problem: Problem, state: State, distances: Sequence[Ranks]) -> NoPlan:
    """Sets that hold all runs from a state, for every residual goal of an allowed set in it.

    They are those that are too far from the goal; or those that the runs reach, where that takes fewer nodes.
    """
    here, manager = problem.encoding.state_cube(state), problem.encoding.manager
    pending = [
        (residual, problem.steps.successors(pairs & here), [manager.cofactor(layer, bits) for layer in layers])
        for every, layers in zip(problem.targets, distances, strict=True)
        for target, bits in one_by_one(problem.encoding, every, problem.steps.allowed & here)
        for residual, pairs in target.residuals
        if (pairs & here) != problem.false
    ]
    far = _drawn(problem, state, [(residual, _too_far(problem, ranks)) for residual, _, ranks in pending])
    size, near = len(far.diagram.nodes), []
    for residual, first, _ in pending if size > FEW_NODES else ():
        layers = _reached(problem, first, size)
        if layers is None:
            return far
        near.append((residual, layers))
    return min((far, _drawn(problem, state, near)), key=lambda each: len(each.diagram.nodes)) if near else far


def _drawn(problem: Problem, state: State, found: Sequence[tuple[Residual, Sequence[Bdd]]]) -> NoPlan:
    """Layers as diagrams. What they say of states that are not safe is free, and chosen so that they are small."""
    builder: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    extract = Extractor(problem.encoding, builder, default=False)
    goals = [
        Layers(*goal_names(problem.spec, residual), tuple(extract.function([(True, layer)]) for layer in layers))
        for residual, layers in found
    ]
    goals.sort(key=lambda goal: (goal.bodies, goal.executed))
    safe = extract.function([(True, problem.steps.safe)])
    diagram = builder.finish()
    return minimized(NoPlan(state, diagram, tuple(goals)), Vocabulary.of(problem.spec).sizes, (diagram, safe))


def _too_far(problem: Problem, ranks: Ranks) -> list[Bdd]:
    """The safe states from where a goal is not reached in the `L - k` steps that are left after `k`, for `k` from 1 on.

    Where no distance was cut off by the bound, those from where it is never reached, which no step leaves.
    """
    near, layers = problem.false, []
    for rank in ranks:
        near = near | rank
        layers.append(problem.steps.safe & ~near)
    return layers[-1:] if ranks[-1] == problem.false else layers[::-1]


def _reached(problem: Problem, first: Bdd, most: int) -> list[Bdd] | None:
    """What runs reach after their `first` states: one set that no step leaves, or a layer for every step to the bound.

    None where that takes more than `most` nodes.
    """
    builder: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    extract = Extractor(problem.encoding, builder, default=False)
    bound = problem.spec.max_plan_length
    layers, seen = [first], first
    while bound is None or len(layers) < bound:
        extract.function([(True, layers[-1])])
        if len(builder.finish().nodes) > most:
            return None
        layer = problem.steps.successors(problem.steps.allowed & layers[-1]) & ~seen
        if layer == problem.false:
            return [seen]
        layers.append(layer)
        seen = seen | layer
    return layers


def conflict(problem: Problem, proof: RepairConflict) -> Conflict:
    """The states that cannot be served together, everything that can be done on the way, and the runs that fail."""
    deepest = max(len(layers) for _, layers in proof.aims)
    builder: DiagramBuilder[int | None] = DiagramBuilder(problem.encoding.order, (None, *range(deepest)))
    extract = Extractor(problem.encoding, builder, default=None)
    goals: list[RankedGoal] = []
    first: dict[int, int] = {}
    for number in sorted({option.target for options in proof.options.values() for option in options}):
        first[number] = len(goals)
        target, layers = proof.aims[number]
        root = extract.function(list(enumerate(layers)))
        residuals = [residual for residual, _ in target.residuals]
        goals += [RankedGoal(*goal_names(problem.spec, residual), root) for residual in residuals]
    places = {state: place for place, state in enumerate(proof.options)}
    looping = {state for run in proof.cuts if run.back is not None for state in run.states}
    choices = [
        Choice(
            state,
            tuple((option.successor, first[option.target]) for option in options),
            tuple(tuple(sorted(option.following & looping)) for option in options) if state in looping else (),
        )
        for state, options in proof.options.items()
    ]
    cuts = [_cut(run, first, places) for run in proof.cuts]
    starts = tuple(places[state] for state in proof.states)
    return Conflict(starts, tuple(choices), tuple(cuts), builder.finish(), tuple(goals))


def _cut(run: FailingRun, first: Mapping[int, int], places: Mapping[State, int]) -> Cut:
    """A failing run with the numbers of a certificate."""
    states = tuple(places[state] for state in run.states)
    if run.back is not None:
        return Cut("outcomes", 0, states, None, run.back)
    return Cut("loop" if run.end is None else "path", first[run.target], states, run.end)
