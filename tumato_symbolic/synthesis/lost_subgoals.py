"""That there is no policy, shown without all sets of actions: part of a goal cannot be reached from some states.

With one action at a time it is found which states these are. Where no set with actions that write what tells them from
the others leads out of them, none does; and where one action at a time serves all others, they are exactly those that
fail.
"""

from __future__ import annotations

from msgspec.structs import replace

from tumato_symbolic.game import Problem
from tumato_symbolic.game.subgoals import attracted, moves_of, one_after_the_other, subgoals_of
from tumato_symbolic.symbolic import Bdd, TooManyNodesError, applicable_parts, compatible_sets
from tumato_symbolic.synthesis.completing import unrealizable
from tumato_symbolic.synthesis.failing import failures_of
from tumato_symbolic.synthesis.result import Undecided, Unrealizable
from tumato_symbolic.synthesis.unrealizability import certified, no_plan

MOST_NODES = 1_000_000
"""With larger diagrams it is not found out whether some set leads out of states."""


def without_plan(problem: Problem, so_far: Undecided, *, certify: bool) -> Unrealizable | None:
    """The answer that some states have no plan, which are all that fail; None where that is not found out."""
    assert so_far.statistics is not None, "states are counted first"
    lost = _lost(problem)
    if lost == problem.false:
        return None
    statistics = replace(so_far.statistics, one_at_a_time=False)
    answer = unrealizable(problem, failures_of(problem, {"no-plan": lost}), statistics, so_far.warnings)
    if not certify:
        return answer
    distances = [[problem.steps.safe & ~lost, problem.false]]
    state = problem.encoding.first_state(lost)
    return replace(answer, certificate=certified(problem, no_plan(problem, state, distances)))


def _lost(problem: Problem) -> Bdd:
    """The states that fail, if they are known; else none."""
    spec, steps, false = problem.spec, problem.steps, problem.false
    if spec.starts or spec.max_plan_length is not None or steps.unsafe != false or len(problem.regions) != 1:
        return false
    (active,), (target, *_) = problem.regions, problem.targets
    subgoals, lost, moves = subgoals_of(problem, active), false, moves_of(problem, target.pending & steps.safe)
    if moves is None:
        return false
    for subgoal in subgoals:
        far = steps.safe & ~attracted(problem, moves, steps.safe & problem.encoding.formula(subgoal))
        if far != false and not _is_left_by_none(problem, far):
            return false
        lost = lost | far
    if lost == false or one_after_the_other(problem, target, steps.safe & ~lost, subgoals) is None:
        return false
    return lost


def _is_left_by_none(problem: Problem, states: Bdd) -> bool:
    """Whether no set of actions leads out of some safe states to others.

    Only what is needed of the actions that write what tells these states apart is looked at: more sets than are
    allowed.
    """
    encoding, steps, spec = problem.encoding, problem.steps, problem.spec
    manager = encoding.manager
    tested = manager.support(states)
    telling = {v for v, bits in enumerate(encoding.state_bits) if not tested.isdisjoint(bits)}
    writing = [any(v in telling for case in cases for v, _ in spec.actions[case].nominal) for cases in spec.cases]
    leaving = states & steps.before(steps.safe & ~states)
    try:
        with manager.at_most(MOST_NODES):
            for writes, part in zip(writing, applicable_parts(encoding), strict=True):
                leaving = manager.bounded(leaving & part) if writes else leaving
            return manager.bounded(leaving & compatible_sets(encoding)) == problem.false
    except TooManyNodesError:
        return False
