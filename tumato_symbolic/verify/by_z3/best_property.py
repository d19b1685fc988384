"""Minimal, in several steps: no set restores safety better and serves as well (`docs/semantics.md`, section 9)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import z3

from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import (
    ActionSet,
    EffectSequence,
    Effort,
    Residual,
    State,
    follow,
    is_safe,
    nominal_agrees,
    residual_goal,
)
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.choice import Choice
from tumato_symbolic.verify.by_z3.effort_source import EffortSource
from tumato_symbolic.verify.by_z3.efforts import LEMMAS_AT_ONCE, Efforts, EveryOutcome
from tumato_symbolic.verify.by_z3.encoding import Place, is_true, valid_term
from tumato_symbolic.verify.by_z3.outcomes import objections_to
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.rank_terms import RankFunction
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, conjunction, disjunction, either, implies, negation
from tumato_symbolic.verify.result import PropertyResult
from tumato_symbolic.verify.ways_back import Changed, RestoringWitnesses, TooFarError, WaysBack

CLAIM = "no allowed set restores safety better and serves as well"

MOST_BEFORE = 20_000
"""How many states are looked at whose runs may pass through a state."""


def prove_best(problem: PolicyProblem, source: EffortSource, ordering: Ordering) -> PropertyResult:
    """No unsafe state has a better set with which its own run meets its goal, and so do all others that do now.

    Raises `UndecidedError`.
    """
    deviations = Deviations(problem, source)
    efforts = source.exact()
    search = _Search(problem, source, efforts, ordering)
    while (found := search.find()) is not None:
        if not deviations.excuse(*found):
            return RestoringWitnesses(problem.spec, source.ranks.decisions, ordering).not_minimal(*found)
        search.exclude(*found)
    return PropertyResult("minimal", "proved", 3 + len(search.ranked), "z3")


class Deviations:
    """Why better sets are not chosen: a run would miss its goal. Those of the certificate are replayed first."""

    def __init__(self, problem: PolicyProblem, source: EffortSource) -> None:
        self._problem, self._ranks = problem, source.ranks
        self._decisions = source.ranks.decisions
        self._listed: dict[tuple[State, ActionSet], State] = {}
        for each in () if self._ranks.restoring is None else self._ranks.restoring.deviations:
            if not self._is_true(each):
                self._ranks.false_deviation(each)
                break
            self._listed[each.state, each.better] = each.missed

    def excuse(self, state: State, better: ActionSet) -> bool:
        """Whether a set that serves the run of `state` itself takes another run its goal. Raises `UndecidedError`."""
        listed = self._listed.get((state, better))
        if listed is not None and self._loses(state, better, listed):
            return True
        if not any(self._loses(state, better, other) for other in self._before(state)):
            return False
        if self._ranks.restoring is not None:
            self._ranks.lacks_deviation(state, better)
        return True

    def _is_true(self, deviation: Deviation) -> bool:
        state, better = deviation.state, deviation.better
        spec = self._problem.spec
        if state not in self._decisions or is_safe(spec, state) or not nominal_agrees(spec, better):
            return False
        if state == deviation.missed:
            return not self._serves(state, state, better)
        return self._loses(state, better, deviation.missed)

    def _loses(self, state: State, better: ActionSet, other: State) -> bool:
        """Whether the run of `other` meets its goal by the policy, and misses it with `better` in `state`."""
        spec, decisions = self._problem.spec, self._decisions
        first = decisions.get(other)
        if other == state or first is None or not nominal_agrees(spec, first):
            return False
        return follow(spec, decisions, other, first).end == "goal" and not self._serves(other, state, better)

    def _serves(self, start: State, state: State, better: ActionSet) -> bool:
        changed = Changed(self._decisions, state, better)
        return follow(self._problem.spec, changed, start, changed[start]).end == "goal"

    def _before(self, state: State) -> Iterator[State]:
        """The states from which the policy's run leads through `state`, the nearest first."""
        met, waiting = {state}, [state]
        for here in waiting:
            for before in self._steps_to(here):
                if before not in met:
                    if len(met) > MOST_BEFORE:
                        raise UndecidedError(CLAIM, f"better sets may keep over {MOST_BEFORE} runs from their goals")
                    met.add(before)
                    waiting.append(before)
                    yield before

    def _steps_to(self, state: State) -> Iterator[State]:
        if self._decisions.rows is not None:
            yield from self._decisions.origins.get(state, ())
            return
        problem, deadline = self._problem, self._problem.deadline()
        with problem.solver.scope(problem.acting, is_state(problem.after, state)):
            while (answer := problem.solver.ask(deadline=deadline)) == "sat":
                found = problem.state.read(problem.solver.model)
                problem.solver.add(negation(is_state(problem.state, found)))
                yield found
        if answer == "unknown":
            raise UndecidedError(CLAIM)


class _Search:
    """The search for an unsafe state with a better set, by lazy refinement.

    The solver proposes a set that meets every condition as far as outcomes of one effect tell, and how it is better: in
    one step (`once`), in several whatever happens (`several`), or along the nominal run. The rest is checked by
    `semantics`. A proposal that fails teaches a lemma that holds in all states, or is excluded for itself.
    """

    def __init__(self, problem: PolicyProblem, source: EffortSource, efforts: Efforts, ordering: Ordering) -> None:
        self._problem, self._source, self._efforts = problem, source, efforts
        self._ordering: Ordering = ordering
        self._decisions = source.ranks.decisions
        self._ways = WaysBack(problem.spec, self._decisions, ordering)
        self._solver = problem.new_solver()
        self._choice = Choice(problem.spec, problem.state, self._solver)
        self.ranked: dict[Residual, RankFunction] = {}
        self._solver.add(problem.decided, negation(problem.safe), *self._choice.conditions())
        self._state_better()

    def _state_better(self) -> None:
        problem, efforts, codes, choice = self._problem, self._efforts, self._efforts.codes, self._choice
        self._once, self._several = (z3.Bool(name, problem.context) for name in ("once", "several"))
        step = z3.FreshConst(z3.BitVecSort(codes.width, problem.context), "rival")
        finite = conjunction((problem.acting, efforts.is_finite))
        now_once = conjunction((finite, codes.is_one_step(efforts.here)))

        def in_one_step(after: Place) -> Term:
            return problem.tiers.restored(after)

        def in_several(after: Place) -> Term:
            return efforts.below(after, step, finite, efforts.here)

        self._outcomes = [
            (claim, EveryOutcome(problem, choice.executed, choice.after, condition))
            for claim, condition in ((self._once, in_one_step), (self._several, in_several))
        ]
        self._solver.add(
            step == codes.step(choice.executed),
            implies(self._once, implies(now_once, z3.ULT(step, efforts.here))),
            implies(self._several, conjunction((negation(now_once), negation(self._once)))),
            *(implies(claim, term) for claim, every in self._outcomes for term in every.constraints),
            disjunction((self._once, self._several, self._nominally(step, finite))),
        )

    def _nominally(self, step: Term, finite: Term) -> Term:
        """The set may be better by its nominal run: as far as nominal efforts are known to be exact."""
        problem, efforts, after = self._problem, self._efforts, self._choice.after
        if not efforts.fair:
            return False
        if not self._source.policy_is_safe or not efforts.nominal_is_exact():
            return negation(finite)
        codes, nominal = efforts.codes, efforts.nominal(after)
        restored = problem.tiers.restored(after)
        known, worst = codes.is_finite(nominal), codes.is_finite(efforts.worst(after))
        least = either(restored, step, either(known, step + nominal, step + codes.code((0, 1))))
        reached = disjunction((restored, conjunction((valid_term(problem.spec, after), disjunction((known, worst))))))
        bounded = conjunction((problem.acting, efforts.has_nominal))
        return conjunction((negation(finite), reached, implies(bounded, z3.ULT(least, efforts.nominal_here))))

    def find(self) -> tuple[State, ActionSet] | None:
        """An unsafe state with a better set that serves its own run; None where there is none."""
        deadline = self._problem.deadline()
        while (answer := self._solver.ask(deadline=deadline)) == "sat":
            model = self._solver.model
            state, chosen = self._problem.state.read(model), self._choice.read(model)
            claims = [is_true(model, claim) for claim, _ in self._outcomes]
            if (
                self._is_allowed(state, chosen)
                and self._is_better(state, chosen, claims)
                and self._serves(state, chosen)
            ):
                return state, chosen
        if answer == "unknown":
            raise UndecidedError(CLAIM)
        return None

    def exclude(self, state: State, chosen: ActionSet) -> None:
        """Propose something else."""
        actions = conjunction(
            term if number in chosen else negation(term) for number, term in enumerate(self._choice.executed)
        )
        self._solver.add(negation(conjunction((is_state(self._problem.state, state), actions))))

    def _is_allowed(self, state: State, chosen: ActionSet) -> bool:
        failed = objections_to(self._problem.spec, state, chosen, self._ordering, self._problem.deadline())
        for objection in failed:
            self._solver.add(self._choice.lemma(objection))
        return not failed

    def _is_better(self, state: State, chosen: ActionSet, claims: list[bool]) -> bool:
        """Whether a proposal restores a state better; otherwise learn why it does not."""
        once, several = claims
        if once or several:
            ways = list(islice(self._not_better(state, chosen, once), LEMMAS_AT_ONCE))
            claim, every = self._outcomes[0 if once else 1]
            self._solver.add(*(implies(claim, every.lemma(way)) for way in ways))
            return not ways
        try:
            now = self._ways.quality(state, self._decisions[state]) if state in self._decisions.followers else None
            then = self._ways.quality(state, chosen)
        except TooFarError:
            raise UndecidedError(CLAIM, "there are too many outcomes to check") from None
        if then is None or (now is not None and now <= then):
            self.exclude(state, chosen)
            return False
        return True

    def _not_better(self, state: State, chosen: ActionSet, once: bool) -> Iterator[EffectSequence]:
        """The outcomes by which a set is not better, in one step or in several."""
        bound: Effort | None = (0, 0) if once else self._efforts.worst_of(state)
        return self._efforts.not_below(state, chosen, bound)

    def _serves(self, state: State, chosen: ActionSet) -> bool:
        """Whether the run of a better set meets its goal; otherwise learn why it does not."""
        spec = self._problem.spec
        if follow(spec, Changed(self._decisions, state, chosen), state, chosen).end == "goal":
            return True
        goal = residual_goal(spec, state, chosen)
        known = self.ranked.get(goal)
        if not self._source.policy_is_safe or (known is not None and not known.claimed):
            self.exclude(state, chosen)
            return False
        ranks = self._source.ranks
        found = self.ranked[goal] = ranks.lower_bound(goal) if known is None else ranks.exact(goal)
        mine = self._problem.goals.is_residual(goal, self._choice.executed)
        self._solver.add(implies(mine, found.within_bound(self._problem, self._choice.after)))
        return False


def is_state(place: Place, state: State) -> Term:
    """`place` is this state."""
    return conjunction(place.has(variable, value) for variable, value in enumerate(state))
