"""Goals: every nominal run reaches its residual goal within the bound (`docs/semantics.md`, section 5)."""

from __future__ import annotations

from tumato_symbolic.semantics import Residual, State, follow
from tumato_symbolic.verify.by_z3.encoding import is_true
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.rank_source import RankSource
from tumato_symbolic.verify.by_z3.rank_terms import RankProof
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import conjunction, negation, same
from tumato_symbolic.verify.claimed_ranks import NOT_ALL
from tumato_symbolic.verify.decisions import LARGEST_TABLE
from tumato_symbolic.verify.result import PropertyResult, Refutation


def prove_goals(problem: PolicyProblem, source: RankSource) -> PropertyResult:
    """From every state where the policy acts, its nominal run reaches the residual goal in 1 to `L` steps.

    Decisions that are not allowed are not followed. Raises `UndecidedError`.
    """
    goals = [goal for goal in _residuals(problem) if goal.bodies or problem.spec.restores_stepwise]
    return _by_certificate(problem, source, goals) or _by_following(problem, source, goals)


def _residuals(problem: PolicyProblem) -> list[Residual]:
    """The residual goals of all acting states, in an order that does not depend on which Z3 finds first."""
    executed = {
        action: problem.name(conjunction((problem.goals.executing(action, problem.executed), mentioned)), "x")
        for action, mentioned in problem.goals.mentioned_actions().items()
    }
    found: list[Residual] = []
    deadline = problem.deadline()
    with problem.solver.scope(problem.acting):
        while (answer := problem.solver.ask(deadline=deadline)) == "sat":
            model = problem.solver.model
            goal = Residual(
                frozenset(body for body, term in problem.goals.active.items() if is_true(model, term)),
                frozenset(action for action, term in executed.items() if is_true(model, term)),
            )
            found.append(goal)
            terms = [same(term, body in goal.bodies) for body, term in problem.goals.active.items()]
            terms += [same(term, action in goal.executed) for action, term in executed.items()]
            problem.solver.add(negation(conjunction(terms)))
    if answer == "unknown":
        raise UndecidedError("there are no other residual goals")
    return sorted(found, key=lambda goal: (sorted(goal.bodies), sorted(goal.executed)))


def _by_certificate(problem: PolicyProblem, source: RankSource, goals: list[Residual]) -> PropertyResult | None:
    """The proof with the ranks that came with the policy, or a failing run; None where they do not serve.

    After a failing run the other ranks are looked at all the same: they may be wrong as well.
    """
    if not source.check_claimed():
        return None
    failed, whole = None, True
    try:
        for goal in goals:
            claimed = source.claimed(goal)
            if claimed is None:
                source.lacks(goal)
                whole = False
                continue
            proof = RankProof(problem, claimed)
            state = proof.first_beyond(source.has_pending_goal)
            if state is None:
                continue
            failed, whole = failed or _failing(problem, source, state), False
            if proof.first_too_large(source.has_pending_goal) is not None:
                source.reject(f"its ranks of {source.described(goal)} exceed the bound")
                return failed
            source.lacks(goal, state)
    except UndecidedError:
        if failed is None:
            raise
        source.fall_short(NOT_ALL)
    if not whole:
        return failed
    source.serve()
    return _proved(goals)


def _by_following(problem: PolicyProblem, source: RankSource, goals: list[Residual]) -> PropertyResult:
    """Follow all runs: one fails, or their lengths are ranks, which are then proved."""
    if source.decisions.rows is None:
        why = f"there is no certificate that holds, and over {LARGEST_TABLE} states, too many to follow all runs"
        raise UndecidedError("every run reaches its goal", why)
    failing = next(filter(source.has_pending_goal, source.ranks.missed()), None)
    if failing is not None:
        failed = _failing(problem, source, failing)
        if failed is None:
            raise RuntimeError(f"the run from {failing} reaches its goal, against its rank")
        return failed
    for goal in goals:
        proof = RankProof(problem, source.recomputed(goal))
        if not proof.decreases() or proof.first_beyond(source.has_pending_goal) is not None:
            raise RuntimeError(f"the lengths of runs are no ranks of {goal}")
    return _proved(goals)


def _proved(goals: list[Residual]) -> PropertyResult:
    """One obligation that there are no other residual goals, and two for each."""
    return PropertyResult("goals", "proved", 1 + 2 * len(goals), "z3")


def _failing(problem: PolicyProblem, source: RankSource, state: State) -> PropertyResult | None:
    """The refutation by the run from `state`; None where it reaches its goal."""
    chosen = source.decisions[state]
    run = follow(problem.spec, source.decisions, state, chosen)
    if run.end == "goal":
        return None
    return PropertyResult("goals", "refuted", refutation=Refutation("goal-missed", state, chosen, run=run))
