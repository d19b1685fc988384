"""From a specification to a policy: the pipeline, what is counted, and the format of the policy."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Literal

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.game import (
    ClosedLoop,
    Evaluation,
    Evaluator,
    Layers,
    OwnRegions,
    Problem,
    build_problem,
    closed_loop,
    in_time,
    own_region_policy,
    with_all_sets,
)
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.policy import Policy, as_table
from tumato_symbolic.semantics import count_states
from tumato_symbolic.semantics.lint_findings import no_valid_state
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.spec.many_goals import many_told
from tumato_symbolic.symbolic import Backend, available_backend
from tumato_symbolic.synthesis.certificate import policy_diagram
from tumato_symbolic.synthesis.completing import completed, count_decided, unrealizable
from tumato_symbolic.synthesis.counting import restored_in
from tumato_symbolic.synthesis.failing import failing_states, failures_of, has_stuck_states, reason_of
from tumato_symbolic.synthesis.leaving import leaving
from tumato_symbolic.synthesis.lint import lint
from tumato_symbolic.synthesis.one_at_a_time import not_enough, one_at_a_time
from tumato_symbolic.synthesis.parts import Solve
from tumato_symbolic.synthesis.races import races
from tumato_symbolic.synthesis.restoring import restoring_policy
from tumato_symbolic.synthesis.result import (
    Realizable,
    Statistics,
    SynthesisResult,
    Undecided,
    Unrealizable,
)

TABLE_LIMIT = 10_000
"""Up to so many valid states a policy is written as a table, unless another format is asked for."""

TABLE_MAXIMUM = 1_000_000
"""More states are never written as a table."""

MOST_NODES = 1_000_000
"""Where the allowed sets of actions make a larger diagram, a policy of one action at a time is looked for first."""

PolicyFormat = Literal["auto", "table", "diagram"]


def synthesize(
    spec: Spec,
    ordering: Ordering | None = None,
    *,
    policy_format: PolicyFormat = "auto",
    backend: Backend | None = None,
    context: Context | None = None,
    certify: bool = True,
    diagnose: bool = True,
) -> SynthesisResult:
    """Synthesize a policy for `spec`, or find out why there is none.

    `ordering` overrides the specification's effect ordering (default: what it says, else `any`). `context` limits the
    work; it is told the name of each stage, and learns what the outcome would be if a limit were met now. Without
    `certify`, what is unrealizable comes without a certificate, and without `diagnose` without what several steps would
    do for states that cannot be restored in one. Raises `UserError` where no state is valid.
    """
    context = context or Context()
    try:
        engine = backend or available_backend()
        problem = build_problem(spec, ordering or spec.ordering, engine, context, most=MOST_NODES)
        with problem.encoding.manager.within_memory():
            outcome = _solve(problem, policy_format, certify)
            if problem.steps.one_at_a_time and isinstance(outcome, Undecided):
                problem = with_all_sets(problem)
                outcome = _solve(problem, policy_format, certify, (not_enough(),))
            if diagnose and isinstance(outcome, Unrealizable) and not spec.starts:
                return _diagnosed(problem, outcome)
            return outcome
    except LimitReachedError as limit:
        return stopped(context.known, str(limit))


def _diagnosed(problem: Problem, answer: Unrealizable) -> Unrealizable:
    from tumato_symbolic.synthesis.diagnosis import restorability

    problem.context.learn(answer)
    return replace(answer, restorability=restorability(problem))


def stopped(known: object, limit: str) -> Unrealizable | Undecided:
    """The outcome of work that a limit ended, from what its context had learned by then."""
    if isinstance(known, Unrealizable | Undecided):
        return replace(known, limit=limit)
    return Undecided(limit, None)


def _solve(
    problem: Problem, policy_format: PolicyFormat, certify: bool, remarks: tuple[Diagnostic, ...] = ()
) -> SynthesisResult:
    """The pipeline behind the encoding; `remarks` are worth knowing whatever the answer."""
    context, statistics = problem.context, _statistics(problem)
    if not statistics.valid:
        raise UserError((no_valid_state(problem.spec),))
    if policy_format == "table" and statistics.valid > TABLE_MAXIMUM:
        message = f"a table of {statistics.valid:,} states is more than the {TABLE_MAXIMUM:,} that can be written"
        raise UserError((Diagnostic(Code.TUM508, message, None, "use `--policy-format diagram`"),))
    context.learn(Undecided("", statistics))
    context.tell("looking for likely mistakes")
    warnings = (*lint(problem), *remarks)
    so_far = Undecided("", statistics, warnings)
    context.learn(so_far)
    solve = partial(_decide, policy_format=policy_format, certify=certify)
    if problem.steps.one_at_a_time:
        return _decide_one_at_a_time(problem, so_far, solve, certify=certify)
    if problem.spec.starts:
        from tumato_symbolic.synthesis.starts import solve_from_starts

        return solve_from_starts(problem, so_far, solve, certify=certify)
    return solve(problem, so_far, None)


def _decide_one_at_a_time(problem: Problem, so_far: Undecided, solve: Solve, *, certify: bool) -> SynthesisResult:
    """What one action at a time shows: a policy, or that there is none; `so_far` where it takes sets of several."""
    from tumato_symbolic.synthesis.lost_subgoals import without_plan

    if has_stuck_states(problem):
        return so_far
    problem.context.tell("looking for states that miss a part of their goal")
    answer = without_plan(problem, so_far, certify=certify)
    if answer is not None:
        return answer
    if problem.spec.starts:
        from tumato_symbolic.synthesis.starts import solve_everywhere

        found = solve_everywhere(problem, so_far, solve)
    else:
        found = solve(problem, so_far, None)
    return found if isinstance(found, Realizable) else so_far


def _decide(
    problem: Problem,
    so_far: Undecided,
    own: OwnRegions | None = None,
    *,
    policy_format: PolicyFormat,
    certify: bool,
) -> SynthesisResult:
    """A policy for all valid states of a problem, or why there is none.

    `so_far` has what was counted and warned of; `own` is the policy of the own regions, if it is known.
    """
    context, statistics, warnings = problem.context, so_far.statistics, so_far.warnings
    assert statistics is not None, "states are counted first"
    many = many_told(problem.spec)
    context.tell("solving each goal in its own region" + (f" ({many})" if many else ""))
    own = own or own_region_policy(problem)
    policy = own.policy
    statistics = replace(statistics, own_region=count_decided(problem, policy))
    context.learn(replace(so_far, statistics=statistics))
    undecided, evaluator = problem.steps.safe & ~problem.steps.states_of(policy), Evaluator(problem)
    evaluation = evaluator.evaluate(policy, own.ranks) if undecided == problem.false else None
    if evaluation is None or evaluation.failing != problem.false or has_stuck_states(problem):
        context.tell("measuring distances")
        failing = failing_states(problem)
        if failing.kinds:
            from tumato_symbolic.synthesis.no_part import failing_at_once
            from tumato_symbolic.synthesis.unrealizability import certified

            answer = unrealizable(problem, failures_of(problem, failing.kinds), statistics, warnings)
            if not certify:
                return answer
            reason = reason_of(problem, failing) or failing_at_once(problem, failing)
            return replace(answer, certificate=certified(problem, reason))
        so_far = replace(so_far, statistics=statistics)
        done = completed(evaluator, policy, failing.apart, so_far, way=failing.way, certify=certify)
        if isinstance(done, Undecided | Unrealizable):
            return done
        evaluation, statistics = done.evaluation, done.statistics
    complete, statistics, raced = _finish(problem, evaluation, statistics)
    remarks = (*raced, *leaving(problem, complete, undecided), *one_at_a_time(problem, statistics))
    decided = problem.encoding.count_states(problem.steps.valid)
    return Realizable(_as(complete, policy_format, decided), statistics, (*warnings, *remarks))


def _finish(
    problem: Problem, found: Evaluation, statistics: Statistics
) -> tuple[Policy, Statistics, tuple[Diagnostic, ...]]:
    """Add restoring sets and the certificate to a policy for the safe states that serves every valid state.

    With it, what there is to warn of.
    """
    steps, restoration, tell = problem.steps, found.restoration, problem.context.tell
    ranks = found.ranks if restoration is None else restoration.ranks
    tell("choosing restoring sets")
    if restoration is None:
        restoring = restoring_policy(problem, in_time(problem, ranks))
    else:
        restoring = restoration.policy
        statistics = replace(statistics, restored=restored_in(problem, restoration))
    policy = found.closed_loop.policy | restoring
    assert steps.states_of(policy) == steps.valid, "a winning state was left without a decision"
    loop = found.closed_loop if restoring == problem.false else closed_loop(problem, policy)
    statistics = replace(statistics, longest_run=_longest_run(problem, loop, in_time(problem, ranks)))
    tell("extracting the policy and its certificate")
    return policy_diagram(problem, policy, ranks, restoration), statistics, races(problem, policy)


def _longest_run(problem: Problem, found: ClosedLoop, ranks: Sequence[Layers]) -> int:
    """The largest number of steps that a run of a policy takes to its goal."""
    deepest = max(map(len, ranks))
    return next(
        1 + rank
        for rank in reversed(range(deepest))
        for number, layers in enumerate(ranks)
        if rank < len(layers) and found.first_steps(number, layers[rank]) != problem.false
    )


def _as(policy: Policy, policy_format: PolicyFormat, states: int) -> Policy:
    """The policy as a table where that is asked for, or small enough."""
    if policy_format == "diagram" or (policy_format == "auto" and states > TABLE_LIMIT):
        return policy
    table = as_table(policy, states)
    assert table is not None, "the table has one row for every valid state"
    return replace(policy, decisions=table)


def _statistics(problem: Problem) -> Statistics:
    steps, count = problem.steps, problem.encoding.count_states
    valid, safe = count(steps.valid), count(steps.safe)
    backend = problem.encoding.manager.backend
    found = Statistics(count_states(problem.spec), valid, safe, valid - safe, None, backend, steps.ordering)
    return replace(found, one_at_a_time=steps.one_at_a_time)
