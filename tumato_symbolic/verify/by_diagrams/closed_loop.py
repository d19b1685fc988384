"""A policy and the steps that it takes, as functions that the walk can compare (`docs/semantics.md`, section 5)."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property

from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import contested_values
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.cases import Case, Cases
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, Function
from tumato_symbolic.verify.by_diagrams.steps import Steps


class ClosedLoop(Steps):
    """A policy in its specification: `policy[a]` is `a ∈ π(s)`.

    `defined`, `decided` and `acting` are as in `docs/certificate.md`.
    """

    def __init__(
        self, spec: Spec, decisions: DecisionDiagram, ordering: Ordering, deadline: float | None = None
    ) -> None:
        super().__init__(spec, ordering, decisions.diagram.order, deadline)
        taken = self.walk.import_diagram(decisions.diagram, int)
        self.policy = [taken[root] for root in decisions.roots]
        self.defined = taken[decisions.defined]
        self.decided = self.walk.all_of((self.valid, self.defined))
        self._nodes = len(decisions.diagram.nodes)
        self._next: dict[Function, Function] = {}

    @cached_property
    def acting(self) -> Function:
        """`s` is decided, and the nominal effects of `π(s)` agree."""
        return self.walk.without(self.decided, self.together(contested_values(self.spec), self.policy))

    def leads_into(self, target: Function) -> Function:
        """`Next(s, π(s)) ⊆ target`, where the policy acts without conflicts."""
        then = self.stays_in(target) if self._ordering == "any" else target
        ends = [self.acting, self.as_decided(self._outcomes_in(target, then))]
        if self._ordering == "first":  # else all nominal effects in turn are an outcome
            ends.append(self.next(target))
        return self.walk.all_of(ends)

    @cached_property
    def cases(self) -> list[Case]:
        """The acting states by what the policy nominally writes there: the largest groups of actions first."""
        groups = [self._executed(group) for group in sorted(self.groups, key=len, reverse=True)]
        return Cases(self.spec, self.walk, self.acting, groups).apart(self._nodes)

    def _executed(self, group: Sequence[int]) -> dict[int, Function]:
        """Where the policy acts by which actions of a group that nominally write something."""
        writing = (action for action in group if self.spec.actions[action].nominal)
        each = ((action, self.walk.all_of((self.acting, self.policy[action]))) for action in writing)
        return {action: where for action, where in each if where != FALSE}

    def next(self, function: Function) -> Function:
        """`function` in `δ(s, π(s))` where the policy acts; elsewhere it means nothing."""
        if function not in self._next:
            self._next[function] = self._after_step(function)
        return self._next[function]

    def _after_step(self, function: Function) -> Function:
        if function in (FALSE, TRUE):
            return function
        found = FALSE
        for case in self.cases:
            if case.changed:
                found = self.walk.select(case.where, (found, self._after(case, function)))
            else:
                found = self.walk.cofactor_where(case.where, case.writes, function, found)
        return found

    def _after(self, case: Case, function: Function) -> Function:
        """`function` in `δ(s, π(s))` in the states of a case, where what is written depends on the state."""
        constants = {variable: self.walk.constant(value) for variable, value in case.writes.items()}
        return self.walk.compose(function, {**case.changed, **constants})

    def steps_hold(self, relation: Callable[[int, int], bool], after: Function, here: Function) -> bool:
        """Whether `relation` is true of `after(δ(s, π(s)))` and `here(s)` wherever the policy acts.

        Nothing is asked where `here` is `UNASKED`. Case by case: what is after all steps at once may be far larger than
        what is after one of them.
        """
        for case in self.cases:
            writes, function = ({}, self._after(case, after)) if case.changed else (case.writes, after)
            if not self.walk.holds_where(case.where, writes, relation, function, here):
                return False
        return True

    def obligations(self) -> Iterator[tuple[str, Function]]:
        """What makes a decision allowed: claims, each with the decided states that violate it."""
        spec, walk, policy = self.spec, self.walk, self.policy
        for number, action in enumerate(spec.actions):
            if action.conditions:
                executed, hold = walk.all_of((self.decided, policy[number])), self.all_hold(action.conditions)
                yield f"the preconditions of {action.name} hold", walk.without(executed, hold)
        conflict = walk.all_of((self.decided, self.conflict(policy)))
        yield "resources are controlled once, and nominal effects agree", conflict
        for rule in spec.reaction_rules:
            yield (
                f"the reaction rule '{rule.text}' holds",
                walk.without(self.decided, self.formula(rule.formula, policy)),
            )
        apart = walk.without(self.decided, conflict)
        if spec.restores_stepwise:
            for where, target in self.requirements:
                ends = [self.as_decided(self.outcomes_in(target))]
                ends += [self.next(target)] if self._ordering == "first" else []
                yield "the rules that have to be kept are", walk.without(walk.all_of((apart, where)), walk.all_of(ends))
            return
        yield "every outcome is safe", walk.without(apart, self.as_decided(self.outcomes_safe))
        if self._ordering == "first":
            yield "δ is safe", walk.without(apart, self.next(self.safe))

    def as_decided(self, function: Function) -> Function:
        """`function` of `(s, π(s))`, where no two actions of `π(s)` are in conflict."""
        walk, policy = self.walk, self.policy
        for group, actions in enumerate(self.groups):
            variable = len(self.spec.variables) + group
            found = walk.compose(function, {variable: FALSE})
            for place, member in enumerate(actions, 1):
                found = walk.cofactor_where(policy[member], {variable: place}, function, found)
            function = found
        return function

    def duration(self, executed: Sequence[Function]) -> Function:
        """The sum of the durations of the executed actions."""
        amounts = [self.walk.constant(action.duration) for action in self.spec.actions]
        each = zip(executed, amounts, strict=True)
        return self._total([self.walk.select(predicate, (FALSE, amount)) for predicate, amount in each])

    def size(self, executed: Sequence[Function]) -> Function:
        """The number of executed actions."""
        return self._total(executed)

    def _total(self, numbers: Sequence[Function]) -> Function:
        return self.walk.apply_all(operator.add, [FALSE, *numbers])

    def least(self, where: Function, measure: Function) -> Function:
        """That part of `where`, which is not empty, in which `measure` is smallest."""
        walk = self.walk
        elsewhere = walk.constant(walk.values_of(measure)[-1] + 1)
        smallest = walk.values_of(walk.select(where, (elsewhere, measure)))[0]
        return walk.all_of((where, walk.apply(operator.eq, measure, walk.constant(smallest))))
