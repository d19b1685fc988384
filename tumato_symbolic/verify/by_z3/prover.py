"""The properties of a policy, proved by Z3 (`docs/certificate.md`, tier 1)."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from tumato_symbolic.diagrams import count_true
from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import Policy, Table, as_diagram
from tumato_symbolic.semantics import is_valid
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_z3.encoding import formula_term
from tumato_symbolic.verify.by_z3.goals_property import prove_goals
from tumato_symbolic.verify.by_z3.minimal_property import prove_minimal
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.rank_source import RankSource
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.by_z3.step_property import prove_safe, prove_total
from tumato_symbolic.verify.by_z3.terms import conjunction, negation
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult

if TYPE_CHECKING:
    from tumato_symbolic.verify.by_z3.effort_source import EffortSource


class Z3Prover:
    """Proves or refutes the properties of one policy; `budget` limits each obligation.

    `policy_is_safe` is whether `safe` is known to be proved.
    """

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> None:
        self._spec = spec
        self._policy = policy
        self._ordering = ordering
        self._problem = PolicyProblem(spec, as_diagram(policy), budget)
        self.policy_is_safe = False
        self._total = False

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""
        return self._ranks.use if "_ranks" in self.__dict__ else CertificateUse("unneeded")

    @cached_property
    def _ranks(self) -> RankSource:
        return RankSource(self._problem, self._policy, self._ordering, self.policy_is_safe)

    @cached_property
    def _efforts(self) -> EffortSource:
        from tumato_symbolic.verify.by_z3.effort_source import EffortSource

        return EffortSource(self._problem, self._ranks, self._ordering, self.policy_is_safe)

    def has_valid_state(self) -> bool:
        """Whether some state satisfies all assumptions, and is a start, as far as Z3 can tell."""
        problem = self._problem
        start = formula_term(self._spec.start, problem.state)
        return problem.solver.ask(problem.valid_at_all, start, deadline=problem.deadline()) != "unsat"

    def prove(self, name: PropertyName, within: float = math.inf) -> PropertyResult:
        """The verdict on one property; undecided where an obligation, or all in `within` seconds, take too long."""
        self._problem.latest = time.monotonic() + within
        try:
            match name:
                case "total":
                    result = prove_total(self._problem)
                case "safe":
                    result = prove_safe(self._problem, self._ordering)
                case "restoring":
                    from tumato_symbolic.verify.by_z3.restoring_property import prove_restoring

                    result = prove_restoring(self._problem, self._efforts, self._ordering)
                case "goals":
                    result = prove_goals(self._problem, self._ranks)
                case _ if self._spec.restores_stepwise:
                    from tumato_symbolic.verify.by_z3.best_property import prove_best

                    result = prove_best(self._problem, self._efforts, self._ordering)
                case _:
                    result = prove_minimal(self._problem, self._ranks, self._ordering)
        except UndecidedError as undecided:
            return PropertyResult(name, "undecided", reason=str(undecided))
        self._total |= name == "total" and result.verdict == "proved"
        self.policy_is_safe |= name == "safe" and result.verdict == "proved"
        return result

    def prove_parts(
        self, names: Sequence[PropertyName], jobs: int, started: Callable[[PropertyName], None]
    ) -> dict[PropertyName, float]:
        """Nothing: what Z3 answers depends on what it was asked before."""
        del names, jobs, started
        return {}

    def valid_states(self) -> int | None:
        """How many states are valid: known where each of them is decided, and the others can be told apart."""
        if not self._total:
            return None
        decisions = self._policy.decisions
        if isinstance(decisions, Table):
            return sum(is_valid(self._spec, state) for state in decisions.rows)
        others = conjunction((self._problem.defined, negation(self._problem.valid)))
        if self._problem.solver.ask(others, deadline=self._problem.deadline()) != "unsat":
            return None
        return count_true(decisions.diagram, decisions.defined, self._policy.vocabulary.sizes)
