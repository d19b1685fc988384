"""The parts of an action's effects that depend on the state in the same variables, and what may happen in each.

Clauses whose conditions share variables belong to one *component*. Its parts are found by looking at the values of its
variables; the cases of an action are the product of those of its components.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import prod
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.spec.clauses import Clause, ClauseSet
from tumato_symbolic.spec.effects import conjunction
from tumato_symbolic.spec.formula import TRUE, Formula, Is, Or, variables_of
from tumato_symbolic.spec.satisfiability import Budget, size, truth
from tumato_symbolic.spec.value_sets import one_of, values_where

COMBINATION = 20
"""As many terms take as long as one combination of values, besides those of its conditions."""

Active: TypeAlias = tuple[tuple[int, int, tuple[Formula, ...]], ...]
"""Which effects happen: the number of their set, that of their clause, and the predicates."""


class Part(Struct, frozen=True):
    """A case of one component: what happens in it, and where it is met."""

    active: Active
    guard: Formula


class Component(Struct, frozen=True):
    """Clauses that share variables, each with the number of its set and its own."""

    variables: tuple[int, ...]
    clauses: tuple[tuple[int, int, Clause], ...]


def components(sets: Sequence[ClauseSet]) -> list[Component]:
    """All clauses that depend on the state, by the variables that they depend on."""
    found: list[tuple[frozenset[int], list[tuple[int, int, Clause]]]] = []
    for number, place, clause in _depending(sets):
        mentioned = variables_of(clause.condition) | {change.variable for change in clause.changes}
        touching = [one for one in found if one[0] & mentioned or not (one[0] or mentioned)]
        others = [one for one in found if not any(one is each for each in touching)]
        clauses = [each for one in touching for each in one[1]]
        found = [*others, (mentioned.union(*(one[0] for one in touching)), [*clauses, (number, place, clause)])]
    return [Component(tuple(sorted(variables)), tuple(clauses)) for variables, clauses in found]


def _depending(sets: Sequence[ClauseSet]) -> Iterator[tuple[int, int, Clause]]:
    """Clauses with the number of their set and their own; relative effects before all clauses each for itself."""
    for number, each in enumerate(sets):
        base, *others = each.clauses
        yield from ((number, 0, Clause(TRUE, (), (change,), base.span)) for change in base.changes)
        yield from ((number, place, clause) for place, clause in enumerate(others, 1))


def parts(component: Component, sizes: Mapping[int, int], work: Budget) -> list[Part]:
    """The cases of one component: combinations of values are in one where the same happens.

    `sizes` are the numbers of values of variables. Raises `OutOfBudgetError` where that takes more than `work`.
    """
    happening = (_by_value if len(component.variables) == 1 else _by_values)(component, sizes, work)
    cases: dict[frozenset[tuple[int, Formula]], int] = {}
    found: list[Active] = []
    table: list[int] = []
    for active in happening:
        effects = frozenset((number, formula) for number, _, fixed in active for formula in fixed)
        if effects not in cases:
            cases[effects] = len(found)
            found.append(active)
        table.append(cases[effects])
    guards = _guards(tuple(table), [(each, sizes[each]) for each in component.variables])
    return [Part(active, guards[number]) for number, active in enumerate(found)]


def _by_value(component: Component, sizes: Mapping[int, int], work: Budget) -> Iterator[Active]:
    """What happens at each value of the only variable."""
    (variable,) = component.variables
    domain = frozenset(range(sizes[variable]))
    happening: list[list[tuple[int, int, tuple[Formula, ...]]]] = [[] for _ in domain]
    for number, place, clause in component.clauses:
        values = values_where(clause.condition, domain)
        work.spend(size(clause.condition) + len(values))
        for value in values:
            happening[value].append((number, place, _happening(clause, {variable: value})))
    return (tuple(sorted(active, key=_place)) for active in happening)


def _by_values(component: Component, sizes: Mapping[int, int], work: Budget) -> Iterator[Active]:
    """What happens at each combination of values of the variables, the last of which changes fastest."""
    variables = component.variables
    combinations = prod(sizes[variable] for variable in variables)
    work.spend(combinations * (COMBINATION + sum(size(clause.condition) for _, _, clause in component.clauses)))
    for values in product(*(range(sizes[variable]) for variable in variables)):
        here = dict(zip(variables, values, strict=True))
        known = {("variable", variable): value for variable, value in here.items()}
        yield tuple(
            (number, place, _happening(clause, here))
            for number, place, clause in component.clauses
            if truth(clause.condition, known) is True
        )


def _happening(clause: Clause, values: dict[int, int]) -> tuple[Formula, ...]:
    """The effects of a clause where variables have these values."""
    relative = [Is(change.variable, change.results[values[change.variable]]) for change in clause.changes]
    return (*clause.fixed, *relative)


def _place(active: tuple[int, int, tuple[Formula, ...]]) -> tuple[int, int]:
    return active[:2]


def _guards(table: tuple[int, ...], variables: Sequence[tuple[int, int]]) -> dict[int, Formula]:
    """Where each number stands in a table over the values of variables, which come with the numbers of their values."""
    if not variables:
        return {table[0]: TRUE}
    (variable, size), *others = variables
    length = len(table) // size
    rows: dict[tuple[int, ...], list[int]] = {}
    for value in range(size):
        rows.setdefault(table[value * length : (value + 1) * length], []).append(value)
    found: dict[int, dict[Formula, list[int]]] = {}
    for row, values in rows.items():
        for number, inner in _guards(row, others).items():
            found.setdefault(number, {}).setdefault(inner, []).extend(values)
    guards: dict[int, Formula] = {}
    for number, parts in found.items():
        each = [
            conjunction([formula for formula in (one_of(variable, sorted(values), size), inner) if formula != TRUE])
            for inner, values in parts.items()
        ]
        guards[number] = Or(tuple(each)) if len(each) > 1 else each[0]
    return guards
