"""Restoring sets of proved minimal duration, in one step (`docs/semantics.md`, sections 5 and 6)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tumato_symbolic.game import Layers, Problem, shortest_decisions
from tumato_symbolic.limits import has_z3
from tumato_symbolic.symbolic import Bdd, Encoding, lasting, least_duration

if TYPE_CHECKING:
    from tumato_symbolic.synthesis.solver import CheapestSet


def restoring_policy(problem: Problem, ranks: Sequence[Layers]) -> Bdd:
    """Decisions for all unsafe states, each of which takes the smallest duration.

    `ranks` are those of the policy in safe states. A whole region at a time: the smallest duration of any serving set
    in any remaining state is found, by Z3 where there is one, and proved to be the smallest; every state where a set of
    that duration serves is decided, and the rest asked again.
    """
    manager, steps = problem.encoding.manager, problem.steps
    pairs = steps.allowed & steps.unsafe
    if pairs == problem.false:
        return problem.false
    serving = manager.union(
        pairs & target.pending & problem.own(target, steps.before(manager.union(layers)))
        for target, layers in zip(problem.targets, ranks, strict=True)
    )
    if serving == problem.false:
        return problem.false
    policy, cheapest = problem.false, _cheapest(problem.encoding, serving)
    while (duration := cheapest.minimum()) is not None:
        cheap = serving & lasting(problem.encoding, duration)
        restored = steps.states_of(cheap)
        policy = policy | shortest_decisions(problem, ranks, restored, cheap)
        serving = serving & ~restored
        cheapest.exclude(restored)
    return policy


class CheapestByDiagram:
    """What `CheapestSet` asks of Z3, asked of the diagram itself."""

    def __init__(self, encoding: Encoding, relation: Bdd) -> None:
        self._encoding, self._relation = encoding, relation

    def exclude(self, states: Bdd) -> None:
        """Remove states from the relation."""
        self._relation = self._relation & ~states

    def minimum(self) -> int | None:
        """The smallest duration in what is left of the relation; None where nothing is left."""
        choices = self._encoding.manager.exists(self._encoding.all_state_bits, self._relation)
        return least_duration(self._encoding, choices)


def _cheapest(encoding: Encoding, relation: Bdd) -> CheapestSet | CheapestByDiagram:
    if not has_z3():
        return CheapestByDiagram(encoding, relation)
    from tumato_symbolic.synthesis.solver import CheapestSet

    return CheapestSet(encoding, relation)
