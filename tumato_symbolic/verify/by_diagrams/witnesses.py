"""States that refute a property, found by the walk and replayed with the explicit meaning."""

from __future__ import annotations

from tumato_symbolic.semantics import (
    NOTHING,
    ActionSet,
    Objection,
    Run,
    State,
    apply,
    duration,
    fault_after,
    follow,
    is_start,
    is_valid,
    objections,
    replay,
)
from tumato_symbolic.spec import Assignment, Ordering
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.result import PropertyResult, Refutation

LISTED_ACTIONS = 8
"""Up to so many actions, all outcomes of a set are listed when a witness is replayed."""


class Witnesses:
    """The first state, as declared, in which a predicate holds, and what is wrong there.

    Raises `RuntimeError` where the explicit meaning finds nothing wrong: a bug of ours.
    """

    def __init__(self, model: ClosedLoop, decisions: Decisions, ordering: Ordering) -> None:
        self._model = model
        self._spec = model.spec
        self._decisions = decisions
        self._ordering = ordering

    def missing(self, where: Function) -> PropertyResult:
        """A valid state without a decision; with starts, a start."""
        state = self._model.first_state(where)
        if not is_start(self._spec.whole, state) or state in self._decisions:
            raise RuntimeError(f"{state} is decided, against the walk")
        return PropertyResult("total", "refuted", refutation=Refutation("missing", state))

    def invalid(self, where: Function) -> PropertyResult:
        """A decided state that is not valid."""
        state = self._model.first_state(where)
        chosen = self._decisions.stated(state)
        if is_valid(self._spec.whole, state) or chosen is None:
            raise RuntimeError(f"{state} is valid or not decided, against the walk")
        return PropertyResult("total", "refuted", refutation=Refutation("invalid", state, chosen))

    def not_allowed(self, where: Function) -> PropertyResult:
        """A decision that is not allowed."""
        state = self._model.first_state(where)
        chosen = self._decisions[state]
        objection = self._objection(state, chosen)
        return PropertyResult("safe", "refuted", refutation=Refutation("not-allowed", state, chosen, objection))

    def _objection(self, state: State, chosen: ActionSet) -> Objection:
        """The first condition that fails; a long way into an unsafe state is found by the walk, not by listing."""
        for objection in objections(self._spec, state, chosen, "first"):
            if self._ordering == "first" or objection.kind != "nominal-unsafe":
                return objection
        model = self._model
        for where, target in model.requirements:
            if model.holds(where, state, chosen) and not model.holds(model.outcomes_in(target), state, chosen):
                return self._fault(state, chosen, model.remains_in(target))
        raise RuntimeError(f"{sorted(chosen)} is allowed in {state}, against the walk")

    def _fault(self, state: State, chosen: ActionSet, fine: Function) -> Objection:
        """What is wrong after some effects, those left out that it does not take; `fine` is where nothing will be."""
        steps: list[tuple[int, Assignment]] = []
        here, waiting = state, chosen
        fault: Objection | None = None
        while fault is None:
            options = [(number, effect) for number in sorted(waiting) for effect in self._spec.actions[number].effects]
            number, effect = next(
                (number, effect)
                for number, effect in options
                if not self._model.holds(fine, apply(effect, here), waiting - {number})
            )
            steps.append((number, effect))
            here, waiting = apply(effect, here), waiting - {number}
            fault = fault_after(self._spec, state, chosen, replay(state, steps))
        for step in list(steps):
            shorter = [kept for kept in steps if kept is not step]
            found = fault_after(self._spec, state, chosen, replay(state, shorter)) if shorter else None
            if found is not None:
                steps, fault = shorter, found
        return fault

    def goal_missed(self, state: State) -> PropertyResult | None:
        """The refutation by the run from `state`; None where it reaches its goal."""
        chosen = self._decisions[state]
        run = follow(self._spec, self._decisions, state, chosen)
        if run.end == "goal":
            return None
        return PropertyResult("goals", "refuted", refutation=Refutation("goal-missed", state, chosen, run=run))

    def not_minimal(self, better: Function) -> PropertyResult:
        """A cheaper set that would do as well."""
        state = self._model.first_state(better)
        cheapest, run = self._best(better, state)
        refutation = Refutation("not-minimal", state, self._decisions[state], run=run, cheaper=cheapest)
        return PropertyResult("minimal", "refuted", refutation=refutation)

    def _best(self, better: Function, state: State) -> tuple[ActionSet, Run]:
        """The cheapest better set in a state, then the smallest, then the first, and its run."""
        model, walk, spec = self._model, self._model.walk, self._spec
        left = walk.compose(better, {variable: walk.constant(value) for variable, value in enumerate(state)})
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
