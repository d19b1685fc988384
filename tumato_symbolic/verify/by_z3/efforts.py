"""How a policy restores safety, as claimed, and the obligations that make it true (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice

import z3

from tumato_symbolic.policy import Restoring
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    Effort,
    State,
    duration,
    is_valid,
    longer,
    outcomes_in_turn,
    restored,
)
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.effort_codes import EffortCodes
from tumato_symbolic.verify.by_z3.encoding import Place, diagram_terms, valid_term
from tumato_symbolic.verify.by_z3.outcomes import AnyOutcome
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Number, Term, conjunction, disjunction, either, implies, negation
from tumato_symbolic.verify.ways_back import MOST_OUTCOMES

LEMMAS_AT_ONCE = 20
"""So many lemmas are added for one state that was found."""


class Efforts:
    """`w` and the nominal efforts of unsafe states, as a certificate has them, or as they were recomputed.

    `conflicting`: decisions may violate what is allowed. Where `first_false` finds nothing, `w` is nowhere too small.
    """

    def __init__(self, problem: PolicyProblem, record: Restoring, ordering: Ordering, conflicting: bool) -> None:
        self.record = record
        self._problem = problem
        self._ordering: Ordering = ordering
        self._conflicting = conflicting
        finite = [leaf for leaf in record.efforts.leaves if leaf is not None]
        largest = max((leaf[0] for leaf in finite), default=0), max((leaf[1] for leaf in finite), default=0)
        self.codes = EffortCodes(problem.spec, largest, problem.context)
        self.step = self._named(self.codes.step(problem.executed), "step")
        self.here = self._named(self.worst(problem.state), "worst")
        self.nominal_here = self._named(self.nominal(problem.state), "nominal")
        self.after = self._named(self.worst(problem.after), "worst_after")
        self.nominal_after = self._named(self.nominal(problem.after), "nominal_after")
        self.unsafe_acting = conjunction((problem.acting, negation(problem.safe)))
        self.is_finite = self.codes.is_finite(self.here)
        self.has_nominal: Term = self.fair and self.codes.is_finite(self.nominal_here)
        self._restored_after = problem.name(problem.tiers.restored(problem.after), "restored")

    def _named(self, number: Number, hint: str) -> Number:
        name = z3.FreshConst(z3.BitVecSort(self.codes.width, self._problem.context), hint)
        self._problem.assume(name == number)
        return name

    @property
    def fair(self) -> bool:
        """Whether nominal efforts count."""
        return self._problem.spec.restoration == "fair"

    def worst(self, place: Place) -> Number:
        """`w` of the unsafe state `place`."""
        return diagram_terms(self.record.efforts, [self.record.worst], place, self.codes.code)[0]

    def nominal(self, place: Place) -> Number:
        """The nominal effort of the unsafe state `place`."""
        return diagram_terms(self.record.efforts, [self.record.nominal], place, self.codes.code)[0]

    def worst_of(self, state: State) -> Effort | None:
        """`w` of one unsafe state."""
        return self.record.efforts.evaluate(self.record.worst, state)

    def first_false(self) -> State | None:
        """The first unsafe state whose effort is not enough: not that of every outcome and of the step.

        Raises `UndecidedError`.
        """
        problem, claim = self._problem, "efforts are enough"
        unsafe = conjunction((problem.valid, negation(problem.safe)))
        claims = disjunction((self.is_finite, self.has_nominal))
        here = disjunction(
            (
                negation(problem.acting),
                conjunction(
                    (self.is_finite, disjunction((z3.ULT(self.here, self.step), self._exceeds(problem.after))))
                ),
                conjunction((negation(self.is_finite), negation(self._falls_nominally()))),
            )
        )
        model = problem.first_model(claim, unsafe, claims, here)
        if model is None:
            outcome = AnyOutcome(
                problem.spec,
                problem.state,
                problem.executed,
                self._ordering,
                problem.context,
                conflicting=self._conflicting,
            )
            wrong = self._exceeds(outcome.reached)
            model = problem.first_model(claim, self.unsafe_acting, self.is_finite, *outcome.constraints, wrong)
        return None if model is None else problem.state.read(model)

    def _exceeds(self, after: Place) -> Term:
        """`after` is not restored, and one step more than its effort is more than that of `s`."""
        worst = self.worst(after)
        smaller = conjunction((self.codes.is_finite(worst), z3.ULE(worst + self.step, self.here)))
        valid = valid_term(self._problem.spec, after)
        return negation(disjunction((self._problem.tiers.restored(after), conjunction((valid, smaller)))))

    def _falls_nominally(self) -> Term:
        """The nominal effort of `s` is at least one step more than after it, as far as it is known there."""
        problem, codes = self._problem, self.codes
        falls = z3.ULE(self.nominal_after + self.step, self.nominal_here)
        known = disjunction((codes.is_finite(self.after), conjunction((codes.is_finite(self.nominal_after), falls))))
        unrestored = conjunction((problem.tiers.not_lower(problem.after), known))
        enough = z3.ULE(self.step, self.nominal_here)
        return conjunction((enough, disjunction((self._restored_after, unrestored))))

    def first_without(self) -> State | None:
        """The first unsafe state where the policy acts that has no effort. Raises `UndecidedError`."""
        problem = self._problem
        none = negation(disjunction((self.is_finite, self.has_nominal)))
        model = problem.first_model("every unsafe state has an effort", self.unsafe_acting, none)
        return None if model is None else problem.state.read(model)

    def too_large(self) -> State | None:
        """A state where `w` is too large; None: it is exact, if `first_false` finds nothing. Raises `UndecidedError`.

        Too large is an effort that no outcome needs. A state whose outcomes of one effect do not need it is looked at;
        where others do, the effects of one of them become a lemma.
        """
        problem, deadline = self._problem, self._problem.deadline()
        solver = problem.new_solver()
        every = EveryOutcome(problem, problem.executed, problem.after, self._needs_less)
        solver.add(self.unsafe_acting, implies(self.is_finite, z3.ULT(self.step, self.here)), *every.constraints)
        while (answer := solver.ask(deadline=deadline)) == "sat":
            state, chosen = problem.read(solver.model)
            needed = self._needed(state, chosen)
            if not needed:
                return state
            solver.add(*map(every.lemma, needed))
        if answer == "unknown":
            raise UndecidedError("efforts are nowhere too large")
        return None

    def _needs_less(self, after: Place) -> Term:
        return self.below(after, self.step, self.is_finite, self.here)

    def below(self, after: Place, step: Number, bounded: Term, bound: Number) -> Term:
        """`after` is restored, or has an effort; where `bounded`, with `step` it is less than `bound`."""
        worst = self.worst(after)
        less = implies(bounded, z3.ULT(worst + step, bound))
        valid = valid_term(self._problem.spec, after)
        return disjunction(
            (self._problem.tiers.restored(after), conjunction((valid, self.codes.is_finite(worst), less)))
        )

    def _needed(self, state: State, chosen: ActionSet) -> list[EffectSequence]:
        """Some outcomes of several effects that take as long as the effort of a state, or longer."""
        bound = self.worst_of(state)
        return list(islice(self.not_below(state, chosen, bound), LEMMAS_AT_ONCE))

    def not_below(self, state: State, chosen: ActionSet, bound: Effort | None) -> Iterator[EffectSequence]:
        """The outcomes of a set that are not restored, and whose effort, with the step, is not below `bound`, if any.

        Raises `UndecidedError` where there are too many to look at.
        """
        spec = self._problem.spec
        for number, (after, way) in enumerate(outcomes_in_turn(spec, state, chosen, self._ordering)):
            if number >= MOST_OUTCOMES:
                raise UndecidedError(f"all outcomes of {len(chosen)} actions together", "too many to check")
            if restored(spec, state, after):
                continue
            effort = self.worst_of(after) if is_valid(spec, after) else None
            if effort is None or (bound is not None and longer(effort, duration(spec, chosen)) >= bound):
                yield way

    def nominal_is_exact(self) -> bool:
        """Whether nominal efforts are what the nominal runs take, wherever they are finite or `w` is not."""
        problem, codes = self._problem, self.codes
        if not self.fair:
            return False
        total = either(self._restored_after, self.step, self.step + self.nominal_after)
        known = disjunction(
            (
                self._restored_after,
                conjunction((problem.tiers.not_lower(problem.after), codes.is_finite(self.nominal_after))),
            )
        )
        right = conjunction((known, self.nominal_here == total))
        infinite = negation(disjunction((known, codes.is_finite(self.after))))
        wrong = either(self.has_nominal, negation(right), negation(disjunction((self.is_finite, infinite))))
        answer = problem.solver.ask(self.unsafe_acting, wrong, deadline=problem.deadline())
        if answer == "unknown":
            raise UndecidedError("nominal efforts are exact")
        return answer == "unsat"


class EveryOutcome:
    """A condition on all states that the actions of `executed` lead to; `after` is the nominal one.

    `constraints` say it of outcomes of one effect and of `after`; each outcome of several is a lemma.
    """

    def __init__(
        self, problem: PolicyProblem, executed: Sequence[Term], after: Place, condition: Callable[[Place], Term]
    ) -> None:
        self._here, self._executed, self._condition = problem.state, executed, condition
        self.constraints = [
            condition(after),
            *(
                implies(executed[number], condition(problem.state.after(effect)))
                for number, action in enumerate(problem.spec.actions)
                for effect in action.effects
                if executed[number] is not False
            ),
        ]

    def lemma(self, outcome: EffectSequence) -> Term:
        """Where these actions are executed, their effects in this order lead to where the condition holds."""
        written = dict(pair for step in outcome for pair in step.effect)
        together = conjunction(self._executed[step.action] for step in outcome)
        return implies(together, self._condition(self._here.after(tuple(sorted(written.items())))))
