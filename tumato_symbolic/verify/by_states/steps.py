"""What may be executed together, and where it leads, for many states (`docs/semantics.md`, sections 3, 9 and 10)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations
from math import prod

from tumato_symbolic.semantics import (
    ActionSet,
    State,
    duration,
    nominal_agrees,
    outcomes,
    pending,
    successor,
    takes_effect,
)
from tumato_symbolic.spec import Assignment, Ordering, Spec
from tumato_symbolic.verify.by_states.packed import Code, Packing, Remembered, all_hold

MOST_WAYS = 200_000
"""The most orders in which the effects of one set may interleave that are listed."""


class TooManyError(Exception):
    """More work than is allowed; the message says of what."""


class Steps:
    """The step relation of a specification under an effect ordering.

    Effects are constants, so what a set of actions can write does not depend on the state: it is listed once for every
    set, by the explicit meaning, in a state whose values are left open. Where only a part of the states is looked at,
    `in_part` may tell which, sooner than its formula does.
    """

    def __init__(
        self,
        spec: Spec,
        packing: Packing,
        ordering: Ordering,
        spend: Callable[[int], None],
        in_part: Callable[[Code], bool] | None = None,
    ) -> None:
        self._spec, self._packing, self._ordering, self._spend = spec, packing, ordering, spend
        self._in_part = in_part
        self._valid_rules = all_hold(packing, spec.validity if in_part is None else spec.assumptions)
        self._safe_rules = all_hold(packing, spec.state_rules)
        self._valid: dict[Code, bool] = {}
        self._safe: dict[Code, bool] = {}
        self._rule_tests = [Remembered(packing, rule.formula) for rule in spec.state_rules]
        tiers = spec.tiers
        self._tiers = [sum(1 << n for n, rule in enumerate(spec.state_rules) if rule in tier) for tier in tiers]
        self._broken: dict[Code, int] = {}
        self._writes: dict[ActionSet, list[tuple[int, int]]] = {}
        self._pending: dict[ActionSet, list[tuple[int, int, ActionSet]]] = {}
        self._nominal: dict[ActionSet, tuple[int, int] | None] = {}
        self._applicable = [all_hold(packing, action.conditions) for action in spec.actions]
        self._lasting = [all_hold(packing, spec.actions[cases[0]].preconditions) for cases in spec.cases for _ in cases]
        self._rules: dict[ActionSet, Callable[[Code], bool]] = {}
        self._apart: dict[ActionSet, bool] = {}

    def is_valid(self, code: Code) -> bool:
        """`s ∈ V`."""
        found = self._valid.get(code)
        if found is None:
            in_part = self._in_part is None or self._in_part(code)
            found = self._valid[code] = in_part and self._valid_rules(code)
        return found

    def is_safe(self, code: Code) -> bool:
        """`s ∈ S`."""
        found = self._safe.get(code)
        if found is None:
            found = self._safe[code] = self.is_valid(code) and self._safe_rules(code)
        return found

    def level(self, code: Code) -> int:
        """How many tiers of state rules a valid state satisfies whole."""
        broken = self._broken_rules(code)
        return next((n for n, tier in enumerate(self._tiers) if broken & tier), len(self._tiers))

    def restored(self, code: Code, after: Code) -> bool:
        """Whether `after` satisfies a tier of state rules more than an unsafe state does."""
        return self.is_valid(after) and self.level(after) > self.level(code)

    def _broken_rules(self, code: Code) -> int:
        """The state rules that a state breaks, a bit for each."""
        found = self._broken.get(code)
        if found is None:
            found = sum(1 << number for number, test in enumerate(self._rule_tests) if not test(code))
            self._broken[code] = found
        return found

    def _required(self, code: Code) -> int:
        """The state rules that every state after `code` has to satisfy, a bit for each."""
        level = self.level(code)
        required = sum(self._tiers[: level + 1])
        return required if self._spec.restoration == "one_step" else required & ~self._broken_rules(code)

    def keeps(self, code: Code, reached: Iterable[Code]) -> bool:
        """Whether a step from `code` may lead to all of these states: none breaks what has to hold after it."""
        if not self._spec.restores_stepwise or self.is_safe(code):
            return all(map(self.is_safe, reached))
        required = self._required(code)
        return all(self.is_valid(each) and not self._broken_rules(each) & required for each in reached)

    def after(self, code: Code, chosen: ActionSet) -> Code | None:
        """`δ(s, A)`; None where the nominal effects disagree."""
        writes = self.nominal(chosen)
        return None if writes is None else code & writes[0] | writes[1]

    def nominal(self, chosen: ActionSet) -> tuple[int, int] | None:
        """What all nominal effects together write; None where they disagree."""
        if chosen not in self._nominal:
            agreed = nominal_agrees(self._spec, chosen)
            open_state = (_OPEN,) * len(self._spec.variables)
            written = _written(successor(self._spec, open_state, chosen))
            self._nominal[chosen] = self._packing.writes(written) if agreed else None
        return self._nominal[chosen]

    def writes(self, chosen: ActionSet) -> list[tuple[int, int]]:
        """What the outcomes of a set write. Raises `TooManyError` where they can interleave in too many ways."""
        found = self._writes.get(chosen)
        if found is None:
            if self._ordering == "any" and ways(self._spec, chosen) > MOST_WAYS:
                raise TooManyError(f"{len(chosen)} actions at a time can interleave in too many ways to list")
            open_state = (_OPEN,) * len(self._spec.variables)
            reached = outcomes(self._spec, open_state, chosen, self._ordering)
            found = self._writes[chosen] = [self._packing.writes(_written(state)) for state in reached]
            self._spend(len(found))
        return found

    def outcomes(self, code: Code, chosen: ActionSet) -> list[Code]:
        """`Out(s, A)`, possibly with repetitions."""
        writes = self.writes(chosen)
        self._spend(len(writes))
        return [code & keep | put for keep, put in writes]

    def next_states(self, code: Code, chosen: ActionSet) -> list[Code]:
        """`Next(s, A)`, possibly with repetitions; nominal effects must agree."""
        after = self.after(code, chosen)
        return self.outcomes(code, chosen) if after is None else [after, *self.outcomes(code, chosen)]

    def allowed(self, code: Code, chosen: ActionSet) -> bool:
        """`Ok(s, A)`; where safety may be restored in several steps, `Keep(s, A)`."""
        after = self.after(code, chosen)
        return (
            after is not None
            and self.may_be_together(chosen)
            and all(self._applicable[action](code) for action in chosen)
            and self._rules_hold(code, chosen)
            and self.keeps(code, self.outcomes(code, chosen))
            and self.preconditions_last(code, chosen)
            and self.keeps(code, (after,))
        )

    def may_be_together(self, chosen: ActionSet) -> bool:
        """Conditions 2 and 3: no resource is controlled twice, and the nominal effects agree."""
        found = self._apart.get(chosen)
        if found is None:
            actions = [self._spec.actions[number] for number in chosen]
            shared = any(one.resources & other.resources for one, other in combinations(actions, 2))
            found = self._apart[chosen] = not shared and nominal_agrees(self._spec, chosen)
        return found

    def _rules_hold(self, code: Code, chosen: ActionSet) -> bool:
        """Condition 4."""
        rules = self._rules.get(chosen)
        if rules is None:
            rules = self._rules[chosen] = all_hold(self._packing, self._spec.reaction_rules, chosen)
        return rules(code)

    def preconditions_last(self, code: Code, chosen: ActionSet) -> bool:
        """Whether preconditions that have to hold throughout do, of the actions that have not taken effect."""
        if self._spec.preconditions == "at_start":
            return True
        found = self._pending.get(chosen)
        if found is None:
            self.writes(chosen)
            open_state = (_OPEN,) * len(self._spec.variables)
            ways = pending(self._spec, open_state, chosen, self._ordering)
            found = self._pending[chosen] = [(*self._packing.writes(_written(here)), rest) for here, rest in ways]
        self._spend(len(found))
        return all(self._lasting[action](code & keep | put) for keep, put, rest in found for action in rest)

    def cheaper_sets(self, code: Code, limit: int) -> Iterator[ActionSet]:
        """The allowed sets of a smaller duration than `limit` in an unsafe state.

        A larger set has the duration of a smaller one. (The empty set does not restore safety.)
        """
        return self.allowed_sets(code, lambda chosen: duration(self._spec, chosen) < limit)

    def allowed_sets(self, code: Code, may_grow: Callable[[ActionSet], bool]) -> Iterator[ActionSet]:
        """The allowed sets in an unsafe state, but for the empty one, which restores nothing; grown action by action.

        A larger set has what is controlled and written in a smaller one, and its outcomes, if that takes effect at all:
        where one of these is at fault, or `may_grow` says no, a set is not grown.
        """
        applicable = [number for number, test in enumerate(self._applicable) if test(code)]
        usable = [number for number in applicable if self._may_grow(code, frozenset({number}), may_grow)]
        waiting = [(frozenset({number}), place + 1) for place, number in enumerate(usable)]
        while waiting:
            chosen, begin = waiting.pop()
            if self.allowed(code, chosen):
                yield chosen
            larger = ((chosen | {usable[place]}, place + 1) for place in range(begin, len(usable)))
            waiting += [(grown, place) for grown, place in larger if self._may_grow(code, grown, may_grow)]

    def _may_grow(self, code: Code, chosen: ActionSet, may_grow: Callable[[ActionSet], bool]) -> bool:
        return (
            self.may_be_together(chosen)
            and may_grow(chosen)
            and (not takes_effect(self._spec, chosen) or self.keeps(code, self.outcomes(code, chosen)))
            and self.preconditions_last(code, chosen)
        )


_OPEN = -1
"""In place of a value: it stays what it is."""


def _written(state: State) -> Assignment:
    return tuple((variable, value) for variable, value in enumerate(state) if value != _OPEN)


def ways(spec: Spec, chosen: ActionSet) -> int:
    """At most so many pairs of a state and the actions still to come are met while a set takes effect."""
    return prod(1 + len(spec.actions[number].effects) for number in chosen)
