"""Residual goals as functions for the walk (`docs/semantics.md`, sections 4 and 5)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TypeAlias

from tumato_symbolic.semantics import Residual
from tumato_symbolic.spec import active_bodies, executing_atoms
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, Function
from tumato_symbolic.verify.by_diagrams.steps import Steps

Aim: TypeAlias = Residual | None
"""What states are near to: a residual goal; None where these are many: that of which the parameters speak."""


class StepGoals:
    """The goals of a specification."""

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._spec = steps.spec
        self._walk = steps.walk

    @cached_property
    def active(self) -> dict[int, Function]:
        """Where every goal body is active; those not listed never are."""
        return active_bodies(self._spec.goals, self._steps.formula, self._steps.connectives)

    def residuals(self, region: Function, executed: Sequence[Function]) -> list[tuple[Residual, Function]]:
        """`region` by the residual goal that its states have when `executed` is the first set."""
        found = []
        for bodies, part in self._split(region, self.active):
            spec, walk = self._spec, self._walk
            mentioned = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in bodies))
            actions = sorted(spec.as_actions(mentioned))
            runs = {first: walk.any_of(executed[case] for case in spec.cases_from(first)) for first in actions}
            found += [(Residual(bodies, those), inside) for those, inside in self._split(part, runs)]
        return found

    def _split(self, region: Function, predicates: Mapping[int, Function]) -> list[tuple[frozenset[int], Function]]:
        """The parts of `region`, none empty, by which of the predicates hold."""
        walk, parts = self._walk, [(frozenset[int](), region)] if region != FALSE else []
        for number, predicate in predicates.items():
            inside = [(held | {number}, walk.all_of((part, predicate))) for held, part in parts]
            outside = [(held, walk.without(part, predicate)) for held, part in parts]
            parts = [(held, part) for held, part in inside + outside if part != FALSE]
        return parts

    @property
    def are_many(self) -> bool:
        """Whether there may be too many residual goals to look at each."""
        return bool(self._steps.active_variable)

    def own(self, goal: Aim, function: Function, executed: Sequence[Function]) -> Function:
        """A function of states and goals, for the residual goal that a state has when `executed` is the first set."""
        if goal is not None:
            return function
        model, spec, walk = self._steps, self._spec, self._walk
        meaning = {variable: self.active.get(body, FALSE) for body, variable in model.active_variable.items()}
        meaning |= {
            variable: walk.any_of(executed[case] for case in spec.cases_from(action))
            for action, variable in model.first_variable.items()
        }
        return walk.compose(function, meaning)

    def reached(self, goal: Aim) -> Function:
        """Where a residual goal is met: where safety may take several steps to restore, in safe states only."""
        if goal is None:
            holds = self._any_reached
        else:
            executed = [int(action in goal.executed) for action in range(len(self._spec.actions))]
            bodies = [self._spec.bodies[body].formula for body in sorted(goal.bodies)]
            holds = self._walk.all_of(self._steps.formula(body, executed) for body in bodies)
        return self._walk.all_of((holds, self._steps.safe)) if self._spec.restores_stepwise else holds

    @property
    def _any_reached(self) -> Function:
        """Where all bodies that are active, as the parameters say, hold."""
        model, spec, walk = self._steps, self._spec, self._walk
        first = model.first_variable
        executed = [walk.variable(first[a]) if a in first else FALSE for a in range(len(spec.actions))]
        return walk.all_of(
            walk.select(walk.variable(variable), (TRUE, model.formula(spec.bodies[body].formula, executed)))
            for body, variable in model.active_variable.items()
        )


class WalkGoals(StepGoals):
    """The goals of a specification, and where a policy reaches them."""

    def __init__(self, model: ClosedLoop) -> None:
        super().__init__(model)
        self._model = model

    def within(self, goal: Aim) -> Function:
        """From where the run of the policy satisfies `goal` in at most `L - 1` steps, none included: layer by layer."""
        walk, bound = self._walk, self._spec.max_plan_length
        found = reached = self.reached(goal)
        left = bound - 1 if bound is not None else -1
        while left:
            more = walk.any_of((reached, walk.all_of((self._model.acting, self._model.next(found)))))
            if more == found:
                break
            found, left = more, left - 1
        return found
