"""A policy and the steps that it takes, as functions that the walk can compare (`docs/semantics.md`, section 5)."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Sequence
from functools import cached_property

from tumato_symbolic.policy import DecisionDiagram
from tumato_symbolic.semantics import contested_values
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.by_diagrams.steps import Steps

MOST_CASES = 128
"""Where the policy nominally writes at most so many different things, each is looked at apart."""


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
    def _steps(self) -> list[tuple[Function, dict[int, int]]] | None:
        """The acting states by what the policy nominally writes there; None where that is too many cases."""
        walk, actions = self.walk, self.spec.actions
        pairs = sorted({pair for action in actions for pair in action.nominal})
        masks = [sum(1 << pairs.index(pair) for pair in action.nominal) for action in actions]
        each = zip(self.policy, masks, strict=True)
        written = [
            FALSE,
            *(
                walk.select(walk.all_of((self.acting, executed)), (FALSE, walk.constant(mask)))
                for executed, mask in each
            ),
        ]
        while len(written) > 1:
            halves = zip(written[::2], written[1::2], strict=False)
            written = [walk.apply(operator.or_, *both) for both in halves] + written[len(written) & ~1 :]
            if any(len(walk.values_of(each)) > MOST_CASES for each in written):
                return None
        cases = walk.parts(walk.select(self.acting, (walk.constant(-1), *written)))
        return [
            (where, dict(pair for place, pair in enumerate(pairs) if mask >> place & 1))
            for mask, where in cases.items()
            if mask >= 0
        ]

    def next(self, function: Function) -> Function:
        """`function` in `δ(s, π(s))` where the policy acts; elsewhere it means nothing."""
        if function not in self._next:
            self._next[function] = self._after_step(function)
        return self._next[function]

    def _after_step(self, function: Function) -> Function:
        if self._steps is None:
            return self.walk.compose(function, self.successor(self.policy))
        found = FALSE
        for where, writes in self._steps:
            found = self.walk.cofactor_where(where, writes, function, found)
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
