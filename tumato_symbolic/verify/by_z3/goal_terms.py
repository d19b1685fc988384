"""The goal tree as Z3 terms (`docs/semantics.md`, section 4)."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import Spec, active_bodies, executing_atoms
from tumato_symbolic.verify.by_z3.encoding import TERMS, Place, formula_term, safe_term
from tumato_symbolic.verify.by_z3.terms import Term, conjunction, disjunction, negation


class GoalTerms(Struct, frozen=True):
    """`active[b]`: goal body `b` is active. Bodies that are not listed are never active."""

    spec: Spec
    active: dict[int, Term]

    @classmethod
    def of(cls, spec: Spec, place: Place) -> GoalTerms:
        """`Γ` of the state `place`."""
        return cls(spec, active_bodies(spec.goals, lambda condition: formula_term(condition, place), TERMS))

    def mentioned_actions(self) -> dict[int, Term]:
        """For every action that goal bodies mention, by its first case: one of these bodies is active."""
        mentioning: dict[int, list[Term]] = {}
        for body, term in self.active.items():
            for action in self.spec.as_actions(executing_atoms(self.spec.bodies[body].formula)):
                mentioning.setdefault(action, []).append(term)
        return {action: disjunction(terms) for action, terms in sorted(mentioning.items())}

    def is_residual(self, goal: Residual, executed: Sequence[Term]) -> Term:
        """The residual goal is `goal` when the actions of `executed` are the first set."""
        if not goal.bodies <= self.active.keys():
            return False
        mentioned = frozenset[int]().union(*(executing_atoms(self.spec.bodies[body].formula) for body in goal.bodies))
        runs = {first: self.executing(first, executed) for first in sorted(self.spec.as_actions(mentioned))}
        return conjunction(
            [
                *(term if body in goal.bodies else negation(term) for body, term in self.active.items()),
                *(term if first in goal.executed else negation(term) for first, term in runs.items()),
            ]
        )

    def executing(self, first: int, executed: Sequence[Term]) -> Term:
        """An action, of which this is the first case, is executed."""
        return disjunction(executed[case] for case in self.spec.cases_from(first))


def reached_term(spec: Spec, goal: Residual, place: Place) -> Term:
    """The residual goal is met in `place`: where safety may take several steps to restore, in safe states only."""
    executed = [number in goal.executed for number in range(len(spec.actions))]
    bodies = [formula_term(spec.bodies[body].formula, place, executed) for body in sorted(goal.bodies)]
    return conjunction((safe_term(spec, place), *bodies) if spec.restores_stepwise else bodies)
