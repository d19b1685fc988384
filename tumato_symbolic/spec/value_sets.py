"""Formulas about one variable as sets of its values, and back."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.spec.fold import Connectives, fold
from tumato_symbolic.spec.formula import TRUE, Executing, Formula, Is, Or


def values_where(condition: Formula, domain: frozenset[int]) -> frozenset[int]:
    """The values of the only variable that a condition speaks of with which it holds."""
    by: Connectives[frozenset[int]] = Connectives(
        constant=lambda value: domain if value else frozenset(),
        negation=lambda values: domain - values,
        conjunction=lambda several: domain.intersection(*several),
        disjunction=lambda several: frozenset[int]().union(*several),
        equivalence=lambda left, right: domain - (left ^ right),
    )

    def atom(atom: Is | Executing) -> frozenset[int]:
        return frozenset((atom.value,)) if isinstance(atom, Is) else frozenset()

    return fold(condition, atom, by)


def one_of(variable: int, values: Sequence[int], size: int) -> Formula:
    """That a variable, which has so many values, has one of these, at least one."""
    atoms = tuple(Is(variable, value) for value in values)
    return TRUE if len(atoms) == size else Or(atoms) if len(atoms) > 1 else atoms[0]
