"""Everything that synthesis asks of Z3: cheapest sets, choices under clauses, smallest hitting sets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

import z3

from tumato_symbolic.limits import LimitReachedError
from tumato_symbolic.symbolic import Bdd, Encoding, Manager
from tumato_symbolic.synthesis.picks import Pick

Term: TypeAlias = Any
"""A Z3 expression; z3 has no types."""

LONGEST = 4_000_000.0
"""Z3 counts milliseconds in 32 bits: longer limits, in seconds, are this one."""

MACHINE_INTEGER = 2**31 - 1
"""Z3's pseudo-Boolean constraints take coefficients of this size; larger durations are summed as integers."""


class CheapestSet:
    """Asks for the smallest total duration in a relation between states and sets of actions.

    The relation can only shrink, so that lower bounds stay proved.
    """

    def __init__(self, encoding: Encoding, relation: Bdd) -> None:
        self._encoding = encoding
        self._context = z3.Context()
        self._bits = {bit: z3.Bool(bit, self._context) for bit in encoding.manager.bits}
        self._terms = [
            (z3.And([self._bits[b] == v for b, v in encoding.action_bits(number).items()]), action.duration)
            for number, action in enumerate(encoding.spec.actions)
            if action.duration
        ]
        self._small = sum(duration for _, duration in self._terms) <= MACHINE_INTEGER
        self._solver = _finite_domain_solver(self._context) if self._small else z3.Solver(ctx=self._context)
        self._solver.add(self._term(relation))

    def exclude(self, states: Bdd) -> None:
        """Remove states from the relation."""
        self._solver.add(z3.Not(self._term(states)))

    def minimum(self) -> int | None:
        """The smallest duration in what is left of the relation: Z3 found none below. None where nothing is left."""
        best: int | None = None
        self._solver.push()
        while _satisfiable(self._solver, seconds=self._encoding.manager.context.seconds_left()):
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
        terms: dict[Bdd, Term] = {
            manager.true: z3.BoolVal(True, self._context),
            manager.false: z3.BoolVal(False, self._context),
        }
        for node, level, low, high in manager.descending(u):
            terms[node] = z3.If(self._bits[manager.bits[level]], terms[high], terms[low])
        return terms[u]


class Choices:
    """One option for every choice, under clauses that hold for some guards; option 0 is what was chosen before."""

    def __init__(self, manager: Manager) -> None:
        self._manager = manager
        self._context = z3.Context()
        self._solver = _finite_domain_solver(self._context)
        self._options: list[list[Term]] = []
        self._guards: dict[int, Term] = {}
        self._kept: dict[int, Term] = {}
        self._clauses: list[tuple[Pick, ...]] = []
        self._names: dict[int, tuple[int, bool]] = {}

    def add_choice(self, options: int) -> int:
        """A new choice among so many options; its number."""
        number = len(self._options)
        literals = [z3.Bool(f"x{number}.{option}", self._context) for option in range(options)]
        self._options.append(literals)
        self._kept[number] = literals[0]
        self._names[literals[0].get_id()] = (number, False)
        self._solver.add(_any(literals, self._context), z3.AtMost(*literals, 1))
        return number

    def require(self, guard: int, picks: Sequence[Pick]) -> None:
        """A clause: where the guard is assumed, at least one of the picks is made."""
        self._clauses.append(tuple(picks))
        if guard not in self._guards:
            literal = self._guards[guard] = z3.Bool(f"g{guard}", self._context)
            self._names[literal.get_id()] = (guard, True)
        picked = (self._options[pick.choice][pick.option] for pick in picks)
        self._solver.add(_any([z3.Not(self._guards[guard]), *picked], self._context))

    def solve(self, guards: Sequence[int] | None = None) -> list[int] | frozenset[int]:
        """An option for every choice, as few as can be seen different from 0; or guards that cannot hold together.

        All guards are assumed where none are given.
        """
        wanted = self._guards if guards is None else guards
        assumed = [self._guards[guard] for guard in wanted if guard in self._guards]
        while not _satisfiable(
            self._solver, *assumed, *self._kept.values(), seconds=self._manager.context.seconds_left()
        ):
            named = [self._names[literal.get_id()] for literal in self._solver.unsat_core()]
            freed = [number for number, is_guard in named if not is_guard]
            if not freed:
                return frozenset(number for number, _ in named)
            for number in freed:
                del self._kept[number]
        return self._read(self._solver.model())

    def refutation(self, clauses: Sequence[int]) -> list[int]:
        """Those of some clauses (by number) that contradict each other; together they must."""
        solver = _finite_domain_solver(self._context)
        for literals in self._options:
            solver.add(_any(literals, self._context), z3.AtMost(*literals, 1))
        guards = {number: z3.Bool(f"c{number}", self._context) for number in clauses}
        for number, guard in guards.items():
            picked = [self._options[pick.choice][pick.option] for pick in self._clauses[number]]
            solver.add(_any([z3.Not(guard), *picked], self._context))
        while True:
            satisfiable = _satisfiable(solver, *guards.values(), seconds=self._manager.context.seconds_left())
            assert not satisfiable, "the clauses of a conflict hold together"
            core = {literal.get_id() for literal in solver.unsat_core()}
            kept = {number: guard for number, guard in guards.items() if guard.get_id() in core}
            if len(kept) == len(guards):
                return list(kept)
            guards = kept

    def _read(self, model: Term) -> list[int]:
        """The option that the model makes for every choice."""
        return [
            0 if number in self._kept else next(n for n, x in enumerate(options) if _is_true(model, x))
            for number, options in enumerate(self._options)
        ]


# What repair does most is made of direct calls: z3's Python layer inspects every part of every term.


def _is_true(model: Term, literal: Term) -> bool:
    """Whether a model makes a constant true."""
    context = literal.ctx_ref()
    declaration = z3.Z3_get_app_decl(context, literal.as_ast())
    found = z3.Z3_model_get_const_interp(context, model.model, declaration)
    return bool(found) and z3.Z3_get_bool_value(context, found) == z3.Z3_L_TRUE


def _finite_domain_solver(context: Term) -> Term:
    """What `z3.SolverFor` makes, without the process-wide context, which it would make beside this one."""
    return z3.Solver(z3.Z3_mk_solver_for_logic(context.ref(), z3.to_symbol("QF_FD", context)), context)


def _any(literals: Sequence[Term], context: Term) -> Term:
    """A disjunction."""
    parts = (z3.Ast * len(literals))(*(literal.as_ast() for literal in literals))
    return z3.BoolRef(z3.Z3_mk_or(context.ref(), len(literals), parts), context)


def _satisfiable(solver: Term, *assumptions: Term, seconds: float | None = None) -> bool:
    """Z3's answer, which must not be `unknown`: that is neither a minimum nor a proof of conflict.

    Raises `LimitReachedError` where it takes more than so many seconds.

    Z3 takes Ctrl-C for itself and stops with `unknown`; it is handed on as the `KeyboardInterrupt` that it was.
    """
    if seconds is not None:
        solver.set("timeout", max(1, int(1000 * min(seconds, LONGEST))))
    answer = solver.check(*assumptions)
    if answer == z3.unknown:
        if "interrupted" in solver.reason_unknown():
            raise KeyboardInterrupt
        if seconds is not None:
            raise LimitReachedError("the time limit was met while Z3 was at work")
        raise RuntimeError(f"Z3 gave no answer: {solver.reason_unknown()}")
    return bool(answer == z3.sat)


class HittingSets:
    """Smallest sets of numbers that have an element in common with each of some sets.

    `penalties` has one for every number, from 0 on: of the smallest sets one with the least sum comes first, and of
    these the first as a sorted list. `seconds_left` is asked whenever Z3 is.
    """

    def __init__(self, penalties: Sequence[int], seconds_left: Callable[[], float | None] = lambda: None) -> None:
        self._seconds_left = seconds_left
        self._context = z3.Context()
        self._solver = _finite_domain_solver(self._context)
        self._literals = [z3.Bool(f"h{number}", self._context) for number in range(len(penalties))]
        self._penalties = list(penalties)
        self._useful: set[int] = set()
        self._least = 0

    def require(self, numbers: Sequence[int]) -> None:
        """One of these numbers must be chosen."""
        self._useful |= set(numbers)
        self._solver.add(_any([self._literals[number] for number in numbers], self._context))

    def exclude(self, numbers: Sequence[int]) -> None:
        """Not all of these numbers may be chosen."""
        self._solver.add(_any([z3.Not(self._literals[number]) for number in numbers], self._context))

    def penalize(self, numbers: Iterable[int], more: int) -> None:
        """Add to the penalties of some numbers."""
        for number in numbers:
            self._penalties[number] += more

    def smallest(self) -> frozenset[int] | None:
        """A set of the smallest size; None where there is none. Sizes never fall from one answer to the next."""
        if not self._possible():
            return None
        while True:
            self._solver.push()
            if self._literals:
                self._solver.add(z3.AtMost(*self._literals, self._least))
            found = self._first() if self._possible() else None
            self._solver.pop()
            if found is not None:
                return found
            self._least += 1

    def _first(self) -> frozenset[int]:
        """The set to prefer among those that the constraints of now allow, which all have the same size."""
        least = self._penalty_of_model()
        while least and self._possible(self._at_most(least - 1)):
            least = self._penalty_of_model()
        wanted: list[Term] = [self._at_most(least)]
        chosen: list[int] = []
        for number in sorted(self._useful):
            if len(chosen) == self._least:
                break
            if self._possible(*wanted, self._literals[number]):
                wanted.append(self._literals[number])
                chosen.append(number)
        return frozenset(chosen)

    def _possible(self, *assumptions: Term) -> bool:
        return _satisfiable(self._solver, *assumptions, seconds=self._seconds_left())

    def _penalty_of_model(self) -> int:
        model = self._solver.model()
        pairs = zip(self._literals, self._penalties, strict=True)
        return sum(penalty for literal, penalty in pairs if _is_true(model, literal))

    def _at_most(self, total: int) -> Term:
        """The penalties of what is chosen sum up to so much at most, as a literal that implies it."""
        terms = [
            (literal, penalty) for literal, penalty in zip(self._literals, self._penalties, strict=True) if penalty
        ]
        bound = z3.Bool(f"p{total}", self._context)
        self._solver.add(z3.Implies(bound, z3.PbLe(terms, total) if terms else z3.BoolVal(True, self._context)))
        return bound
