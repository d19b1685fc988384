"""One policy in one specification as a Z3 problem: what every obligation speaks of, and the solver that is asked."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property
from typing import Any, Literal, TypeAlias

import z3

from tumato_symbolic.policy.model import DecisionDiagram
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.encoding import (
    Place,
    agreement_terms,
    diagram_terms,
    is_true,
    safe_term,
    successor_place,
    valid_term,
)
from tumato_symbolic.verify.goal_terms import GoalTerms
from tumato_symbolic.verify.terms import Term, conjunction, negation, z3_term

Answer: TypeAlias = Literal["sat", "unsat", "unknown"]


class Solver:
    """A Z3 solver for finite domains. Every question has the same time budget (seconds, None: unlimited)."""

    def __init__(self, budget: float | None) -> None:
        self._solver = z3.SolverFor("QF_FD")
        self._depth = 0
        self._lost: list[Term] = []
        self.budget = budget

    def add(self, *terms: Term) -> None:
        """Assume `terms` from now on."""
        for term in terms:
            if term is not True:
                self._solver.add(z3_term(term))

    def define(self, term: Term) -> None:
        """Assume a definition for good, also when a scope is open."""
        self.add(term)
        if self._depth:
            self._lost.append(term)

    @contextmanager
    def scope(self, *terms: Term) -> Iterator[None]:
        """Assume `terms`, and whatever is added meanwhile, for a while."""
        self._solver.push()
        self._depth += 1
        try:
            self.add(*terms)
            yield
        finally:
            self._solver.pop()
            self._depth -= 1
            self.add(*self._lost)
            if not self._depth:
                self._lost = []

    def ask(self, *terms: Term, budget: float | None = None) -> Answer:
        """Whether `terms` can hold together with the assumptions."""
        if any(term is False for term in terms):
            return "unsat"
        limit = self.budget if budget is None else budget
        self._solver.set("timeout", 4294967295 if limit is None else max(1, int(limit * 1000)))
        with self.scope(*terms):
            answer = str(self._solver.check())
            self._model = self._solver.model() if answer == "sat" else None
        return "sat" if answer == "sat" else "unsat" if answer == "unsat" else "unknown"

    @property
    def model(self) -> Any:  # noqa: ANN401 - z3 has no types
        """The model of the last `sat`."""
        return self._model


class Frame:
    """A state `s`, the policy's decision in it, and its successor.

    `executed[a]` is `a ∈ π(s)`; `decided` is: `s` is valid, and the policy has a decision for it; `acting`: and the
    nominal effects of that decision agree, so that there is a successor. A run that meets another one ends there.
    """

    def __init__(self, spec: Spec, decisions: DecisionDiagram, budget: float | None) -> None:
        self.spec = spec
        self.budget = budget
        self.solver = Solver(budget)
        self._solvers = [self.solver]
        self._definitions: list[Term] = []
        self._names = 0
        self.state = Place.fresh(spec, "s")
        self.assume(self.state.in_range(spec))
        roots = (*decisions.roots, decisions.defined)
        *executed, defined = diagram_terms(decisions.diagram, roots, self.state, bool)
        self.executed: tuple[Term, ...] = tuple(self.name(term, "d") for term in executed)
        self.defined: Term = self.name(defined, "defined")
        self.valid: Term = self.name(valid_term(spec, self.state), "valid")
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
        name = z3.Bool(f"{hint}!{self._names}")
        self.assume(name == term)
        return name

    def new_solver(self) -> Solver:
        """Another solver that knows the same definitions, those to come included."""
        solver = Solver(self.budget)
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
    def goals(self) -> GoalTerms:
        """The goals that are active in `s`."""
        terms = GoalTerms.of(self.spec, self.state)
        return GoalTerms(self.spec, {body: self.name(term, "g") for body, term in terms.active.items()})

    def decision(self, model: Any) -> ActionSet:  # noqa: ANN401 - z3 has no types
        """The decision that a model gives."""
        return frozenset(number for number, term in enumerate(self.executed) if is_true(model, term))

    def first_state(self, *terms: Term) -> tuple[Answer, Any]:
        """The model of `terms` whose state comes first in the order of declaration, so that witnesses are repeatable.

        When time runs out on the way, the best state so far is taken.
        """
        answer = self.solver.ask(*terms)
        if answer != "sat":
            return answer, None
        best = self.solver.model
        deadline = time.monotonic() + (self.budget or 3600.0)
        with self.solver.scope(*terms):
            for bit in unknown_bits(self.state):
                if is_true(best, bit) and time.monotonic() < deadline:
                    if self.solver.ask(negation(bit)) != "sat":
                        self.solver.add(bit)
                        continue
                    best = self.solver.model
                self.solver.add(negation(bit) if not is_true(best, bit) else True)
        return "sat", best

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
