"""The properties of a policy, proved by the walk: no Z3 (`docs/certificate.md`, tier 2)."""

from __future__ import annotations

import operator
import time
from functools import cached_property
from math import prod

from tumato_symbolic.policy.convert import as_diagram
from tumato_symbolic.policy.model import Policy
from tumato_symbolic.semantics import (
    NOTHING,
    ActionSet,
    Effectuation,
    Objection,
    Outcome,
    Residual,
    Run,
    State,
    apply,
    broken_rule,
    duration,
    follow,
    is_safe,
    is_valid,
    objections,
)
from tumato_symbolic.spec import Assignment, Ordering, Spec
from tumato_symbolic.verify.by_walk.goals import WalkGoals
from tumato_symbolic.verify.by_walk.model import Model
from tumato_symbolic.verify.by_walk.ranks import WalkRanks
from tumato_symbolic.verify.by_walk.walk import FALSE, BudgetError, Function
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.result import CertificateUse, PropertyName, PropertyResult, Refutation

LISTED_ACTIONS = 8
"""Up to so many actions, all outcomes of a set are listed when a witness is replayed."""


class WalkProver:
    """Proves or refutes the properties of one policy. Every witness is replayed with the explicit meaning.

    `policy_is_safe` is whether somebody else has proved `safe`; otherwise the walk looks where it fails by itself.
    """

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, timeout: float | None = None) -> None:
        self._spec = spec
        self._policy = policy
        self._ordering = ordering
        self._timeout = timeout
        self._decisions = Decisions(spec, policy)
        self.policy_is_safe = False

    @property
    def use(self) -> CertificateUse:
        """What became of the certificate."""
        return self._ranks.use if "_ranks" in self.__dict__ else CertificateUse("unneeded")

    def prove(self, name: PropertyName) -> PropertyResult:
        """The verdict on one property; undecided where the walk takes more time or memory than it is given."""
        try:
            self._model.walk.deadline = self._deadline()
            self._model.walk.check_time()
            match name:
                case "total":
                    return self._total()
                case "safe":
                    return self._safe()
                case "goals":
                    return self._goals()
                case _:
                    return self._minimal()
        except BudgetError as over:
            return PropertyResult(name, "undecided", reason=str(over))
        except RecursionError:
            return PropertyResult(name, "undecided", reason="there are too many variables for the walk")

    def has_valid_state(self) -> bool:
        """Whether some state satisfies all assumptions, as far as the walk can tell."""
        try:
            return self._model.valid != FALSE
        except (BudgetError, RecursionError):
            return True

    def valid_states(self) -> int | None:
        """How many states are valid; None where even that is too much."""
        try:
            model = self._model
        except (BudgetError, RecursionError):
            return None
        return model.walk.count(model.valid) // prod(len(group) + 1 for group in model.groups)

    def _deadline(self) -> float | None:
        return None if self._timeout is None else time.monotonic() + self._timeout

    @cached_property
    def _model(self) -> Model:
        return Model(self._spec, as_diagram(self._policy), self._ordering, self._deadline())

    @cached_property
    def _violations(self) -> list[Function]:
        """One for every obligation of `safe`."""
        return [violation for _, violation in self._model.obligations()]

    @cached_property
    def _not_allowed(self) -> Function:
        return FALSE if self.policy_is_safe else self._model.walk.any_of(self._violations)

    @cached_property
    def _ranks(self) -> WalkRanks:
        return WalkRanks(self._model, self._residual_goals, self._policy, self._not_allowed == FALSE)

    @cached_property
    def _residual_goals(self) -> WalkGoals:
        return WalkGoals(self._model)

    def _total(self) -> PropertyResult:
        missing = self._model.walk.without(self._model.valid, self._model.decided)
        if missing == FALSE:
            return PropertyResult("total", "proved", 1, "walk")
        state = self._model.first_state(missing)
        if not is_valid(self._spec, state) or state in self._decisions:
            raise RuntimeError(f"{state} is decided, against the walk")
        return PropertyResult("total", "refuted", refutation=Refutation("missing", state))

    def _safe(self) -> PropertyResult:
        if self._not_allowed == FALSE:
            return PropertyResult("safe", "proved", len(self._violations), "walk")
        state = self._model.first_state(self._not_allowed)
        chosen = self._decisions[state]
        objection = self._objection(state, chosen)
        return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))

    def _objection(self, state: State, chosen: ActionSet) -> Objection:
        """The first condition that fails; a long way into an unsafe state is found by the walk, not by listing."""
        for objection in objections(self._spec, state, chosen, "first"):
            if self._ordering == "first" or objection.kind != "nominal-unsafe":
                return objection
        way = self._unsafe_way(state, chosen)
        end = way[-1].after
        return Objection("unsafe", tuple(sorted(chosen)), broken_rule(self._spec, end), way, end)

    def _unsafe_way(self, state: State, chosen: ActionSet) -> Outcome:
        """Effects that lead into an unsafe state, those left out that it does not take."""
        steps: list[tuple[int, Assignment]] = []
        here, waiting = state, chosen
        while not steps or is_safe(self._spec, here):
            options = [(number, effect) for number in sorted(waiting) for effect in self._spec.actions[number].effects]
            number, effect = next(
                (number, effect)
                for number, effect in options
                if not self._model.holds(self._model.safe_from_here, apply(effect, here), waiting - {number})
            )
            steps.append((number, effect))
            here, waiting = apply(effect, here), waiting - {number}
        for step in list(steps):
            shorter = [kept for kept in steps if kept is not step]
            if shorter and not is_safe(self._spec, _replayed(state, shorter)[-1].after):
                steps = shorter
        return _replayed(state, steps)

    def _goals(self) -> PropertyResult:
        model, walk, ranks = self._model, self._model.walk, self._ranks
        owing = walk.without(model.decided, self._not_allowed)
        owed = [(goal, where) for goal, where in self._residual_goals.residuals(owing, model.policy) if goal.bodies]
        result = self._by_certificate(owed) if ranks.check_given() else None
        if result is not None:
            return result
        missed = walk.any_of(self._missing(where, ranks.near(goal)) for goal, where in owed)
        if missed == FALSE:
            return PropertyResult("goals", "proved", 1 + len(owed), "walk")
        refuted = self._goal_missed(model.first_state(missed))
        if refuted is None:
            raise RuntimeError("the run reaches its goal, against the walk")
        return refuted

    def _by_certificate(self, owed: list[tuple[Residual, Function]]) -> PropertyResult | None:
        """The proof with the ranks that came with the policy, or a failing run; None where they do not serve."""
        model, walk, ranks = self._model, self._model.walk, self._ranks
        whole = True
        for goal, where in owed:
            missed = self._missing(where, ranks.given_near(goal)) if goal in ranks.roots else where
            if missed == FALSE:
                continue
            whole, state = False, model.first_state(missed)
            if goal not in ranks.roots:
                ranks.lacks(goal)
            elif (refuted := self._goal_missed(state)) is not None:
                ranks.serve()
                return refuted
            elif walk.all_of((where, model.next(ranks.given_far(goal)))) != FALSE:
                ranks.reject(f"its ranks of {ranks.described(goal)} exceed the bound")
                return None
            else:
                ranks.lacks(goal, state)
        if not whole:
            return None
        ranks.serve()
        return PropertyResult("goals", "proved", 1 + len(ranks.roots) + len(owed), "walk")

    def _missing(self, where: Function, near: Function) -> Function:
        """The states of `where` from which the first step does not lead near enough."""
        return self._model.walk.without(where, self._model.next(near))

    def _goal_missed(self, state: State) -> PropertyResult | None:
        """The refutation by the run from `state`; None where it reaches its goal."""
        chosen = self._decisions[state]
        run = follow(self._spec, self._decisions, state, chosen)
        if run.end == "goal":
            return None
        return PropertyResult("goals", "refuted", refutation=Refutation("goal-missed", state, chosen, run=run))

    def _minimal(self) -> PropertyResult:
        model, walk = self._model, self._model.walk
        unsafe = walk.without(model.decided, model.safe)
        takes = walk.select(unsafe, (FALSE, model.duration(model.policy)))  # nothing is shorter than 0
        cheaper = walk.combine(operator.lt, model.duration(model.chosen), takes)
        if cheaper != FALSE:
            cheaper = walk.all_of((cheaper, model.allowed))
        owed = self._residual_goals.residuals(cheaper, model.chosen)
        step = model.successor(model.chosen)
        better = FALSE
        for goal, where in owed:
            near = self._ranks.near_at_least(goal)
            serves = walk.all_of((where, walk.substitute(near, step)))
            if serves != FALSE and near != self._ranks.near(goal):
                at_least, serves = serves, walk.all_of((where, walk.substitute(self._ranks.near(goal), step)))
                if serves != at_least:
                    self._ranks.inexact(goal)
            better = walk.any_of((better, serves))
        if better == FALSE:
            return PropertyResult("minimal", "proved", 1 + len(owed), "walk")
        state = model.first_state(better)
        cheapest, run = self._best(better, state)
        refutation = Refutation("not-minimal", state, self._decisions[state], run=run, cheaper=cheapest)
        return PropertyResult("minimal", "refuted", refutation=refutation)

    def _best(self, better: Function, state: State) -> tuple[ActionSet, Run]:
        """The cheapest better set in a state, then the smallest, then the first, and its run."""
        model, walk, spec = self._model, self._model.walk, self._spec
        left = walk.substitute(better, {variable: walk.constant(value) for variable, value in enumerate(state)})
        for measure in (model.duration(model.chosen), model.size(model.chosen)):
            left = model.least(left, measure)
        chosen = NOTHING
        for action, executed in enumerate(model.chosen):
            with_it = walk.all_of((left, executed))
            if with_it != FALSE:
                left, chosen = with_it, chosen | {action}
        run = follow(spec, self._decisions, state, chosen)
        shorter = duration(spec, chosen) < duration(spec, self._decisions[state])
        if not shorter or run.end != "goal" or not self._replays(state, chosen):
            raise RuntimeError(f"{sorted(chosen)} is not better in {state}, against the walk")
        return chosen, run

    def _replays(self, state: State, chosen: ActionSet) -> bool:
        """Whether a set is allowed by the explicit meaning; of many actions, only their first effects are listed."""
        ordering = self._ordering if len(chosen) <= LISTED_ACTIONS else "first"
        return next(objections(self._spec, state, chosen, ordering), None) is None


def _replayed(state: State, steps: list[tuple[int, Assignment]]) -> Outcome:
    """The states met when effects strike in this order."""
    way = []
    for number, effect in steps:
        state = apply(effect, state)
        way.append(Effectuation(number, effect, state))
    return tuple(way)
