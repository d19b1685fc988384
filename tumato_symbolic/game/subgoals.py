"""One subgoal after the other: runs to a conjunction that keep what they have reached of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from tumato_symbolic.game.fixpoints import Layers
from tumato_symbolic.game.problem import Problem
from tumato_symbolic.semantics import ActiveGoals
from tumato_symbolic.spec import Assignment, Formula, conjuncts, executing_atoms
from tumato_symbolic.symbolic import Bdd, Target, preferred

Moves: TypeAlias = Mapping[Assignment, Bdd]
"""Pairs of state and set by what the set nominally writes."""

MOST_MOVES = 10_000
"""With more different moves, as where reaction rules ask for much, subgoals are not looked at."""


def subgoals_of(problem: Problem, active: ActiveGoals) -> list[Formula]:
    """The predicates that some active goals are a conjunction of, in order; none where they speak of actions."""
    found = [part for body in sorted(active) for part in conjuncts(problem.spec.bodies[body].formula)]
    return [] if any(map(executing_atoms, found)) else found


def moves_of(problem: Problem, pairs: Bdd) -> Moves | None:
    """Some pairs by what their sets nominally write; None where that is too many different things."""
    return problem.steps.moves(pairs, MOST_MOVES, keep_sets=True)


def attracted(problem: Problem, moves: Moves, target: Bdd) -> Bdd:
    """The safe states from where moves lead to a set, in any number of steps."""
    left, layer = problem.steps.safe & ~target, target
    while layer != problem.false:
        problem.context.check()
        layer = problem.steps.states_of(_leading(problem, moves, left, layer))
        left = left & ~layer
    return (problem.steps.safe & ~left) | target


def one_after_the_other(
    problem: Problem, target: Target, here: Bdd, subgoals: list[Formula]
) -> tuple[Bdd, Layers] | None:
    """Decisions for all states of a region, each for the first subgoal that is left; None where that does not do.

    A run reaches one subgoal with the fewest steps that keep those before it, then goes on to the next. The first
    subgoal is one that is reached like that from everywhere, and so on. The layers are disjoint sets that every step
    leads out of into an earlier one, the last of them empty; a state may need fewer steps than the number of its layer.
    """
    moves = moves_of(problem, target.pending & here)
    if moves is None:
        return None
    policy, kept, open_ = problem.false, here, list(subgoals)
    phases: list[Layers] = []
    while open_:
        for subgoal in open_:
            reached = kept & problem.encoding.formula(subgoal)
            found = _phase(problem, moves, kept & ~reached, reached | target.states)
            if found is not None:
                break
        else:
            return None
        open_.remove(subgoal)
        policy, kept = policy | found[0], reached
        phases.insert(0, found[1])
    layers = [target.states, *(layer for phase in phases for layer in phase)]
    for layer in layers:
        pairs = _leading(problem, moves, kept, layer)
        policy, kept = policy | preferred(problem.encoding, pairs), kept & ~problem.steps.states_of(pairs)
    bound = problem.spec.max_plan_length
    if kept != problem.false or (bound is not None and len(layers) > bound + 1):
        return None
    return policy, [*layers, problem.false]


def _phase(problem: Problem, moves: Moves, undecided: Bdd, reached: Bdd) -> tuple[Bdd, Layers] | None:
    """Decisions by which all undecided states reach a set, nearest first; None where some do not."""
    policy, layers = problem.false, list[Bdd]()
    while undecided != problem.false:
        problem.context.check()
        pairs = _leading(problem, moves, undecided, layers[-1] if layers else reached)
        if pairs == problem.false:
            return None
        policy = policy | preferred(problem.encoding, pairs)
        layers.append(problem.steps.states_of(pairs))
        undecided = undecided & ~layers[-1]
    return policy, layers


def _leading(problem: Problem, moves: Moves, states: Bdd, target: Bdd) -> Bdd:
    """The pairs in some states by which a move leads into a set: move by move, for each may matter in few states."""
    manager, bits = problem.encoding.manager, problem.encoding.assignment_bits
    return manager.union(
        here & pairs
        for written, pairs in moves.items()
        if (here := states & manager.cofactor(target, bits(written))) != problem.false
    )
