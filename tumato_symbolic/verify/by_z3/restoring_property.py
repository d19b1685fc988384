"""Restoring: every unsafe state gets back to safety (`docs/semantics.md`, sections 9 and 10)."""

from __future__ import annotations

from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.effort_source import EffortSource
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.result import PropertyResult, Refutation
from tumato_symbolic.verify.ways_back import RestoringWitnesses, TooFarError, WaysBack

OBLIGATIONS = 3
"""Efforts are enough for one step and for nominal outcomes, for every other outcome, and no state is without."""


def prove_restoring(problem: PolicyProblem, source: EffortSource, ordering: Ordering) -> PropertyResult:
    """Every unsafe state where the policy acts is restored: in the worst case; under `fair`, along its nominal run.

    Raises `UndecidedError`.
    """
    claimed = source.claimed()
    if claimed is not None:
        without = claimed.first_without()
        if without is None:
            source.ranks.serve()
            return _proved()
        source.ranks.lacks_effort(without)
        refuted = _refuted(problem, source, ordering, without)
        if refuted is not None:
            return refuted
    elif source.ranks.roots:
        source.ranks.tells_nothing_of_restoring()
    without = source.first_lost()
    if without is None:
        return _proved()
    return RestoringWitnesses(problem.spec, source.ranks.decisions, ordering).not_restored(without)


def _proved() -> PropertyResult:
    return PropertyResult("restoring", "proved", OBLIGATIONS, "z3")


def _refuted(problem: PolicyProblem, source: EffortSource, ordering: Ordering, state: State) -> PropertyResult | None:
    """The refutation by a state for which the certificate has no effort; None where there is one, or it is too far."""
    decisions = source.ranks.decisions
    try:
        run = WaysBack(problem.spec, decisions, ordering).lost(state)
    except TooFarError:
        return None
    if run is None:
        return None
    refutation = Refutation("not-restored", state, decisions[state], run=run)
    return PropertyResult("restoring", "refuted", refutation=refutation)
