"""Rank functions as Z3 terms, and the obligations that make them true (`docs/certificate.md`)."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import z3

from tumato_symbolic.policy.diagram import Diagram, Reference
from tumato_symbolic.semantics import Residual, State
from tumato_symbolic.verify.encoding import Place, diagram_terms
from tumato_symbolic.verify.frame import Answer, Frame, Solver
from tumato_symbolic.verify.goal_terms import reached_term
from tumato_symbolic.verify.terms import Number, Term, conjunction, disjunction, either, negation


@dataclass(frozen=True, slots=True)
class RankFunction:
    """`N_c` of one residual goal: a rank or None for every state.

    A *given* one comes with the policy; it speaks of safe states. A *recomputed* one speaks of all states: it is 0
    wherever the goal holds, and otherwise what the diagram says.
    """

    goal: Residual
    diagram: Diagram[int | None]
    root: Reference
    given: bool

    @property
    def width(self) -> int:
        """How many bits a rank has; all ones are None."""
        largest = max((leaf for leaf in self.diagram.leaves if leaf is not None), default=0)
        return max(1, (largest + 1).bit_length())

    @property
    def never(self) -> Number:
        """The number that stands for None: larger than every rank."""
        return z3.BitVecVal((1 << self.width) - 1, self.width)

    def at(self, frame: Frame, place: Place) -> Number:
        """The rank of `place`."""

        def leaf(rank: int | None) -> Number:
            return self.never if rank is None else z3.BitVecVal(rank, self.width)

        (rank,) = diagram_terms(self.diagram, [self.root], place, leaf)
        if self.given:
            return rank
        return either(reached_term(frame.spec, self.goal, place), z3.BitVecVal(0, self.width), rank)

    def within(self, rank: Number, bound: int | None) -> Term:
        """The rank is a number, and at most `bound - 1`."""
        if bound is None or bound >= (1 << self.width) - 1:
            return z3.ULT(rank, self.never)
        return z3.ULE(rank, z3.BitVecVal(bound - 1, self.width))


class RankProof:
    """The obligations on one rank function, over the states that it speaks of."""

    def __init__(self, frame: Frame, ranks: RankFunction) -> None:
        self._frame = frame
        self._ranks = ranks
        self._here = z3.BitVec("rank", ranks.width)
        self._after = z3.BitVec("rank_after", ranks.width)
        self._covered: Term = frame.safe if ranks.given else True
        self._covered_after: Term = frame.safe_after if ranks.given else True

    def decreasing(self) -> Answer:
        """`N` is an upper bound: 0 means that the goal holds, `j > 0` that the next state has a smaller rank."""
        zero = self._here == 0
        goes_down = conjunction((self._frame.acting, self._covered_after, z3.ULT(self._after, self._here)))
        wrong = either(
            zero,
            negation(reached_term(self._frame.spec, self._ranks.goal, self._frame.state)),
            negation(goes_down),
        )
        return self._prove((self._covered, self._here != self._ranks.never, wrong))

    def lower_bound(self) -> Answer:
        """`N` is 0 where the goal holds, and nowhere more than one larger than in the next state; None is infinite."""
        reached = reached_term(self._frame.spec, self._ranks.goal, self._frame.state)
        next_or_more = disjunction(
            (
                self._after == self._ranks.never,
                z3.ULE(self._here, self._after + 1),
            )
        )
        wrong = either(
            reached,
            self._here != 0,
            conjunction((self._frame.acting, negation(conjunction((self._covered_after, next_or_more))))),
        )
        return self._prove((self._covered, wrong))

    def start(self, blameless: Callable[[State], bool]) -> tuple[Answer, State | None]:
        """Every state with this residual goal steps to one whose rank is below the bound; or the first that does not.

        States that are not `blameless` are passed over: their decision is refuted elsewhere.
        """
        frame = self._frame
        goes = conjunction((self._covered_after, self._ranks.within(self._after, frame.spec.max_plan_length)))
        mine = frame.goals.is_residual(self._ranks.goal, frame.executed)
        deadline = time.monotonic() + (frame.budget or math.inf)
        with frame.solver.scope(*self._definitions(), frame.acting, mine, negation(goes)):
            while time.monotonic() < deadline:
                answer, model = frame.first_state()
                if answer != "sat":
                    return answer, None
                state = frame.state.read(model)
                if blameless(state):
                    return "sat", state
                frame.solver.add(negation(conjunction(frame.literals(state))))
        return "unknown", None

    def _definitions(self) -> Iterator[Term]:
        yield self._here == self._ranks.at(self._frame, self._frame.state)
        yield self._after == self._ranks.at(self._frame, self._frame.after)

    def _prove(self, violation: tuple[Term, ...]) -> Answer:
        """Ask at once; where that takes too long, for every decision and rank apart."""
        solver = self._frame.solver
        with solver.scope(*self._definitions(), *violation):
            answer = solver.ask()
            return answer if answer != "unknown" else self._by_parts(solver)

    def _by_parts(self, solver: Solver) -> Answer:
        ranks = sorted({leaf for leaf in self._ranks.diagram.leaves if leaf is not None})
        values = [*(z3.BitVecVal(rank, self._ranks.width) for rank in ranks), self._ranks.never]
        for decision in _decisions(self._frame, solver):
            if decision == "unknown":
                return "unknown"
            with solver.scope(*decision):
                for value in values:
                    answer = solver.ask(self._here == value)
                    if answer != "unsat":
                        return answer
        return "unsat"


def _decisions(frame: Frame, solver: Solver) -> Iterator[list[Term] | Literal["unknown"]]:
    """Every decision that some acting state has, as literals; then nothing where the policy does not act."""
    others = frame.new_solver()
    yield [negation(frame.acting)]
    others.add(frame.acting)
    while (answer := others.ask()) == "sat":
        chosen = frame.decision(others.model)
        literals = [
            term if number in chosen else negation(term)
            for number, term in enumerate(frame.executed)
            if not isinstance(term, bool)
        ]
        yield [frame.acting, *literals]
        others.add(disjunction(negation(literal) for literal in literals))
    if answer == "unknown":
        yield "unknown"
