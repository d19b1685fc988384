"""How well a policy restores safety, as functions for the walk (`docs/semantics.md`, sections 9 and 10).

An effort (duration, steps) is one number: adding numbers adds efforts, and a smaller one is a smaller effort.
"""

from __future__ import annotations

import operator
from functools import cached_property

from tumato_symbolic.policy import Restoring
from tumato_symbolic.semantics import Effort
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function

_STEPS = 48
"""Bits for a number of steps."""


class WalkEfforts:
    """`worst` and `nominal` efforts of the unsafe states where the policy acts, `never` where there are none.

    Raises `BudgetError` where the policy executes actions together that exclude each other: the walk has no name for
    such a set.
    """

    def __init__(self, model: ClosedLoop, ordering: Ordering) -> None:
        self._model, self._ordering, self._walk = model, ordering, model.walk
        longest = sum(action.duration for action in model.spec.actions) + 1
        self._never = 1 << (2 * _STEPS + longest.bit_length())
        self.never = self._walk.constant(self._never)
        self._plus = lambda one, other: min(one + other, self._never)
        walk = self._walk
        unsafe = walk.without(model.decided, model.safe)
        if walk.all_of((unsafe, model.conflict(model.policy))) != FALSE:
            raise BudgetError("some decisions in unsafe states execute actions that exclude each other")
        self.unsafe = walk.all_of((unsafe, model.acting))
        self._levels = list(zip(model.tiers, model.tiers[1:], strict=False))

    def by_level(self, region: Function) -> list[tuple[Function, Function]]:
        """The parts of a region of unsafe states, each with the states that are restored from there."""
        walk = self._walk
        parts = ((walk.all_of((region, walk.without(kept, more))), more) for kept, more in self._levels)
        return [(part, more) for part, more in parts if part != FALSE]

    def number(self, effort: Effort | None) -> int:
        """An effort as a number. Raises `BudgetError` where it is too large for that."""
        if effort is None:
            return self._never
        duration, steps = effort
        if steps >> _STEPS or (found := duration << _STEPS | steps) >= self._never:
            raise BudgetError("an effort of the certificate is too large for the walk")
        return found

    def step(self, of_policy: bool) -> Function:
        """What one step of `π(s)`, or of `A`, takes."""
        model = self._model
        takes = model.duration(model.policy if of_policy else model.chosen)
        return self._walk.apply(_as_effort, takes, takes)

    # The worst of all outcomes

    def worst_next(self, number: Function) -> Function:
        """The largest value in `Next(s, A)` of a number that is nowhere negative. Speaks of sets without conflicts."""
        walk, model, then = self._walk, self._model, number
        walk.make_room()
        if self._ordering == "any":
            before = None
            while then != before:
                before = then
                for action, chosen in enumerate(model.chosen):
                    then = walk.apply(max, then, walk.select(chosen, (FALSE, self._largest_after(action, then))))
        actions = [(action, model.chosen[action]) for action, each in enumerate(model.spec.actions) if each.effects]
        after_effect = [walk.select(chosen, (FALSE, self._largest_after(action, then))) for action, chosen in actions]
        takes_effect = walk.any_of(chosen for _, chosen in actions)
        found = walk.select(takes_effect, (number, walk.apply_all(max, [FALSE, *after_effect])))
        if self._ordering == "any":  # then all nominal effects in turn are an outcome
            return found
        return walk.apply(max, found, walk.compose(number, model.successor(model.chosen)))

    def _largest_after(self, action: int, number: Function) -> Function:
        """The largest value of `number` after an effect of `action`, which is then no longer to come."""
        walk, idle = self._walk, {self._model.group_variable(action): FALSE}
        effects = (
            {variable: walk.constant(value) for variable, value in effect} | idle
            for effect in self._model.spec.actions[action].effects
        )
        return walk.apply_all(max, [FALSE, *(walk.compose(number, effect) for effect in effects)])

    def _worst_by_policy(self, number: Function) -> Function:
        """The same in `Next(s, π(s))`."""
        walk, model = self._walk, self._model
        if self._ordering == "first":
            model_next = walk.apply(max, model.as_decided(self.worst_next(number)), model.next(number))
            return walk.select(model.acting, (FALSE, model_next))
        return model.as_decided(self.worst_next(number))

    def after_policy(self, worst: Function) -> Function:
        """`w(s)` by the decision, if `worst` is right of what comes after it."""
        walk, found = self._walk, self.never
        for part, more in self.by_level(self.unsafe):
            largest = self._worst_by_policy(walk.select(more, (self.known(worst), FALSE)))
            longer = walk.apply(self._plus, largest, self.step(of_policy=True))
            found = walk.select(part, (found, longer))
        return found

    def known(self, number: Function) -> Function:
        """`number`, where the policy acts in an unsafe state; elsewhere `never`."""
        return self._walk.select(self.unsafe, (self.never, number))

    def exact_worst(self, start: Function | None = None) -> Function:
        """`w_π`, from efforts that are large enough, or from none."""
        found, before = self.never if start is None else self.known(start), None
        while found != before:
            found, before = self.after_policy(found), found
        return found

    # Nominal runs

    def nominal_after(self, nominal: Function, more: Function) -> Function:
        """The effort along the nominal run to `more`, if `nominal` is right of what comes after the first step."""
        walk, model = self._walk, self._model
        left = walk.select(model.next(more), (model.next(self.known(nominal)), FALSE))
        longer = walk.apply(self._plus, left, self.step(of_policy=True))
        return walk.select(self.unsafe, (self.never, longer))

    @cached_property
    def nominal_by_level(self) -> dict[Function, Function]:
        """For the states that are restored from a level: the efforts along nominal runs to them."""
        found = dict[Function, Function]()
        for _, more in self._levels:
            nominal, before = self.never, None
            while nominal != before:
                nominal, before = self.nominal_after(nominal, more), nominal
            found[more] = nominal
        return found

    def exact_nominal(self) -> Function:
        """The efforts along nominal runs until a state is restored."""
        found = self.never
        for part, more in self.by_level(self.unsafe):
            found = self._walk.select(part, (found, self.nominal_by_level[more]))
        return found

    # How well sets restore

    def qualities(self, worst: Function, nominal: Function | None) -> Function:
        """How well the policy restores each state, as `rivals` says it of sets; `nominal` counts under `fair` alone."""
        walk, found = self._walk, self.no_quality
        for part, more in self.by_level(self.unsafe):
            largest = self._worst_by_policy(walk.select(more, (self.known(worst), FALSE)))
            found = walk.select(part, (found, self._quality(largest, worst, nominal)))
        return found

    def rival_qualities(self, region: Function, worst: Function) -> Function:
        """How well `A` restores the states of a region, whether it is allowed or not, and follows the policy then."""
        walk, model, found = self._walk, self._model, self.no_quality
        takes, successor = self.step(of_policy=False), model.successor(model.chosen)
        for part, more in self.by_level(region):
            largest = self.worst_next(walk.select(more, (self.known(worst), FALSE)))
            nominal = None
            if model.spec.restoration == "fair":
                after = walk.select(more, (self.known(self.nominal_by_level[more]), FALSE))
                nominal = walk.apply(self._plus, walk.compose(after, successor), takes)
            found = walk.select(part, (found, self._quality(largest, walk.apply(self._plus, largest, takes), nominal)))
        return found

    @cached_property
    def no_quality(self) -> Function:
        """The quality of what restores nothing."""
        return self._walk.constant(3 * self._never)

    def _quality(self, largest: Function, worst: Function, nominal: Function | None) -> Function:
        """One step before more, what is restored in any case before what is restored along nominal runs."""
        walk = self._walk
        at_once = walk.apply(operator.eq, largest, FALSE)
        several = walk.apply(operator.add, worst, self.never)
        otherwise = self.no_quality
        if nominal is not None:
            runs = walk.apply(operator.lt, nominal, self.never)
            fair = walk.apply(operator.add, nominal, walk.constant(2 * self._never))
            otherwise = walk.select(runs, (self.no_quality, fair))
        bounded = walk.apply(operator.lt, worst, self.never)
        return walk.select(at_once, (walk.select(bounded, (otherwise, several)), worst))

    # What a certificate says

    def claimed(self, restoring: Restoring) -> tuple[Function, Function]:
        """The worst and nominal efforts of a certificate, for all unsafe states; `never` where there is none."""
        walk, model = self._walk, self._model
        taken = walk.import_diagram(restoring.efforts, self.number)
        unsafe = walk.without(model.valid, model.safe)
        worst = walk.select(unsafe, (self.never, taken[restoring.worst]))
        nominal = walk.select(walk.all_of((unsafe, self.is_never(worst))), (self.never, taken[restoring.nominal]))
        return worst, nominal if model.spec.restoration == "fair" else self.never

    def is_never(self, number: Function) -> Function:
        """Where there is no effort."""
        return self._walk.apply(operator.eq, number, self.never)

    def false_efforts(self, worst: Function, nominal: Function) -> Function:
        """The states where a claimed effort does not follow from those after the decision."""
        walk, model = self._walk, self._model
        enough = walk.apply(operator.ge, worst, self.after_policy(worst))
        claimed = walk.negation(self.is_never(worst))
        wrong = walk.without(claimed, walk.all_of((self.unsafe, enough)))
        claimed = walk.negation(self.is_never(nominal))
        goes_on = walk.select(self.is_never(self.known(worst)), (FALSE, self.known(nominal)))
        for part, more in self.by_level(claimed):
            left = walk.select(model.next(more), (model.next(goes_on), FALSE))
            longer = walk.apply(self._plus, left, self.step(of_policy=True))
            right = walk.all_of((self.unsafe, walk.apply(operator.ge, nominal, longer)))
            wrong = walk.any_of((wrong, walk.without(part, right)))
        return wrong


def _as_effort(duration: int, _: int) -> int:
    return duration << _STEPS | 1
