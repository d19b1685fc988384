"""A policy and the steps that it takes, as functions that the walk can compare (`docs/semantics.md`, section 5)."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import contested_values
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.by_diagrams.steps import Steps

MOST_CASES = 128
"""So many different things that several groups of actions nominally write are looked at apart."""


class _Case(NamedTuple):
    """Acting states in which the policy nominally writes the same constants.

    `changed` has the next values of other variables there, where these depend on the state.
    """

    where: Function
    writes: Mapping[int, int]
    changed: Mapping[int, Function]


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
        self._next: dict[Function, Function] = {}

    @cached_property
    def acting(self) -> Function:
        """`s` is decided, and the nominal effects of `π(s)` agree."""
        return self.walk.without(self.decided, self.together(contested_values(self.spec), self.policy))

    def leads_into(self, target: Function) -> Function:
        """`Next(s, π(s)) ⊆ target`, where the policy acts without conflicts."""
        if self._ordering == "any":  # then all nominal effects in turn are an outcome
            return self.walk.all_of((self.acting, self.as_decided(self._outcomes_in(target, self.stays_in(target)))))
        outcomes = self.as_decided(self._outcomes_in(target, target))
        return self.walk.all_of((self.acting, outcomes, self.next(target)))

    @cached_property
    def _cases(self) -> list[_Case]:
        """The acting states by what the policy nominally writes there.

        By the largest group of actions, and by others while there are few cases.
        """
        walk, number = self.walk, FALSE
        pairs = sorted({pair for action in self.spec.actions for pair in action.nominal})
        bit = {pair: 1 << place for place, pair in enumerate(pairs)}
        first, *groups = sorted(self.groups, key=len, reverse=True) or [()]
        number = together = self._written(first, bit)
        for group in groups:
            together = walk.apply(operator.or_, together, self._written(group, bit))
            if len(walk.values_of(together)) > MOST_CASES:
                break
        else:
            number, groups = together, []
        others = [action for group in groups for action in group]
        cases = walk.parts(walk.select(self.acting, (walk.constant(-1), number)))
        return [
            self._case(where, dict(pair for pair in pairs if mask & bit[pair]), others)
            for mask, where in cases.items()
            if mask >= 0
        ]

    def _written(self, group: Sequence[int], bit: Mapping[tuple[int, int], int]) -> Function:
        """What the actions of a group nominally write where the policy acts, a bit for every variable and value."""
        walk, masks = self.walk, [sum(bit[pair] for pair in self.spec.actions[action].nominal) for action in group]
        where = (walk.all_of((self.acting, self.policy[action])) for action in group)
        parts = [walk.select(each, (FALSE, walk.constant(mask))) for each, mask in zip(where, masks, strict=True)]
        return walk.apply_all(operator.or_, [FALSE, *parts])

    def _case(self, where: Function, writes: dict[int, int], others: Sequence[int]) -> _Case:
        """Some acting states in which these constants are written, and whatever `others` write there."""
        walk, changed = self.walk, dict[int, Function]()
        for action in others:
            executed = walk.all_of((where, self.policy[action]))
            for variable, value in self.spec.actions[action].nominal if executed != FALSE else ():
                if variable not in writes:
                    stays = changed.get(variable, walk.variable(variable))
                    changed[variable] = walk.select(walk.within(where, executed), (stays, walk.constant(value)))
        return _Case(where, writes, changed)

    def next(self, function: Function) -> Function:
        """`function` in `δ(s, π(s))` where the policy acts; elsewhere it means nothing."""
        if function not in self._next:
            self._next[function] = self._after_step(function)
        return self._next[function]

    def _after_step(self, function: Function) -> Function:
        found = FALSE
        for case in self._cases:
            if case.changed:
                constants = {variable: self.walk.constant(value) for variable, value in case.writes.items()}
                after = self.walk.compose(function, {**case.changed, **constants})
                found = self.walk.select(case.where, (found, after))
            else:
                found = self.walk.cofactor_where(case.where, case.writes, function, found)
        return found

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
