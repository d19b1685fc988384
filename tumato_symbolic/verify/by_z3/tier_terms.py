"""Tiers of state rules as Z3 terms, and what a step has to keep (`docs/semantics.md`, sections 9 and 10)."""

from __future__ import annotations

from collections.abc import Callable

from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_z3.encoding import Place, formula_term, safe_term, valid_term
from tumato_symbolic.verify.by_z3.terms import Term, conjunction, disjunction, implies, negation


class Tiers:
    """The valid state `here`, and steps from it: `levels[i]` is that it satisfies the `i` severest tiers.

    `name` gives a term a name.
    """

    def __init__(self, spec: Spec, here: Place, name: Callable[[Term], Term] = lambda term: term) -> None:
        self._spec = spec
        self.levels = [name(term) for term in tier_terms(spec, here)]
        self._holds = [[formula_term(rule.formula, here) for rule in tier] for tier in spec.tiers]

    def kept(self, after: Place) -> Term:
        """`after` satisfies the `required_rules` of `here`."""
        spec = self._spec
        if not spec.restores_stepwise:
            return safe_term(spec, after)
        terms = [valid_term(spec, after)]
        for concerned, tier, holds in zip(self.levels, spec.tiers, self._holds, strict=False):
            for rule, before in zip(tier, holds, strict=True):
                required = concerned if spec.restoration == "one_step" else conjunction((concerned, before))
                terms.append(implies(required, formula_term(rule.formula, after)))
        return conjunction(terms)

    def restored(self, after: Place) -> Term:
        """`after` satisfies a tier more than `here`."""
        pairs = zip(self.levels, tier_terms(self._spec, after), strict=True)
        return disjunction(conjunction((then, negation(now))) for now, then in list(pairs)[1:])

    def not_lower(self, after: Place) -> Term:
        """`after` is valid, and satisfies the tiers that `here` does."""
        pairs = zip(self.levels, tier_terms(self._spec, after), strict=True)
        return conjunction(implies(now, then) for now, then in pairs)


def tier_terms(spec: Spec, place: Place) -> list[Term]:
    """`S_0` to `S_m`: `place` is valid, and satisfies so many tiers, the most severe first."""
    terms = [valid_term(spec, place)]
    for tier in spec.tiers:
        terms.append(conjunction((terms[-1], *(formula_term(rule.formula, place) for rule in tier))))
    return terms
