"""Changing earlier decisions where goals interact: symbolically, for whole families of failing states at once."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.game import (
    ClosedLoop,
    Evaluation,
    Evaluator,
    Layers,
    Problem,
    Reevaluator,
    closed_loop,
    mixed,
    shortest_decisions,
)
from tumato_symbolic.symbolic import Bdd, Target, one_by_one, preferred

MOST_LOOPS = 100
"""How often changes are made again one after the other, where runs loop without them."""

TRIES_TO_REVERT = 64
"""How many evaluations are spent on undoing changes that turned out not to be needed."""


def override(evaluator: Evaluator, found: Evaluation, distances: tuple[Layers, ...]) -> Evaluation:
    """A policy under which fewer states fail, or the given one: failing states get their shortest run.

    Every state on such a run follows it, whatever its own goals are. All states are judged again after the change for
    one target, which is kept when fewer of them fail. What still fails then needs a closer look (`Repair`).
    """
    problem, count = evaluator.problem, evaluator.problem.encoding.count_states
    improved = True
    while improved and found.failing != problem.false:
        improved = False
        shortest = shortest_decisions(problem, distances, found.failing, problem.steps.allowed)
        for target, layers in _aims(problem, found.failing, distances):
            candidate = _towards(problem, found.closed_loop.policy, shortest & target.pending, layers)
            if candidate == found.closed_loop.policy:
                continue
            evaluated = evaluator.evaluate(candidate)
            if count(evaluated.failing) < count(found.failing):
                found, improved = evaluated, True
                shortest = shortest_decisions(problem, distances, found.failing, problem.steps.allowed)
            if found.failing == problem.false:
                break
    return found


def _aims(problem: Problem, failing: Bdd, distances: tuple[Layers, ...]) -> Iterator[tuple[Target, Layers]]:
    """Every target with its distances; where one stands for many residual goals, those of failing states instead."""
    encoding = problem.encoding
    for target, layers in zip(problem.targets, distances, strict=True):
        for single, bits in one_by_one(encoding, target, problem.steps.allowed & failing):
            yield single, [encoding.manager.cofactor(layer, bits) for layer in layers]


def _towards(problem: Problem, policy: Bdd, starts: Bdd, layers: Layers) -> Bdd:
    """The policy after sending the states of some pairs to the target that they have, on a shortest run.

    From far to near: the states that such runs meet keep their decision where it leads one layer nearer, and
    otherwise take the preferred set that does.
    """
    steps, encoding = problem.steps, problem.encoding
    changed = starts & steps.safe
    met = steps.successors(starts)
    for distance in range(len(layers) - 1, 0, -1):
        here = met & layers[distance] & ~steps.states_of(changed)
        if here == problem.false:
            continue
        nearer = steps.before(layers[distance - 1]) & here
        kept = policy & nearer
        turned = here & ~steps.states_of(kept)
        decided = kept | preferred(encoding, steps.allowed & turned & nearer)
        changed = changed | (decided & turned & steps.safe)
        met = met | steps.successors(decided)
    return changed | (policy & ~steps.states_of(changed))


def revert_unneeded(evaluator: Evaluator, before: Bdd, after: Bdd) -> Bdd:
    """`after` with as many decisions of `before` as fit without a failing state.

    Both policies are defined in every safe state, and none fails under `after`. First only those changes are kept
    without which runs close loops; what is left of them is tried by halves.
    """
    problem = evaluator.problem
    earlier, later = _smaller(problem, before, after)
    now = _breaking_loops(evaluator, earlier, later)
    pending = [problem.steps.states_of(now.policy & ~before)]
    suspects = list(range(len(problem.targets)))
    tries = 0
    while pending and tries < TRIES_TO_REVERT:
        states = pending.pop()
        candidate = mixed(now, earlier, states)
        tries += 1
        if evaluator.serves_all(candidate, suspects):
            now = candidate
        else:
            pending += reversed(_halves(problem, states))
    return now.policy


def _breaking_loops(evaluator: Evaluator, before: ClosedLoop, after: ClosedLoop) -> ClosedLoop:
    """`before` with those decisions of `after` that keep its runs from looping; `after`, where these do not suffice.

    In every round failing runs are followed to the states that they come back to for ever. Those of them that were
    changed get their change, where the run next leaves the states that were.
    """
    problem, judge = evaluator.problem, Reevaluator(evaluator)
    changed, kept = problem.steps.states_of(after.policy & ~before.policy), problem.false
    for _ in range(MOST_LOOPS):
        found = mixed(before, after, kept)
        failing = judge.failing(found)
        if failing == problem.false:
            return found
        open_ = changed & ~kept
        looping = _visited_for_ever(problem, found.policy, failing) & open_
        if looping == problem.false:
            return after
        last = looping & ~found.predecessor(looping, open_)
        kept = kept | (looping if last == problem.false else last)
    return after


def _visited_for_ever(problem: Problem, policy: Bdd, starts: Bdd) -> Bdd:
    """The states that runs from some states come back to again and again."""
    steps, count = problem.steps, problem.encoding.count_states
    here = (starts & steps.safe) | steps.successors(steps.allowed & steps.unsafe & starts)
    left, after = count(here), steps.successors(policy & here)
    while (following := count(after)) < left:
        left, here, after = following, after, steps.successors(policy & after)
    met, lasting, front = here, after, after & ~here
    while front != problem.false:
        problem.context.check()
        met, after = met | front, steps.successors(policy & front)
        front, lasting = after & ~met, lasting | after
    while lasting != met:
        problem.context.check()
        lasting, met = steps.successors(policy & lasting), lasting
    return met


def _smaller(problem: Problem, before: Bdd, after: Bdd) -> tuple[ClosedLoop, ClosedLoop]:
    """Two policies, both move by move or both as functions: whichever takes fewer nodes. The answers are the same."""
    nodes = problem.encoding.manager.nodes
    as_functions = closed_loop(problem, before, 0), closed_loop(problem, after, 0)
    by_moves = closed_loop(problem, before), closed_loop(problem, after)
    moves = by_moves[1].moves
    if by_moves[0].moves is None or moves is None:
        return as_functions
    of_functions = sum(map(nodes, as_functions[1].following.values()))
    return by_moves if sum(map(nodes, moves.values())) < of_functions else as_functions


def _halves(problem: Problem, states: Bdd) -> list[Bdd]:
    """A set in two by the first bit in which its states differ; nothing for a single state."""
    manager = problem.encoding.manager
    for bit in problem.encoding.all_state_bits:
        low = states & ~manager.cube({bit: True})
        if problem.false not in {low, states & ~low}:
            return [low, states & ~low]
    return []
