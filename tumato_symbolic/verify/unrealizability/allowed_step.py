"""Any state with any set that is allowed in it, for claims about all allowed steps (`docs/certificate.md`)."""

from __future__ import annotations

import math
import time
from typing import TypeAlias

import z3

from tumato_symbolic.limits import Budget
from tumato_symbolic.semantics import ActionSet, State, is_safe, successor
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_z3.choice import Choice
from tumato_symbolic.verify.by_z3.encoding import Place, safe_term
from tumato_symbolic.verify.by_z3.goal_terms import GoalTerms
from tumato_symbolic.verify.by_z3.outcomes import objections_to
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, conjunction

Step: TypeAlias = tuple[State, ActionSet, State]
"""A state, a set that is allowed in it, and the nominal successor."""


class AllowedStep:
    """A state `s`, a set `A` with `Ok(s, A)`, and `t = δ(s, A)`, sought by lazy refinement.

    The solver proposes a set that meets every condition but one, which is about all outcomes. `semantics` checks it;
    a proposal with an unsafe outcome teaches a lemma that holds in all states. `proved` counts the claims that the
    solver proved, `walked` those that were left to the walk.
    """

    def __init__(self, spec: Spec, ordering: Ordering, budget: Budget) -> None:
        self.spec = spec
        self.ordering: Ordering = ordering
        self.proved = 0
        self.walked = 0
        self._budget = budget
        self._names = 0
        self._states = Solver()
        self.context = self._states.context
        self._steps = Solver(self.context)
        self.state = Place.fresh(spec, "s", self.context)
        self._choice = Choice(spec, self.state, self._steps)
        self.executed = self._choice.executed
        self.after = self._choice.after
        self._define(self.state.in_range(spec))
        self.safe = self.name(safe_term(spec, self.state))
        self._steps.add(*self._choice.conditions())
        active = GoalTerms.of(spec, self.state).active
        self.goals = GoalTerms(spec, {body: self.name(term) for body, term in active.items()})

    def name(self, term: Term) -> Term:
        """A Boolean that stands for `term`."""
        if isinstance(term, bool) or z3.is_const(term):
            return term
        self._names += 1
        name = z3.Bool(f"n!{self._names}", self.context)
        self._define(name == term)
        return name

    def _define(self, term: Term) -> None:
        self._states.define(term)
        self._steps.define(term)

    def deadline(self, within: float = math.inf) -> float:
        """When the time for what is begun now is over, that of one obligation or `within` seconds; monotonic."""
        return min(time.monotonic() + within, self._budget.until())

    def some_state(self, claim: str, *terms: Term) -> State | None:
        """A state that meets `terms`; None where there is none, which proves `claim`. Raises `UndecidedError`."""
        answer = self._states.ask(*terms, deadline=self.deadline())
        if answer == "unknown":
            raise UndecidedError(claim)
        if answer == "sat":
            return self.state.read(self._states.model)
        self.proved += 1
        return None

    def some_step(self, claim: str, *terms: Term, within: float = math.inf) -> Step | None:
        """An allowed step that meets `terms`; None where there is none, which proves `claim`.

        Raises `UndecidedError`, also when it takes more than `within` seconds.
        """
        deadline = self.deadline(within)
        while (answer := self._steps.ask(*terms, deadline=deadline)) == "sat":
            state, chosen = self.state.read(self._steps.model), self._choice.read(self._steps.model)
            failed = objections_to(self.spec, state, chosen, self.ordering, deadline)
            if not failed:
                return state, chosen, successor(self.spec, state, chosen)
            if not chosen:
                raise RuntimeError(f"the solver does nothing in {state}, safe: {is_safe(self.spec, state)}")
            self._steps.add(*map(self._choice.lemma, failed))
        if answer == "unknown":
            raise UndecidedError(claim)
        self.proved += 1
        return None


def is_state(place: Place, state: State) -> Term:
    """The place is this state."""
    return conjunction(place.has(variable, value) for variable, value in enumerate(state))
