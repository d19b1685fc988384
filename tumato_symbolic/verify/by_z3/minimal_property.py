"""Minimal: no cheaper allowed set restores safety and still serves the goal (`docs/semantics.md`, section 5)."""

from __future__ import annotations

from typing import TypeAlias

import z3

from tumato_symbolic.semantics import (
    ActionSet,
    Residual,
    Run,
    State,
    duration,
    follow,
    residual_goal,
)
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.choice import Choice
from tumato_symbolic.verify.by_z3.outcomes import objections_to
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem, unknown_bits
from tumato_symbolic.verify.by_z3.rank_source import RankSource
from tumato_symbolic.verify.by_z3.rank_terms import RankFunction
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, implies, negation
from tumato_symbolic.verify.result import PropertyResult, Refutation

Cheaper: TypeAlias = tuple[State, ActionSet, Run]

CLAIM = "no cheaper allowed set serves as well"


def prove_minimal(problem: PolicyProblem, source: RankSource, ordering: Ordering) -> PropertyResult:
    """No valid unsafe state has a cheaper allowed set whose run, continued by the policy, reaches its residual goal.

    Raises `UndecidedError`.
    """
    search = _Search(problem, source, ordering)
    found = search.find()
    if found is None:
        return PropertyResult("minimal", "proved", 1 + len(search.ranked), "z3")
    state, cheaper, run = search.improve(found)
    refutation = Refutation("not-minimal", state, source.decisions[state], run=run, cheaper=cheaper)
    return PropertyResult("minimal", "refuted", refutation=refutation)


class _Search:
    """The search for an unsafe state with a better set, by lazy refinement.

    The solver proposes a set that meets every condition but two, which speak of *all* outcomes and of a whole run.
    Both are checked by `semantics`. A proposal that fails teaches a lemma that holds in all states: these effects in
    this order must lead to a safe state; with this residual goal, the rank of the next state must be below the bound.
    """

    def __init__(self, problem: PolicyProblem, source: RankSource, ordering: Ordering) -> None:
        self._problem = problem
        self._source = source
        self._ordering = ordering
        self._solver = problem.new_solver()
        self._choice = Choice(problem.spec, problem.state, self._solver)
        self.ranked: dict[Residual, RankFunction] = {}
        self._solver.add(problem.decided, negation(problem.safe), *self._choice.conditions())
        self._solver.add(self._choice.cheaper_than(problem.executed))

    def find(self, *literals: Term) -> Cheaper | None:
        """An unsafe state that meets `literals` with a better set, confirmed, and its run; None where there is none."""
        deadline = self._problem.deadline()
        while (answer := self._solver.ask(*literals, deadline=deadline)) == "sat":
            state, chosen = self._problem.state.read(self._solver.model), self._choice.read(self._solver.model)
            run = self._confirm(state, chosen)
            if run is not None:
                return state, chosen, run
        if answer == "unknown":
            raise UndecidedError(CLAIM)
        return None

    def _confirm(self, state: State, chosen: ActionSet) -> Run | None:
        """The run of a proposal, if it is better than the policy; otherwise learn why it is not."""
        spec = self._problem.spec
        failed = objections_to(spec, state, chosen, self._ordering, self._problem.deadline())
        if failed:
            for objection in failed:
                self._solver.add(self._choice.lemma(objection))
            return None
        run = follow(spec, self._source.decisions, state, chosen)
        if run.end != "goal":
            self._learn_ranks(residual_goal(spec, state, chosen))
            return None
        if duration(spec, chosen) >= duration(spec, self._source.decisions[state]):
            raise RuntimeError(f"{sorted(chosen)} is not cheaper in {state}, against the solver")
        return run

    def _learn_ranks(self, goal: Residual) -> None:
        """A set with this residual goal steps to a state with a rank below the bound."""
        known = self.ranked.get(goal)
        if known is not None and not known.claimed:
            raise RuntimeError(f"the ranks of {goal} hold, and a run takes longer")
        ranks = self.ranked[goal] = self._source.lower_bound(goal) if known is None else self._source.exact(goal)
        mine = self._problem.goals.is_residual(goal, self._choice.executed)
        self._solver.add(implies(mine, ranks.within_bound(self._problem, self._choice.after)))

    def improve(self, found: Cheaper) -> Cheaper:
        """The first state, as declared, that has a better set, and its best one: cheapest, then smallest, then first.

        When time runs out on the way, the best so far.
        """
        spec, executed = self._problem.spec, self._choice.executed
        fixed: list[Term] = []
        try:
            for place, bit in enumerate(unknown_bits(self._problem.state)):
                literal = self._problem.literals(found[0])[place]
                if literal is bit and (better := self.find(*fixed, negation(bit))) is not None:
                    found, literal = better, negation(bit)
                fixed.append(literal)
            while better := self.find(*fixed, self._choice.lasts_at_most(duration(spec, found[1]) - 1)):
                found = better
            fixed.append(self._choice.lasts_at_most(duration(spec, found[1])))
            while better := self.find(*fixed, z3.AtMost(*executed, len(found[1]) - 1)):
                found = better
            fixed.append(z3.AtMost(*executed, len(found[1])))
            for term in executed:
                better = self.find(*fixed, term)
                found = better or found
                fixed.append(negation(term) if better is None else term)
        except UndecidedError:
            return found
        return found
