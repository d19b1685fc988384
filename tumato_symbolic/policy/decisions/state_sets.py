"""Formulas over the state as sets of a diagram."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tumato_symbolic.diagrams import EVERYTHING, NOTHING, Reference, Sets
from tumato_symbolic.spec import Connectives, Executing, Formula, Is, Rule, Spec, fold


class StateSets:
    """The sets of states that formulas of a specification describe.

    `variables` and `values` are the numbers in `sets` of what the specification numbers in its order of declaration.
    """

    def __init__(self, sets: Sets, variables: Sequence[int], values: Sequence[Sequence[int]]) -> None:
        self._sets = sets
        levels = {variable: level for level, variable in enumerate(sets.order)}
        self._levels = [levels[variable] for variable in variables]
        self._values = values
        self._by: Connectives[Reference] = Connectives(
            constant=lambda value: EVERYTHING if value else NOTHING,
            negation=lambda states: sets.without(EVERYTHING, states),
            conjunction=self._all_of,
            disjunction=self.any_of,
            equivalence=lambda one, other: sets.choose(one, other, sets.without(EVERYTHING, other)),
        )

    @classmethod
    def of(cls, sets: Sets, spec: Spec) -> StateSets:
        """Where the sets have the numbers of the specification."""
        return cls(sets, range(len(spec.variables)), [range(len(each.values)) for each in spec.variables])

    def states(self, formula: Formula) -> Reference:
        """Where a formula holds, which speaks of the state alone."""
        return fold(formula, self._atom, self._by)

    def where(self, rules: Iterable[Rule]) -> Reference:
        """Where all of some rules hold."""
        return self._all_of([self.states(rule.formula) for rule in rules])

    def any_of(self, parts: Sequence[Reference]) -> Reference:
        """The union of some sets."""
        found = NOTHING
        for part in parts:
            found = self._sets.either(found, part)
        return found

    def _atom(self, atom: Is | Executing) -> Reference:
        assert isinstance(atom, Is), "the formula speaks of the state"
        value = self._values[atom.variable][atom.value]
        return self._sets.cube(((self._levels[atom.variable], (value,)),))

    def _all_of(self, parts: Sequence[Reference]) -> Reference:
        found = EVERYTHING
        for part in parts:
            found = self._sets.both(found, part)
        return found
