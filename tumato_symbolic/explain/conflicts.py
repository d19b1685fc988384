"""Why no policy serves some states together although each of them has a plan."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.explain.elements import Elements, keep_only
from tumato_symbolic.explain.failing_states import build_kept_problem
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import trial
from tumato_symbolic.game import Evaluator, Problem, distances, shortest_decisions, winning
from tumato_symbolic.semantics import State
from tumato_symbolic.symbolic import Bdd, preferred, regions
from tumato_symbolic.synthesis import Unrealizable
from tumato_symbolic.synthesis.conflict import RepairConflict
from tumato_symbolic.synthesis.repair import Repair, RoundsExhaustedError


def conflict_core(requirements: Requirements, states: Sequence[State], among: Elements) -> Elements:
    """A set of elements, out of some that suffice, because of which nothing serves the states together.

    It is minimal, but for elements of which it cannot be found out in time whether they are needed. Where dropping
    assumptions makes more states valid, a run may end in those without an allowed set, but not go on. With starts
    assumptions are kept: without them there might be more starts.
    """
    wanted = requirements.manager.union(map(requirements.encoding.state_cube, states))
    always = frozenset(each for each in among if requirements.spec.starts and each.kind == "assumption")
    items = [each for each in requirements.elements if each in among - always]
    return minimal(items, lambda kept: conflicting(requirements, wanted, kept | always))


def conflicting(requirements: Requirements, wanted: Bdd, kept: Elements) -> bool:
    """Whether it is shown that no policy serves these states when only some elements are kept."""
    if requirements.spec.restores_stepwise or requirements.spec.starts:
        return isinstance(trial(requirements, keep_only(requirements.spec, kept)), Unrealizable)
    valid = requirements.steps(kept).valid
    problem = build_kept_problem(requirements, kept, regions(requirements.encoding, valid))
    ranks = distances(problem)
    if (wanted & ~winning(problem, ranks, problem.steps.allowed)) != requirements.false:
        return True
    policy = shortest_decisions(problem, ranks, problem.steps.safe, problem.steps.allowed)
    try:
        repair = Repair(Evaluator(problem), _completed(problem, policy), ranks)
        return isinstance(repair.run(wanted), RepairConflict)
    except RoundsExhaustedError:
        return False


def _completed(problem: Problem, policy: Bdd) -> Bdd:
    """Some decision for every other safe state that has one."""
    steps = problem.steps
    return policy | preferred(problem.encoding, steps.allowed & steps.safe & ~steps.states_of(policy))
