"""Everything that synthesis asks of Z3."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import z3

from tumato_symbolic.symbolic import Bdd, Encoding

Term: TypeAlias = Any
"""A Z3 expression; z3 has no types."""

MACHINE_INTEGER = 2**31 - 1
"""Z3's pseudo-Boolean constraints take coefficients of this size; larger durations are summed as integers."""


class CheapestSet:
    """Asks for the smallest total duration in a relation between states and sets of actions.

    The relation can only shrink, so that lower bounds stay proved.
    """

    def __init__(self, encoding: Encoding, relation: Bdd) -> None:
        self._encoding = encoding
        self._bits = {bit: z3.Bool(bit) for bit in encoding.manager.bits}
        self._terms = [
            (z3.And([self._bits[b] == v for b, v in encoding.action_bits(number).items()]), action.duration)
            for number, action in enumerate(encoding.spec.actions)
            if action.duration
        ]
        self._small = sum(duration for _, duration in self._terms) <= MACHINE_INTEGER
        self._solver = z3.SolverFor("QF_FD") if self._small else z3.Solver()
        self._solver.add(self._term(relation))

    def exclude(self, states: Bdd) -> None:
        """Remove states from the relation."""
        self._solver.add(z3.Not(self._term(states)))

    def minimum(self) -> int | None:
        """The smallest duration in what is left of the relation: Z3 found none below. None where nothing is left."""
        best: int | None = None
        self._solver.push()
        while self._solver.check() == z3.sat:
            model = self._solver.model()
            best = sum(d for term, d in self._terms if z3.is_true(model.eval(term, model_completion=True)))
            if best == 0:
                break
            self._solver.add(self._at_most(best - 1))
        self._solver.pop()
        return best

    def _at_most(self, total: int) -> Term:
        if self._small:
            return z3.PbLe(self._terms, total)
        return z3.Sum([z3.If(term, duration, 0) for term, duration in self._terms]) <= total

    def _term(self, u: Bdd) -> Term:
        manager = self._encoding.manager
        terms: dict[Bdd, Term] = {manager.true: z3.BoolVal(True), manager.false: z3.BoolVal(False)}
        for node, level, low, high in manager.descending(u):
            terms[node] = z3.If(self._bits[manager.bits[level]], terms[high], terms[low])
        return terms[u]


@dataclass(frozen=True, slots=True)
class Pick:
    """Option number `option` of choice number `choice`."""

    choice: int
    option: int


class Choices:
    """One option for every choice, under clauses that hold for some guards; option 0 is what was chosen before."""

    def __init__(self) -> None:
        self._solver = z3.SolverFor("QF_FD")
        self._options: list[list[Term]] = []
        self._guards: dict[int, Term] = {}
        self._free: set[int] = set()

    def add_choice(self, options: int) -> int:
        """A new choice among so many options; its number."""
        number = len(self._options)
        literals = [z3.Bool(f"x{number}.{option}") for option in range(options)]
        self._options.append(literals)
        self._solver.add(z3.Or(literals), z3.AtMost(*literals, 1))
        return number

    def require(self, guard: int, picks: Iterable[Pick]) -> None:
        """Where the guard is assumed, at least one of the picks is made."""
        literal = self._guards.setdefault(guard, z3.Bool(f"g{guard}"))
        self._solver.add(z3.Or(z3.Not(literal), *(self._options[p.choice][p.option] for p in picks)))

    def solve(self, guards: Sequence[int] | None = None) -> list[int] | frozenset[int]:
        """An option for every choice, as few as can be seen different from 0; or guards that cannot hold together.

        All guards are assumed where none are given.
        """
        assumed = [
            self._guards[guard] for guard in (self._guards if guards is None else guards) if guard in self._guards
        ]
        while True:
            kept = [options[0] for number, options in enumerate(self._options) if number not in self._free]
            if self._solver.check(*assumed, *kept) == z3.sat:
                model = self._solver.model()
                return [
                    next(n for n, x in enumerate(options) if z3.is_true(model.eval(x, model_completion=True)))
                    for options in self._options
                ]
            names = {literal.decl().name() for literal in self._solver.unsat_core()}
            freed = {int(name[1:].split(".")[0]) for name in names if name.startswith("x")}
            if not freed:
                return frozenset(int(name[1:]) for name in names)
            self._free |= freed
