"""What may be executed together, and where it leads, for many states (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from math import prod

from tumato_symbolic.semantics import ActionSet, State, duration, nominal_agrees, outcomes, successor, takes_effect
from tumato_symbolic.spec import Assignment, Ordering, Spec
from tumato_symbolic.verify.by_states.packed import Code, Packing, all_hold

MOST_WAYS = 200_000
"""The most orders in which the effects of one set may interleave that are listed."""


class TooManyError(Exception):
    """More work than is allowed; the message says of what."""


class Steps:
    """The step relation of a specification under an effect ordering.

    Effects are constants, so what a set of actions can write does not depend on the state: it is listed once for every
    set, by the explicit meaning, in a state whose values are left open.
    """

    def __init__(self, spec: Spec, packing: Packing, ordering: Ordering, spend: Callable[[int], None]) -> None:
        self._spec, self._packing, self._ordering, self._spend = spec, packing, ordering, spend
        self._valid_rules = all_hold(packing, spec.assumptions)
        self._safe_rules = all_hold(packing, spec.state_rules)
        self._safe: dict[Code, bool] = {}
        self._writes: dict[ActionSet, list[tuple[int, int]]] = {}
        self._nominal: dict[ActionSet, tuple[int, int] | None] = {}
        self._applicable = [all_hold(packing, action.preconditions) for action in spec.actions]
        self._rules: dict[ActionSet, Callable[[Code], bool]] = {}
        self._apart: dict[ActionSet, bool] = {}

    def is_valid(self, code: Code) -> bool:
        """`s ∈ V`."""
        return self._valid_rules(code)

    def is_safe(self, code: Code) -> bool:
        """`s ∈ S`."""
        found = self._safe.get(code)
        if found is None:
            found = self._safe[code] = self._valid_rules(code) and self._safe_rules(code)
        return found

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
        """What the outcomes of a set write. Raises `TooManyError` where they strike in too many ways."""
        found = self._writes.get(chosen)
        if found is None:
            if self._ordering == "any" and ways(self._spec, chosen) > MOST_WAYS:
                raise TooManyError(f"{len(chosen)} actions at a time take effect in too many ways to list")
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

    def allowed(self, code: Code, chosen: ActionSet) -> bool:
        """`Ok(s, A)`."""
        after = self.after(code, chosen)
        return (
            after is not None
            and self.may_be_together(chosen)
            and all(self._applicable[action](code) for action in chosen)
            and self._rules_hold(code, chosen)
            and self.leads_to_safety(code, chosen)
            and self.is_safe(after)
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

    def leads_to_safety(self, code: Code, chosen: ActionSet) -> bool:
        """Condition 5: every outcome is safe."""
        return all(map(self.is_safe, self.outcomes(code, chosen)))

    def cheaper_sets(self, code: Code, limit: int) -> Iterator[ActionSet]:
        """The allowed sets of a smaller duration than `limit` in an unsafe state, grown action by action.

        A larger set has the duration of a smaller one, what is controlled and written there, and its outcomes: where
        one of these is at fault, a set is not grown. (Sets in which no action has effects are not allowed in an unsafe
        state; what they grow into may be.)
        """
        applicable = [number for number, test in enumerate(self._applicable) if test(code)]
        usable = [number for number in applicable if self._may_grow(code, frozenset({number}), limit)]
        waiting = [(frozenset({number}), place + 1) for place, number in enumerate(usable)]
        while waiting:
            chosen, begin = waiting.pop()
            if self.allowed(code, chosen):
                yield chosen
            larger = ((chosen | {usable[place]}, place + 1) for place in range(begin, len(usable)))
            waiting += [(grown, place) for grown, place in larger if self._may_grow(code, grown, limit)]

    def _may_grow(self, code: Code, chosen: ActionSet, limit: int) -> bool:
        return (
            duration(self._spec, chosen) < limit
            and self.may_be_together(chosen)
            and (not takes_effect(self._spec, chosen) or self.leads_to_safety(code, chosen))
        )


_OPEN = -1
"""In place of a value: it stays what it is."""


def _written(state: State) -> Assignment:
    return tuple((variable, value) for variable, value in enumerate(state) if value != _OPEN)


def ways(spec: Spec, chosen: ActionSet) -> int:
    """At most so many pairs of a state and the actions still to come are met while a set takes effect."""
    return prod(1 + len(spec.actions[number].effects) for number in chosen)
