"""Rank functions as Z3 terms, and the obligations that make them true (`docs/certificate.md`)."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import TypeAlias

import z3
from msgspec import Struct

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import Residual, State
from tumato_symbolic.verify.by_z3.encoding import Place, diagram_terms
from tumato_symbolic.verify.by_z3.goal_terms import reached_term
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.solver import Answer, UndecidedError
from tumato_symbolic.verify.by_z3.step_counts import StepCounts
from tumato_symbolic.verify.by_z3.terms import Number, Term, conjunction, either, negation

AT_ONCE = 1.0
"""How many seconds Z3 may think about all ranks and decisions at once, before they are asked one by one."""

ONE_PART = 0.003
"""How many seconds one rank with one decision is expected to take; too many of them are rather asked at once."""

Rank: TypeAlias = int | None
"""A number of steps; None is never."""


def exactly(wanted: int) -> Callable[[Rank], bool]:
    """Whether a rank is this one."""
    return lambda rank: rank == wanted


def below(bound: float) -> Callable[[Rank], bool]:
    """Whether a rank is a number under `bound`."""
    return lambda rank: rank is not None and rank < bound


class RankFunction(Struct, frozen=True):
    """`N_c` of one residual goal: a rank or None for every state.

    A *claimed* one comes with the policy; it covers safe states, or all valid ones (`of_unsafe`). A *recomputed*
    one covers all states: it is 0 wherever the goal holds, and otherwise what the diagram says.
    """

    goal: Residual
    diagram: Diagram[Rank]
    root: Reference
    claimed: bool
    of_unsafe: bool = False

    @property
    def ranks(self) -> list[int]:
        """All ranks that may occur."""
        return sorted({0, *(leaf for leaf in self.diagram.leaves if leaf is not None)})

    def counts(self, problem: PolicyProblem) -> StepCounts:
        """How ranks are coded."""
        return StepCounts(self.ranks[-1], problem.context)

    def count(self, problem: PolicyProblem, place: Place) -> Number:
        """The rank of `place`; None is never."""
        code = self.counts(problem).code
        (rank,) = diagram_terms(self.diagram, [self.root], place, code)
        return rank if self.claimed else either(reached_term(problem.spec, self.goal, place), code(0), rank)

    def where(self, problem: PolicyProblem, place: Place, wanted: Callable[[Rank], bool]) -> Term:
        """The rank of `place` is a wanted one."""
        (term,) = diagram_terms(self.diagram, [self.root], place, wanted)
        return term if self.claimed else either(reached_term(problem.spec, self.goal, place), wanted(0), term)

    def within_bound(self, problem: PolicyProblem, place: Place) -> Term:
        """A step to `place` serves the goal: the rank there is at most `L - 1`; a number, where there is no bound."""
        bound = problem.spec.max_plan_length
        return self.where(problem, place, below(math.inf if bound is None else bound))


class RankProof:
    """The obligations on one rank function, over the states that it covers.

    Each is asked at once; where that takes too long, for every rank and decision apart.
    """

    def __init__(self, problem: PolicyProblem, ranks: RankFunction) -> None:
        self._problem = problem
        self._ranks = ranks
        self._covered: Term = True
        self._covered_after: Term = True
        if ranks.claimed:
            self._covered = problem.valid if ranks.of_unsafe else problem.safe
            self._covered_after = problem.valid_after if ranks.of_unsafe else problem.safe_after
        self._coded = ranks.counts(problem)
        self._reached = problem.name(reached_term(problem.spec, ranks.goal, problem.state), "reached")

    def decreases(self) -> bool:
        """`N` is an upper bound: 0 means that the goal holds, `j > 0` that the next state has a smaller rank."""
        here, after, names = self._counts()
        known = self._coded.is_number(here)
        steps = conjunction((self._problem.acting, self._covered_after))
        goes_down = conjunction((steps, z3.ULT(after, here)))
        wrong = either(here == 0, negation(self._reached), negation(goes_down))
        return self._holds("ranks decrease", [*names, self._covered, known, wrong], self._decreases_by_parts(steps))

    def _decreases_by_parts(self, steps: Term) -> Iterator[Term]:
        yield conjunction((self._here(exactly(0)), negation(self._reached)))
        for rank in self._ranks.ranks[1:]:
            yield conjunction((self._here(exactly(rank)), negation(conjunction((steps, self._after(below(rank)))))))

    def is_lower_bound(self) -> bool:
        """`N` is 0 where the goal holds, and nowhere over one more than in the next state; None is infinite."""
        here, after, names = self._counts()
        follows = conjunction((self._covered_after, negation(self._coded.exceeds_by_two(here, after))))
        wrong = either(self._reached, here != 0, conjunction((self._problem.acting, negation(follows))))
        return self._holds("ranks are nowhere too large", [*names, self._covered, wrong], self._bounds_by_parts())

    def _bounds_by_parts(self) -> Iterator[Term]:
        yield conjunction((self._reached, negation(self._here(exactly(0)))))
        moves = conjunction((negation(self._reached), self._problem.acting))
        yield conjunction((moves, negation(self._covered_after)))
        for rank in self._ranks.ranks:
            yield conjunction((moves, self._after(exactly(rank)), negation(self._here(below(rank + 2)))))

    def first_beyond(self, has_pending_goal: Callable[[State], bool]) -> State | None:
        """The first state with this residual goal that steps to one whose rank is not below the bound.

        States for which `has_pending_goal` is false are passed over.
        """
        near = conjunction((self._covered_after, self._ranks.within_bound(self._problem, self._problem.after)))
        return self._first_pending(negation(near), has_pending_goal)

    def first_too_large(self, has_pending_goal: Callable[[State], bool]) -> State | None:
        """The first one whose rank is a number, and not below the bound."""
        bound = self._problem.spec.max_plan_length
        if bound is None:
            return None
        large = self._after(lambda rank: rank is not None and rank >= bound)
        return self._first_pending(conjunction((self._covered_after, large)), has_pending_goal)

    def _first_pending(self, fault: Term, has_pending_goal: Callable[[State], bool]) -> State | None:
        problem = self._problem
        mine = problem.goals.is_residual(self._ranks.goal, problem.executed)
        deadline = problem.deadline()
        with problem.solver.scope(problem.acting, mine, fault):
            while (model := problem.first_model("ranks are below the bound", deadline=deadline)) is not None:
                state = problem.state.read(model)
                if has_pending_goal(state):
                    return state
                problem.solver.add(negation(conjunction(problem.literals(state))))
        return None

    def _here(self, wanted: Callable[[Rank], bool]) -> Term:
        return self._ranks.where(self._problem, self._problem.state, wanted)

    def _after(self, wanted: Callable[[Rank], bool]) -> Term:
        return self._ranks.where(self._problem, self._problem.after, wanted)

    def _counts(self) -> tuple[Number, Number, list[Term]]:
        """The ranks of `s` and of its successor, and what defines them."""
        width, problem = self._coded.width, self._problem
        here, after = (z3.BitVec(name, width, problem.context) for name in ("rank", "rank_after"))
        definitions = [
            here == self._ranks.count(problem, problem.state),
            after == self._ranks.count(problem, problem.after),
        ]
        return here, after, definitions

    def _holds(self, claim: str, violation: list[Term], parts: Iterator[Term]) -> bool:
        """Whether `violation` is impossible; `parts`, one for every rank, are violations that amount to the same."""
        problem, deadline = self._problem, self._problem.deadline()
        answer = problem.solver.ask(*violation, deadline=min(time.monotonic() + AT_ONCE, deadline))
        if answer == "unknown":
            cases = problem.decision_literals(deadline)
            if len(cases) * len(self._ranks.ranks) * ONE_PART < deadline - time.monotonic():
                answer = self._ask_by_parts(cases, parts, deadline)
            else:
                answer = problem.solver.ask(*violation, deadline=deadline)
        if answer == "unknown":
            raise UndecidedError(claim)
        return answer == "unsat"

    def _ask_by_parts(self, cases: list[list[Term]], parts: Iterator[Term], deadline: float) -> Answer:
        for part in parts:
            with self._problem.solver.scope(self._covered, part):
                for case in cases:
                    answer = self._problem.solver.ask(*case, deadline=deadline)
                    if answer != "unsat":
                        return answer
        return "unsat"
