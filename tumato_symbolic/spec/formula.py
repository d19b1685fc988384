"""Resolved predicates: names are numbers, aliases are gone, an implication is a disjunction.

Formulas are plain frozen trees, compared by structure. Their size is bounded by the resolver, so that recursion
over them is safe.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from msgspec import Struct


class Constant(Struct, frozen=True):
    """`true` or `false`."""

    value: bool


class Is(Struct, frozen=True):
    """Variable number `variable` has its value number `value`."""

    variable: int
    value: int


class Executing(Struct, frozen=True):
    """Action number `action` is in the set that is executed."""

    action: int


class Not(Struct, frozen=True):
    """Negation."""

    operand: Formula


class And(Struct, frozen=True):
    """Conjunction of two or more formulas."""

    operands: tuple[Formula, ...]


class Or(Struct, frozen=True):
    """Disjunction of two or more formulas; `IF p THEN q` is `Or((Not(p), q))`."""

    operands: tuple[Formula, ...]


class Iff(Struct, frozen=True):
    """Both sides have the same truth value."""

    left: Formula
    right: Formula


Formula: TypeAlias = Constant | Is | Executing | Not | And | Or | Iff

TRUE = Constant(True)
FALSE = Constant(False)


def children(formula: Formula) -> tuple[Formula, ...]:
    """The direct parts of a formula."""
    match formula:
        case Not(operand):
            return (operand,)
        case And(operands) | Or(operands):
            return operands
        case Iff(left, right):
            return (left, right)
        case _:
            return ()


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """The parts that a formula is the conjunction of, none of which is one itself."""
    if isinstance(formula, And):
        for operand in formula.operands:
            yield from conjuncts(operand)
    else:
        yield formula


def atoms(formula: Formula) -> Iterator[Is | Executing]:
    """Every atom of a formula, from left to right, repetitions included."""
    if isinstance(formula, Is | Executing):
        yield formula
    for part in children(formula):
        yield from atoms(part)


def executing_atoms(formula: Formula) -> frozenset[int]:
    """The actions whose execution a formula mentions."""
    return frozenset(atom.action for atom in atoms(formula) if isinstance(atom, Executing))


def variables_of(formula: Formula) -> frozenset[int]:
    """The state variables that a formula mentions."""
    found: set[int] = set()
    seen: set[int] = set()
    waiting = [formula]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Is):
            found.add(part.variable)
        elif id(part) not in seen:  # parts may be shared, over and over again
            seen.add(id(part))
            waiting += children(part)
    return frozenset(found)
