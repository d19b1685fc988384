"""The properties of a policy, proved by the walk: no Z3 (`docs/certificate.md`, tier 2)."""

from __future__ import annotations

import time
from collections.abc import Callable, Hashable, Mapping, Sequence
from functools import cached_property, partial

from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import Policy, as_diagram
from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function, given_up
from tumato_symbolic.verify.by_diagrams.goals import Aim, WalkGoals
from tumato_symbolic.verify.by_diagrams.minimal import minimal
from tumato_symbolic.verify.by_diagrams.parallel import ParallelProofs, Task
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks
from tumato_symbolic.verify.by_diagrams.stepwise import Stepwise
from tumato_symbolic.verify.by_diagrams.witnesses import Witnesses
from tumato_symbolic.verify.claimed_ranks import NO_RANKS, NOT_ALL
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult

FEWEST_NODES = 2_000
"""Ranks with fewer nodes are proved sooner than children are made."""


class WalkProver:
    """Proves or refutes the properties of one policy.

    `policy_is_safe` is whether another prover has proved `safe`; otherwise the walk finds out where it fails.
    """

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, budget: Budget | None = None) -> None:
        self._spec = spec
        self._policy = policy
        self._ordering = ordering
        self._budget = budget or Budget()
        self._parallel = ParallelProofs()
        self.policy_is_safe = False

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""
        return self._ranks.use if "_ranks" in self.__dict__ else CertificateUse("unneeded")

    def prove(self, name: PropertyName, most: int | None = None) -> PropertyResult:
        """The verdict on one property; undecided where the walk takes more time or memory than it is given.

        `most` is how many results may be remembered for it alone.
        """
        before = (self._ranks.use, self._ranks.roots) if self._parallel.answers else None
        try:
            self._model.walk.deadline = self._budget.until(self._parallel.seconds.get(name, 0.0))
            self._model.walk.check_time()
            result = self._within(most, self._proof(name, most))
        except (BudgetError, RecursionError) as error:
            if before is not None and most is None and self._model.walk.is_full:
                self._ranks.use, self._ranks.roots = before
                self._parallel.forget(self._model.walk)
                return self.prove(name)
            return PropertyResult(name, "undecided", reason=given_up(error))
        self.policy_is_safe |= name == "safe" and result.verdict == "proved"
        return result

    def prove_parts(
        self,
        names: Sequence[PropertyName],
        jobs: int,
        started: Callable[[PropertyName], None],
        most: int | None = None,
    ) -> Mapping[PropertyName, float]:
        """Have up to `jobs` children prove parts of these properties; `safe` with no more than `most` results.

        What they find is what would be found here, where `jobs` is 1. Returns how long each property took.
        """
        certificate = self._policy.certificate
        if self._spec.restores_stepwise or not {"goals", "minimal"} & set(names):
            return {}
        if certificate is None or len(certificate.ranks.nodes) < FEWEST_NODES:
            return {}
        try:
            tasks = self._tasks(names, most) if jobs > 1 else []
            if len(tasks) > 1:
                self._parallel.ask(self._model.walk, tasks, jobs, self._budget, started)
            else:
                self._prepare()
        except (BudgetError, RecursionError, OSError):
            return {}
        return self._parallel.seconds

    def _prepare(self) -> None:
        """Compute once what the proofs of `goals` and `minimal` have in common."""
        if "goals" not in self._parallel.seconds:
            began = time.monotonic()
            self._model.walk.deadline = self._budget.until()
            self._ranks.prepare()
            self._parallel.seconds["goals"] = time.monotonic() - began

    def _tasks(self, names: Sequence[PropertyName], most: int | None) -> list[Task]:
        """What children do: nothing where the certificate does not serve."""
        tasks, ranks = list[Task](), self._ranks
        if not ranks.roots:
            return tasks
        if "safe" in names:
            tasks.append(Task("safe", ("safe", most), partial(self._within, most, self._safe)))
        if "goals" in names:
            for goal in ranks.roots:
                tasks.append(Task("goals", ("decreases", goal), partial(ranks.decreases, goal), self._prepare))
        if "minimal" in names:
            tasks.append(Task("minimal", self._minimal_key, self._minimal_apart, self._prepare))
        return tasks

    def _proof(self, name: PropertyName, most: int | None) -> Callable[[], PropertyResult]:
        """How a property is proved."""
        match name:
            case "total":
                return self._total
            case "safe":
                return lambda: self._parallel.take(("safe", most), self._safe)
            case "restoring":
                return lambda: self._stepwise.restoring(lambda: self._not_allowed == FALSE)
            case "goals":
                return self._goals
            case _ if self._spec.restores_stepwise:
                return lambda: self._stepwise.minimal()  # noqa: PLW0108 - made within the limits
            case _:
                return self._minimal_joined

    def has_valid_state(self) -> bool:
        """Whether some state satisfies all assumptions, and is a start, as far as the walk can tell."""
        try:
            return self._start != FALSE
        except (BudgetError, RecursionError):
            return True

    def valid_states(self) -> int | None:
        """How many states are valid; None where even that is too much."""
        try:
            model = self._model
        except (BudgetError, RecursionError):
            return None
        return model.count(model.valid)

    def _within(self, most: int | None, work: Callable[[], PropertyResult]) -> PropertyResult:
        """What `work` finds with at most so many results remembered."""
        walk = self._model.walk
        spared = 0 if most is None else max(0, walk.most - walk.remembered - most)
        walk.most -= spared
        try:
            return work()
        finally:
            walk.most += spared

    @cached_property
    def _model(self) -> ClosedLoop:
        return ClosedLoop(self._spec, as_diagram(self._policy), self._ordering, self._budget.until())

    @cached_property
    def _violations(self) -> list[Function]:
        """One for every obligation of `safe`."""
        return [violation for _, violation in self._model.obligations()]

    @cached_property
    def _not_allowed(self) -> Function:
        return FALSE if self.policy_is_safe else self._model.walk.any_of(self._violations)

    @cached_property
    def _ranks(self) -> WalkRanks:
        return WalkRanks(self._model, self._residual_goals, self._policy, lambda: self._not_allowed == FALSE)

    @cached_property
    def _residual_goals(self) -> WalkGoals:
        return WalkGoals(self._model)

    @cached_property
    def _stepwise(self) -> Stepwise:
        decisions = Decisions(self._spec, self._policy)
        return Stepwise(self._model, self._residual_goals, self._ranks, decisions, self._ordering)

    @cached_property
    def _witnesses(self) -> Witnesses:
        return Witnesses(self._model, Decisions(self._spec, self._policy), self._ordering)

    def _total(self) -> PropertyResult:
        if self._spec.starts:
            return self._starts()
        missing = self._model.walk.without(self._model.valid, self._model.decided)
        if missing == FALSE:
            return PropertyResult("total", "proved", 1, "walk")
        return self._witnesses.missing(missing)

    def _starts(self) -> PropertyResult:
        model, walk = self._model, self._model.walk
        missing = walk.without(self._start, model.defined)
        if missing != FALSE:
            return self._witnesses.missing(missing)
        invalid = walk.without(model.defined, model.valid_at_all)
        return PropertyResult("total", "proved", 2, "walk") if invalid == FALSE else self._witnesses.invalid(invalid)

    @property
    def _start(self) -> Function:
        """The starts."""
        return self._model.walk.all_of((self._model.valid_at_all, self._model.formula(self._spec.start)))

    def _safe(self) -> PropertyResult:
        if self._not_allowed == FALSE:
            return PropertyResult("safe", "proved", len(self._violations), "walk")
        return self._witnesses.not_allowed(self._not_allowed)

    def _goals(self) -> PropertyResult:
        model, walk, ranks = self._model, self._model.walk, self._ranks
        pending = self._pending(walk.without(model.decided, self._not_allowed))
        result = self._by_certificate(pending) if ranks.check_claimed(self._decreases) else None
        if result is not None:
            return result
        missed = walk.any_of(self._missing(goal, where, ranks.near(goal)) for goal, where in pending)
        if missed == FALSE:
            return PropertyResult("goals", "proved", 1 + len(pending), "walk")
        refuted = self._witnesses.goal_missed(model.first_state(missed))
        if refuted is None:
            raise RuntimeError("the run reaches its goal, against the walk")
        return refuted

    def _pending(self, states: Function) -> list[tuple[Aim, Function]]:
        """The residual goals after decisions in `states`, each with the states where it is pending.

        Without an active goal none is; in several steps, an unsafe state has to come to safety all the same.
        """
        every = self._ranks.aims(states, self._model.policy)
        if not self._spec.restores_stepwise:
            return [(goal, where) for goal, where in every if goal is None or goal.bodies]
        walk, safe = self._model.walk, self._model.safe
        parts = [(goal, where if goal is None or goal.bodies else walk.without(where, safe)) for goal, where in every]
        return [(goal, where) for goal, where in parts if where != FALSE]

    def _decreases(self, goal: Residual) -> bool:
        return self._parallel.take(("decreases", goal), partial(self._ranks.decreases, goal))

    def _by_certificate(self, pending: list[tuple[Aim, Function]]) -> PropertyResult | None:
        """The proof with the ranks that came with the policy, or a failing run; None where they do not serve.

        After a failing run the other ranks are looked at all the same: they may be wrong as well.
        """
        model, walk, ranks = self._model, self._model.walk, self._ranks
        failed, whole = None, True
        try:
            for goal, where in pending:
                if goal is None:
                    ranks.fall_short(NO_RANKS)
                    return None
                if goal not in ranks.roots:
                    ranks.lacks(goal)
                    whole = False
                    continue
                missed = self._missing(goal, where, ranks.claimed_near(goal))
                if missed == FALSE:
                    continue
                state = model.first_state(missed)
                failed, whole = failed or self._witnesses.goal_missed(state), False
                if walk.all_of((where, model.next(ranks.claimed_far(goal)))) != FALSE:
                    ranks.reject(f"its ranks of {ranks.described(goal)} exceed the bound")
                    return failed
                ranks.lacks(goal, state)
        except (BudgetError, RecursionError):
            if failed is None:
                raise
            ranks.fall_short(NOT_ALL)
        if not whole:
            return failed
        ranks.serve()
        return PropertyResult("goals", "proved", 1 + len(ranks.roots) + len(pending), "walk")

    def _missing(self, goal: Aim, where: Function, near: Function) -> Function:
        """The states of `where` from which the first step does not lead near enough."""
        after = self._residual_goals.own(goal, self._model.next(near), self._model.policy)
        return self._model.walk.without(where, after)

    def _minimal_joined(self) -> PropertyResult:
        result, use = self._parallel.take(self._minimal_key, self._minimal_apart)
        self._ranks.join(use)
        return result

    def _minimal_apart(self) -> tuple[PropertyResult, CertificateUse]:
        return minimal(self._model, self._residual_goals, self._ranks, self._witnesses), self._ranks.use

    @property
    def _minimal_key(self) -> Hashable:
        """The proof of `minimal` depends on which ranks are left."""
        return "minimal", frozenset(self._ranks.roots)
