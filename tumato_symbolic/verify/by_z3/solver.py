"""Z3 as the prover asks it: scopes, definitions and deadlines."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal, TypeAlias

import z3

from tumato_symbolic.verify.by_z3.terms import Context, Term
from tumato_symbolic.verify.undecided import UndecidedError

__all__ = ["Answer", "Solver", "UndecidedError"]

Answer: TypeAlias = Literal["sat", "unsat", "unknown"]

NO_TIMEOUT = 4294967295
"""What Z3 takes, in milliseconds, for no limit."""
LONGEST = 4_000_000.0
"""Longer limits, in seconds, are none."""


def _finite_domain_solver(context: Context) -> Any:  # noqa: ANN401 - z3 has no types
    """What `z3.SolverFor` makes, without the process-wide context, which it would make beside this one."""
    return z3.Solver(z3.Z3_mk_solver_for_logic(context.ref(), z3.to_symbol("QF_FD", context)), context)


class Solver:
    """A Z3 solver for finite domains, in a given context or in one of its own.

    It is asked in Z3's C interface as well, where that takes a tenth of the time.
    """

    def __init__(self, context: Context | None = None) -> None:
        self.context: Context = z3.Context() if context is None else context
        self._solver = _finite_domain_solver(self.context)
        self._settings = z3.ParamsRef(self.context)
        self._timeout = z3.to_symbol("timeout", self.context)
        self._depth = 0
        self._lost: list[Term] = []
        self._model: Any = None

    def add(self, *terms: Term) -> None:
        """Assume `terms` from now on."""
        for term in terms:
            if term is not True:
                asserted = z3.BoolVal(False, self.context) if term is False else term
                z3.Z3_solver_assert(self.context.ref(), self._solver.solver, asserted.as_ast())

    def define(self, term: Term) -> None:
        """Assume a definition for good, also when a scope is open."""
        self.add(term)
        if self._depth:
            self._lost.append(term)

    @contextmanager
    def scope(self, *terms: Term) -> Iterator[None]:
        """Assume `terms`, and whatever is added meanwhile, for a while."""
        self._solver.push()
        self._depth += 1
        try:
            self.add(*terms)
            yield
        finally:
            self._solver.pop()
            self._depth -= 1
            self.add(*self._lost)
            if not self._depth:
                self._lost = []

    def ask(self, *terms: Term, deadline: float = math.inf) -> Answer:
        """Whether `terms` can hold together with the assumptions; unknown when `deadline` (monotonic) comes first."""
        if any(term is False for term in terms):
            return "unsat"
        left = deadline - time.monotonic()
        if left <= 0:
            return "unknown"
        self._set_timeout(NO_TIMEOUT if left > LONGEST else max(1, int(left * 1000)))
        with self.scope(*terms):
            answer = str(self._solver.check())
            self._model = self._solver.model() if answer == "sat" else None
            if answer == "unknown" and "interrupted" in self._solver.reason_unknown():
                raise KeyboardInterrupt  # Z3 takes the signal for itself
        return "sat" if answer == "sat" else "unsat" if answer == "unsat" else "unknown"

    def _set_timeout(self, milliseconds: int) -> None:
        context = self.context.ref()
        z3.Z3_params_set_uint(context, self._settings.params, self._timeout, milliseconds)
        z3.Z3_solver_set_params(context, self._solver.solver, self._settings.params)

    @property
    def model(self) -> Any:  # noqa: ANN401 - z3 has no types
        """The model of the last `sat`."""
        return self._model
