"""One policy in one specification as a Z3 problem: the terms of every obligation, and the solver."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import z3

from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_z3.encoding import (
    Place,
    agreement_terms,
    diagram_terms,
    is_true,
    safe_term,
    successor_place,
    valid_term,
)
from tumato_symbolic.verify.by_z3.goal_terms import GoalTerms
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term, conjunction, disjunction, negation, same
from tumato_symbolic.verify.by_z3.tier_terms import Tiers


class PolicyProblem:
    """A state `s`, the policy's decision in it, and its successor.

    `executed[a]` is `a ∈ π(s)`; `valid_at_all`: `s` is valid, in the part that is looked at or not; `decided`: `s` is
    valid, and the policy has a decision for it; `acting`: and the nominal effects of that decision agree, so that there
    is a successor. A run that meets another one ends there.
    """

    def __init__(self, spec: Spec, decisions: DecisionDiagram, budget: Budget) -> None:
        self.spec = spec
        self._budget = budget
        self.latest = math.inf
        self.solver = Solver()
        self.context = self.solver.context
        self._solvers = [self.solver]
        self._definitions: list[Term] = []
        self._decisions: list[list[Term]] | None = None
        self._names = 0
        self.state = Place.fresh(spec, "s", self.context)
        self.assume(self.state.in_range(spec))
        roots = (*decisions.roots, decisions.defined)
        *executed, defined = diagram_terms(decisions.diagram, roots, self.state, bool)
        self.executed: tuple[Term, ...] = tuple(self.name(term, "d") for term in executed)
        self.defined: Term = self.name(defined, "defined")
        self.valid: Term = self.name(valid_term(spec, self.state), "valid")
        self.valid_at_all = self.valid if spec.part is None else self.name(valid_term(spec.whole, self.state), "valid")
        self.safe: Term = self.name(safe_term(spec, self.state), "safe")
        self.decided = conjunction((self.valid, self.defined))

    def assume(self, term: Term) -> None:
        """Add a definition: a term that constrains no state."""
        for solver in self._solvers:
            solver.define(term)
        self._definitions.append(term)

    def name(self, term: Term, hint: str) -> Term:
        """A Boolean that stands for `term`."""
        if isinstance(term, bool) or z3.is_const(term):
            return term
        self._names += 1
        name = z3.Bool(f"{hint}!{self._names}", self.context)
        self.assume(same(name, term))
        return name

    def new_solver(self) -> Solver:
        """Another solver that knows the same definitions, those to come included."""
        solver = Solver(self.context)
        solver.add(*self._definitions)
        self._solvers.append(solver)
        return solver

    @cached_property
    def agreement(self) -> list[Term]:
        """For every variable: the nominal effects of the decision agree on it."""
        return agreement_terms(self.spec, self.executed)

    @cached_property
    def acting(self) -> Term:
        """`s` is valid and decided, and the decision has a successor."""
        return self.name(conjunction((self.decided, *self.agreement)), "acting")

    @cached_property
    def after(self) -> Place:
        """`δ(s, π(s))`, where `acting`."""
        bits = successor_place(self.spec, self.state, self.executed).bits
        return Place([[self.name(bit, "t") for bit in code] for code in bits])

    @cached_property
    def safe_after(self) -> Term:
        """`δ(s, π(s)) ∈ S`, where `acting`."""
        return self.name(safe_term(self.spec, self.after), "safe_after")

    @cached_property
    def valid_after(self) -> Term:
        """`δ(s, π(s)) ∈ V`, where `acting`."""
        return self.name(valid_term(self.spec, self.after), "valid_after")

    @cached_property
    def tiers(self) -> Tiers:
        """How many tiers of state rules `s` satisfies."""
        return Tiers(self.spec, self.state, lambda term: self.name(term, "level"))

    @cached_property
    def kept_after(self) -> Term:
        """`δ(s, π(s))` keeps what a step from `s` has to keep, where `acting`."""
        if not self.spec.restores_stepwise:
            return self.safe_after
        return self.name(self.tiers.kept(self.after), "kept_after")

    @cached_property
    def goals(self) -> GoalTerms:
        """The goals that are active in `s`."""
        terms = GoalTerms.of(self.spec, self.state)
        return GoalTerms(self.spec, {body: self.name(term, "g") for body, term in terms.active.items()})

    def decision(self, model: Any) -> ActionSet:  # noqa: ANN401 - z3 has no types
        """The decision that a model gives."""
        return frozenset(number for number, term in enumerate(self.executed) if is_true(model, term))

    def deadline(self) -> float:
        """When the time for an obligation that is begun now is over, on the monotonic clock; never after `latest`."""
        return min(self.latest, self._budget.until())

    def first_model(self, claim: str, *terms: Term, deadline: float | None = None) -> Any:  # noqa: ANN401
        """A model of `terms` whose state comes first in the order of declaration, so that witnesses are repeatable.

        None where `claim` is proved, for it has none. When time runs out on the way, the best state so far is taken;
        raises `UndecidedError` where there is none yet.
        """
        deadline = self.deadline() if deadline is None else deadline
        answer = self.solver.ask(*terms, deadline=deadline)
        if answer == "unknown":
            raise UndecidedError(claim)
        if answer == "unsat":
            return None
        best = self.solver.model
        with self.solver.scope(*terms):
            for bit in unknown_bits(self.state):
                if is_true(best, bit) and self.solver.ask(negation(bit), deadline=deadline) == "sat":
                    best = self.solver.model
                self.solver.add(bit if is_true(best, bit) else negation(bit))
        return best

    def decision_literals(self, deadline: float) -> list[list[Term]]:
        """Every case of what the policy does, as literals: it does not act; or its decision is this one."""
        if self._decisions is None:
            solver, found = self.new_solver(), [[negation(self.acting)]]
            solver.add(self.acting)
            while (answer := solver.ask(deadline=deadline)) == "sat":
                chosen = self.decision(solver.model)
                literals = [term if number in chosen else negation(term) for number, term in enumerate(self.executed)]
                found.append([self.acting, *literals])
                solver.add(disjunction(negation(literal) for literal in literals))
            if answer == "unknown":
                raise UndecidedError("there are no other decisions")
            self._decisions = found
        return self._decisions

    def read(self, model: Any) -> tuple[State, ActionSet]:  # noqa: ANN401 - z3 has no types
        """The state and the decision that a model gives."""
        return self.state.read(model), self.decision(model)

    def literals(self, state: State) -> list[Term]:
        """What `unknown_bits` are in `state`: the bit itself where it is set, otherwise its negation."""
        bits = [
            (bit, state[number] >> place & 1)
            for number, code in enumerate(self.state.bits)
            for place, bit in reversed(list(enumerate(code)))
        ]
        return [bit if value else negation(bit) for bit, value in bits]


def unknown_bits(place: Place) -> Sequence[Term]:
    """The bits of a state, the most significant ones of the first variable first."""
    return [bit for code in place.bits for bit in reversed(code)]
