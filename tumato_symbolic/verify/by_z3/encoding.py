"""States, formulas and diagrams as Z3 terms: every variable in as few Booleans as its values need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import z3

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Assignment, Connectives, Executing, Formula, Is, Spec, fold
from tumato_symbolic.verify.by_z3.terms import (
    Context,
    Number,
    Term,
    at_most_one,
    code_at_most,
    conjunction,
    disjunction,
    either,
    negation,
    same,
)


class Place:
    """A state that terms speak of: `bits[v]` codes the value number of variable `v`, least significant bit first."""

    def __init__(self, bits: Sequence[Sequence[Term]]) -> None:
        self.bits = tuple(tuple(code) for code in bits)

    @classmethod
    def fresh(cls, spec: Spec, name: str, context: Context) -> Place:
        """A state of unknowns."""
        widths = [(len(variable.values) - 1).bit_length() for variable in spec.variables]
        return cls(
            [
                [z3.Bool(f"{name}.{number}.{place}", context) for place in range(width)]
                for number, width in enumerate(widths)
            ]
        )

    def has(self, variable: int, value: int) -> Term:
        """The variable has this value."""
        return conjunction(
            bit if value >> place & 1 else negation(bit) for place, bit in enumerate(self.bits[variable])
        )

    def after(self, assignment: Assignment) -> Place:
        """This state after an effect."""
        bits = list(self.bits)
        for variable, value in assignment:
            bits[variable] = tuple(bool(value >> place & 1) for place in range(len(bits[variable])))
        return Place(bits)

    def in_range(self, spec: Spec) -> Term:
        """Every code is that of a value."""
        return conjunction(
            code_at_most(code, len(variable.values) - 1)
            for code, variable in zip(self.bits, spec.variables, strict=True)
        )

    def read(self, model: Any) -> State:  # noqa: ANN401 - z3 has no types
        """The state that a model gives."""
        return tuple(sum(1 << place for place, bit in enumerate(code) if is_true(model, bit)) for code in self.bits)


def is_true(model: Any, term: Term) -> bool:  # noqa: ANN401 - z3 has no types
    """What a model says of a term; what it leaves open is false."""
    return term if isinstance(term, bool) else z3.is_true(model.eval(term, model_completion=True))


def formula_term(formula: Formula, place: Place, executed: Sequence[Term] = ()) -> Term:
    """`formula` in the state `place`, while the actions run for which `executed` holds."""

    def atom(atom: Is | Executing) -> Term:
        return place.has(atom.variable, atom.value) if isinstance(atom, Is) else executed[atom.action]

    return fold(formula, atom, TERMS)


TERMS: Connectives[Term] = Connectives(
    constant=lambda value: value,
    negation=negation,
    conjunction=conjunction,
    disjunction=disjunction,
    equivalence=same,
)
"""What the connectives of formulas are among terms."""


def valid_term(spec: Spec, place: Place) -> Term:
    """`place ∈ V`."""
    return conjunction(formula_term(rule.formula, place) for rule in spec.validity)


def safe_term(spec: Spec, place: Place) -> Term:
    """`place ∈ S`."""
    return conjunction(formula_term(rule.formula, place) for rule in (*spec.validity, *spec.state_rules))


def successor_place(spec: Spec, place: Place, executed: Sequence[Term]) -> Place:
    """`δ(s, A)`, for nominal effects that agree: a bit is set if an effect sets it, or it was and none writes it."""
    writers: list[list[tuple[int, int]]] = [[] for _ in spec.variables]
    for number, action in enumerate(spec.actions):
        for variable, value in action.nominal:
            writers[variable].append((number, value))
    bits: list[list[Term]] = []
    for variable, code in enumerate(place.bits):
        kept = negation(disjunction(executed[number] for number, _ in writers[variable]))
        bits.append(
            [
                disjunction(
                    [
                        *(executed[number] for number, value in writers[variable] if value >> digit & 1),
                        conjunction((kept, bit)),
                    ]
                )
                for digit, bit in enumerate(code)
            ]
        )
    return Place(bits)


def agreement_terms(spec: Spec, executed: Sequence[Term]) -> list[Term]:
    """For every variable: no two executed actions give it different values."""
    found: list[Term] = []
    for variable in range(len(spec.variables)):
        setters: dict[int, list[Term]] = {}
        for number, action in enumerate(spec.actions):
            for written, value in action.nominal:
                if written == variable:
                    setters.setdefault(value, []).append(executed[number])
        found.append(at_most_one(disjunction(terms) for terms in setters.values()))
    return found


def diagram_terms(
    diagram: Diagram[Any], roots: Sequence[Reference], place: Place, leaf: Callable[[Any], Term | Number]
) -> list[Term | Number]:
    """What the roots of a diagram lead to in the state `place`; every node becomes one shared term."""
    base = len(diagram.leaves)
    needed = _below(diagram, roots)
    terms: dict[Reference, Term | Number] = {number: leaf(value) for number, value in enumerate(diagram.leaves)}
    shared: dict[tuple[int, int, tuple[int, ...]], Term | Number] = {}
    for number, (level, below) in enumerate(diagram.nodes):
        if base + number in needed:
            variable = diagram.order[level]
            terms[base + number] = _select(variable, place.bits[variable], [terms[child] for child in below], shared)
    return [terms[root] for root in roots]


def _below(diagram: Diagram[Any], roots: Sequence[Reference]) -> set[Reference]:
    base = len(diagram.leaves)
    found: set[Reference] = set()
    pending = list(roots)
    while pending:
        root = pending.pop()
        if root not in found:
            found.add(root)
            if root >= base:
                pending.extend(diagram.nodes[root - base][1])
    return found


def _select(
    variable: int,
    bits: Sequence[Term],
    children: list[Term | Number],
    shared: dict[tuple[int, int, tuple[int, ...]], Term | Number],
) -> Term | Number:
    """The child with the number that `bits` code; halves are shared between nodes of the same variable."""
    if len(children) == 1 or not bits:
        return children[0]
    half = 1 << (len(bits) - 1)
    key = (variable, len(bits), tuple(map(id, children)))
    found = shared.get(key)
    if found is None:
        low = _select(variable, bits[:-1], children[:half], shared)
        high = _select(variable, bits[:-1], children[half:], shared) if len(children) > half else low
        found = shared[key] = either(bits[-1], high, low)
    return found
