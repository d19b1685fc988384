"""How many states are restored in how many steps, where safety may take several to restore."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from tumato_symbolic.game import Problem, Restoration
from tumato_symbolic.semantics import Effort
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis.result import RestoredIn


def restored_in(problem: Problem, restoration: Restoration) -> RestoredIn:
    """Exact counts of the unsafe states that a policy restores."""
    count = problem.encoding.count_states

    def by_steps(efforts: Mapping[Effort, Bdd]) -> tuple[tuple[int, int], ...]:
        found: Counter[int] = Counter()
        for (_, steps), states in efforts.items():
            found[steps] += count(states)
        return tuple(sorted(found.items()))

    return RestoredIn(
        by_steps(restoration.worst),
        by_steps(restoration.nominal),
        max((duration for duration, _ in (*restoration.worst, *restoration.nominal)), default=0),
        tuple(count(states) for states, _ in problem.steps.levels),
    )
