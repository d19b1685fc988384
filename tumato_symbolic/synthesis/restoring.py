"""Restoring sets of proved minimal duration (`docs/semantics.md`, sections 5 and 6)."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.game import Layers, Problem, shortest_decisions
from tumato_symbolic.symbolic import Bdd, lasting


def restoring_policy(problem: Problem, ranks: Sequence[Layers]) -> tuple[Bdd, tuple[int, ...]]:
    """Decisions for all unsafe states, and the distinct durations that they take.

    `ranks` are those of the policy in safe states. A whole region at a time: Z3 finds the smallest duration of any
    serving set in any remaining state and proves that there is none below; every state where a set of that duration
    serves is decided, and the rest asked again.
    """
    from tumato_symbolic.synthesis.solver import CheapestSet

    manager, steps = problem.encoding.manager, problem.steps
    pairs = steps.allowed & steps.unsafe
    serving = manager.union(
        pairs & target.pending & steps.before(manager.union(layers))
        for target, layers in zip(problem.targets, ranks, strict=True)
    )
    policy, durations = problem.false, []
    if serving == problem.false:
        return policy, ()
    cheapest = CheapestSet(problem.encoding, serving)
    while (duration := cheapest.minimum()) is not None:
        durations.append(duration)
        cheap = serving & lasting(problem.encoding, duration)
        restored = steps.states_of(cheap)
        policy = policy | shortest_decisions(problem, ranks, restored, cheap)
        serving = serving & ~restored
        cheapest.exclude(restored)
    return policy, tuple(durations)
