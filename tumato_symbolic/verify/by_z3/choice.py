"""A set of actions that the solver may choose, with the conditions of section 3 that are cheap to state."""

from __future__ import annotations

from collections.abc import Sequence
from math import gcd
from typing import Any

import z3

from tumato_symbolic.semantics import ActionSet, Objection
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_z3.encoding import (
    Place,
    agreement_terms,
    formula_term,
    is_true,
    successor_place,
)
from tumato_symbolic.verify.by_z3.solver import Solver
from tumato_symbolic.verify.by_z3.terms import Number, Term, at_most_one, conjunction, implies
from tumato_symbolic.verify.by_z3.tier_terms import Tiers


class Choice:
    """`executed[a]` is `a ∈ A` for a set `A` to be chosen in the state `here`; `after` is `δ(s, A)`."""

    def __init__(self, spec: Spec, here: Place, solver: Solver) -> None:
        self._spec = spec
        self._context = solver.context
        self._here = here
        self._tiers = Tiers(spec, here)
        self.executed: list[Term] = [
            z3.Bool(f"a.{number}", solver.context) for number in range(len(self._spec.actions))
        ]
        bits = successor_place(spec, here, self.executed).bits
        self.after = Place([[_named(solver, bit) for bit in code] for code in bits])

    def conditions(self) -> list[Term]:
        """Conditions 1 to 4 and 6, and condition 5 for one effect alone: all of section 3 but outcomes of several.

        By condition 6, sets without an action that takes effect are chosen in safe states only.
        """
        spec, here, executed = self._spec, self._here, self.executed
        required: list[Term] = []
        for cases in spec.cases:
            holds = conjunction(formula_term(rule.formula, here) for rule in spec.actions[cases[0]].preconditions)
            for number in cases:
                action = spec.actions[number]
                meant = True if action.guard is None else formula_term(action.guard.formula, here)
                safe = conjunction(self._tiers.kept(here.after(effect)) for effect in action.effects)
                required.append(implies(executed[number], conjunction((holds, meant, safe))))
        for resource in range(len(spec.resources)):
            users = [executed[number] for number, action in enumerate(spec.actions) if resource in action.resources]
            required.append(at_most_one(users))
        required += agreement_terms(spec, executed)
        required += [formula_term(rule.formula, here, executed) for rule in spec.reaction_rules]
        required.append(self._tiers.kept(self.after))
        return required

    def lemma(self, objection: Objection) -> Term:
        """What an unsafe outcome of a proposed set teaches of all states.

        Where these actions are executed, their effects in this order lead to a safe state; or keep the preconditions of
        an action that is executed with them.
        """
        pending = objection.actions[0] if objection.kind == "falsified" else None
        if pending is None and (objection.kind != "unsafe" or len(objection.outcome) < 2):
            raise RuntimeError(f"the solver proposes a set that violates what it knows: {objection}")
        written = dict(pair for step in objection.outcome for pair in step.effect)
        reached = self._here.after(tuple(sorted(written.items())))
        together = conjunction(self.executed[step.action] for step in objection.outcome)
        if pending is None:
            return implies(together, self._tiers.kept(reached))
        rules = self._spec.actions[pending].preconditions
        kept = conjunction(formula_term(rule.formula, reached) for rule in rules)
        return implies(conjunction((together, self.executed[pending])), kept)

    def cheaper_than(self, other: Sequence[Term]) -> Term:
        """`A` has a smaller duration than the set `other`."""
        return z3.ULT(self._duration(self.executed), self._duration(other))

    def lasts_at_most(self, duration: int) -> Term:
        """`A` has at most this duration."""
        unit, width = self._scale()
        if duration < 0:
            return False
        return z3.ULE(self._duration(self.executed), self._amount(min(duration // unit, (1 << width) - 1)))

    def _scale(self) -> tuple[int, int]:
        """The greatest common divisor of all durations, and the bits that their sum takes in this unit."""
        durations = [action.duration for action in self._spec.actions]
        unit = gcd(*durations) or 1
        return unit, max(1, (sum(durations) // unit).bit_length())

    def _duration(self, executed: Sequence[Term]) -> Number:
        unit, _ = self._scale()
        total = zero = self._amount(0)
        for term, action in zip(executed, self._spec.actions, strict=True):
            if action.duration and term is not False:
                amount = self._amount(action.duration // unit)
                total = total + (amount if term is True else z3.If(term, amount, zero))
        return total

    def _amount(self, units: int) -> Number:
        return z3.BitVecVal(units, self._scale()[1], self._context)

    def read(self, model: Any) -> ActionSet:  # noqa: ANN401 - z3 has no types
        """The set that a model gives."""
        return frozenset(number for number, term in enumerate(self.executed) if is_true(model, term))


def _named(solver: Solver, term: Term) -> Term:
    if isinstance(term, bool):
        return term
    name = z3.FreshBool("next", solver.context)
    solver.add(name == term)
    return name
