"""What own regions leave open: routes, decisions changed where goals interact, or the proof that these conflict."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.game import (
    Alone,
    Evaluation,
    Evaluator,
    Layers,
    Problem,
    route,
    shortest_decisions,
)
from tumato_symbolic.spec.many_goals import many_told
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis.overriding import override, revert_unneeded
from tumato_symbolic.synthesis.result import (
    Failure,
    Statistics,
    Undecided,
    Unrealizable,
)

if TYPE_CHECKING:
    from tumato_symbolic.synthesis.conflict import RepairConflict


def unrealizable(
    problem: Problem, failures: tuple[Failure, ...], statistics: Statistics, warnings: tuple[Diagnostic, ...]
) -> Unrealizable:
    """*Unrealizable*, before there is a certificate for it.

    It is not known to be the answer yet where a smaller part may do, or sets of more actions.
    """
    answer = Unrealizable(failures, statistics, None, warnings, spec=problem.spec)
    if problem.spec.starts or problem.steps.one_at_a_time:
        return answer
    problem.context.learn(answer)
    problem.context.tell("certifying that there is no policy")
    return answer


class Completed(Struct, frozen=True):
    """A policy for all safe states that serves every valid state."""

    evaluation: Evaluation
    statistics: Statistics


def completed(
    evaluator: Evaluator, policy: Bdd, apart: tuple[Layers, ...], so_far: Undecided, *, way: Alone | None, certify: bool
) -> Completed | Unrealizable | Undecided:
    """Decide what the own regions leave open, changing earlier decisions only where that is needed.

    `apart` are the distances from the targets; `way` has the steps that runs may take, where safety may take several
    steps to restore.
    """
    problem, statistics = evaluator.problem, so_far.statistics
    steps, tell = problem.steps, problem.context.tell
    assert statistics is not None, "states are counted first"
    tell("routing through solved states")
    undecided = steps.safe & ~steps.states_of(policy)
    policy = route(problem, policy, undecided, steps.safe, problem.targets)
    undecided = steps.safe & ~steps.states_of(policy)
    policy = policy | shortest_decisions(problem, apart, undecided, steps.allowed)
    found = evaluator.evaluate(policy)
    if found.failing == problem.false:
        return Completed(found, statistics)
    tell("overriding decisions of other goals")
    found = override(evaluator, found, apart)
    changed, forced = found.closed_loop.policy, problem.false
    if found.failing != problem.false:
        so_far = replace(so_far, statistics=statistics)
        repaired = _repaired(evaluator, found, apart, so_far, way=way, certify=certify)
        if isinstance(repaired, Unrealizable | Undecided):
            return repaired
        if isinstance(repaired, Evaluation):
            turned = policy & ~repaired.closed_loop.policy
            return Completed(repaired, replace(statistics, changed=count_decided(problem, turned)))
        changed, forced = repaired
    tell("reverting changes that are not needed")
    changed = revert_unneeded(evaluator.where(forced), policy, changed)
    statistics = replace(statistics, changed=count_decided(problem, policy & ~changed))
    if forced == problem.false:
        return Completed(evaluator.evaluate(changed), statistics)
    from tumato_symbolic.synthesis.improving import Improving

    tell("improving decisions in unsafe states")
    return Completed(Improving(evaluator, changed, forced).run(), statistics)


def _repaired(
    evaluator: Evaluator,
    so_far: Evaluation,
    apart: tuple[Layers, ...],
    answer: Undecided,
    *,
    way: Alone | None,
    certify: bool,
) -> tuple[Bdd, Bdd] | Evaluation | Unrealizable | Undecided:
    """A policy that serves every valid state, and those of its decisions in unsafe states that repair has made.

    Or what a tour achieves, where repair takes long; or why there is none: the goals are in conflict.
    """
    from tumato_symbolic.synthesis.conflict import RepairConflict
    from tumato_symbolic.synthesis.repair import ROUNDS, RoundsExhaustedError

    problem = evaluator.problem
    try:
        found = _repaired_or_toured(evaluator, so_far, apart, way)
    except RoundsExhaustedError:
        return replace(answer, limit=f"{ROUNDS:,} rounds of repair did not settle how the goals interact")
    if isinstance(found, RepairConflict):
        return _in_conflict(problem, found, answer, certify=certify)
    return found


def _repaired_or_toured(
    evaluator: Evaluator, so_far: Evaluation, apart: tuple[Layers, ...], way: Alone | None
) -> tuple[Bdd, Bdd] | Evaluation | RepairConflict:
    """Some rounds of repair, a look for a tour, and the other rounds. Raises `RoundsExhaustedError` after these."""
    from tumato_symbolic.synthesis.conflict import RepairConflict
    from tumato_symbolic.synthesis.repair import Repair, RoundsExhaustedError
    from tumato_symbolic.synthesis.stepwise_repair import StepwiseRepair
    from tumato_symbolic.synthesis.touring import ROUNDS_BEFORE_TOUR, tour

    problem, policy = evaluator.problem, so_far.closed_loop.policy
    goals = many_told(problem.spec) if problem.goals_are_many else f"{len(problem.targets):,} residual goals"
    stage = f"repairing decisions where goals interact ({goals})"
    problem.context.tell(stage)
    repair = Repair(evaluator, policy, apart) if way is None else StepwiseRepair(evaluator, policy, apart, way)
    try:
        found = repair.run(most=ROUNDS_BEFORE_TOUR)
    except RoundsExhaustedError:
        problem.context.tell("looking for a tour through all goals")
        toured = tour(evaluator, so_far)
        if toured is not None:
            return toured
        problem.context.tell(stage)
        found = repair.run()
    if isinstance(found, RepairConflict):
        return found
    return found, repair.forced if isinstance(repair, StepwiseRepair) else problem.false


def _in_conflict(problem: Problem, found: RepairConflict, so_far: Undecided, *, certify: bool) -> Unrealizable:
    """That there is no policy since goals are in conflict."""
    from tumato_symbolic.synthesis.unrealizability import certified, conflict

    assert so_far.statistics is not None, "states are counted first"
    failure = Failure("conflict", len(found.states), found.states[0], found.states)
    answer = unrealizable(problem, (failure,), so_far.statistics, so_far.warnings)
    if not certify:
        return answer
    return replace(answer, certificate=certified(problem, conflict(problem, found)))


def count_decided(problem: Problem, policy: Bdd) -> int:
    """In how many states a policy decides something."""
    return problem.encoding.count_states(problem.steps.states_of(policy))
