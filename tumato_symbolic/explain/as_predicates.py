"""Sets of states as predicates in the syntax of specifications."""

from __future__ import annotations

from collections.abc import Sequence

from tumato_symbolic.explain.cubes import StateCube, shortest_cubes
from tumato_symbolic.spec import FALSE, TRUE, And, Constant, Executing, Formula, Iff, Is, Not, Or, Spec, canonical_text
from tumato_symbolic.symbolic import Bdd, Encoding

MANY_CUBES = 500
"""Of a set that needs more cubes than its complement, so many are looked at before it is given up."""


def conjunction(parts: Sequence[Formula]) -> Formula:
    """All of some formulas."""
    return And(tuple(parts)) if len(parts) > 1 else parts[0] if parts else TRUE


def disjunction(parts: Sequence[Formula]) -> Formula:
    """At least one of some formulas."""
    return Or(tuple(parts)) if len(parts) > 1 else parts[0] if parts else FALSE


def cube_formula(spec: Spec, cube: StateCube) -> Formula:
    """The states of a cube: a literal, or a few, for every variable that matters."""
    parts: list[Formula] = []
    for variable, values in enumerate(cube):
        others = [value for value in range(len(spec.variables[variable].values)) if value not in values]
        if not others:
            continue
        if len(values) <= len(others):
            parts.append(disjunction([Is(variable, value) for value in values]))
        else:
            parts += [Not(Is(variable, value)) for value in others]
    return conjunction(parts)


def shortest_formula(encoding: Encoding, states: Bdd, indifferent: Bdd) -> Formula:
    """A short formula that holds in `states`, and elsewhere in some of `indifferent` only.

    The shorter of two: one of these, or none of those cubes.
    """
    spec = encoding.spec
    inside = shortest_cubes(encoding, states, indifferent, MANY_CUBES)
    others = encoding.domain() & ~(states | indifferent)
    outside = shortest_cubes(encoding, others, indifferent, MANY_CUBES)
    if inside is None and outside is None:
        outside = shortest_cubes(encoding, others, indifferent)
    candidates: list[Formula] = []
    if inside is not None:
        candidates.append(disjunction([cube_formula(spec, cube) for cube in inside]))
    if outside is not None:
        candidates.append(conjunction([_negated(cube_formula(spec, cube)) for cube in outside]))
    return min(candidates, key=lambda formula: len(predicate_text(spec, formula)))


def _negated(formula: Formula) -> Formula:
    """The negation; of a single negated predicate, that predicate."""
    return formula.operand if isinstance(formula, Not) else Not(formula)


def in_other_words(spec: Spec, formula: Formula) -> Formula:
    """The same said by the other values of each variable."""
    match formula:
        case Is(variable, value):
            return conjunction([Not(Is(variable, other)) for other in _others(spec, variable, value)])
        case Not(Is(variable, value)):
            return disjunction([Is(variable, other) for other in _others(spec, variable, value)])
        case Not(operand):
            return Not(in_other_words(spec, operand))
        case And(operands):
            return And(tuple(in_other_words(spec, each) for each in operands))
        case Or(operands):
            return Or(tuple(in_other_words(spec, each) for each in operands))
        case _:
            return formula


def _others(spec: Spec, variable: int, value: int) -> list[int]:
    return [other for other in range(len(spec.variables[variable].values)) if other != value]


def predicate_text(spec: Spec, formula: Formula) -> str:
    """A formula as a user writes it, with the parentheses that the language needs."""
    return _text(spec, formula, 0)


_LEVELS: dict[type, int] = {Iff: 0, Or: 2, And: 3, Not: 4}
"""How tightly each operator binds; what stands below a tighter one needs parentheses."""


def _text(spec: Spec, formula: Formula, level: int) -> str:
    match formula:
        case Constant() | Is() | Executing():
            return canonical_text(spec, formula)
        case Not(operand):
            return f"NOT {_text(spec, operand, 5)}"
        case And(operands):
            text = " AND ".join(_text(spec, part, 4) for part in operands)
        case Or(operands):
            text = " OR ".join(_text(spec, part, 4) for part in operands)
        case Iff(left, right):
            text = f"{_text(spec, left, 2)} IFONLYIF {_text(spec, right, 2)}"
    return f"({text})" if _LEVELS[type(formula)] < level else text
