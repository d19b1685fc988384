"""The truth about small specifications, state by state and policy by policy (`docs/semantics.md`, sections 9, 10)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import product
from math import prod

from msgspec import Struct

from tumato_symbolic.semantics import (
    ActionSet,
    Residual,
    State,
    all_states,
    allowed_sets,
    is_safe,
    is_valid,
    next_states,
    reached,
    residual_goal,
    restored,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec


class Option(Struct, frozen=True):
    """One set of actions that may be executed in a state, and all that follows from it."""

    chosen: ActionSet
    after: State
    goal: Residual
    following: frozenset[State]


class World:
    """All options of all valid states."""

    def __init__(self, spec: Spec, ordering: Ordering) -> None:
        self.spec = spec
        self.ordering: Ordering = ordering
        self.valid = [state for state in all_states(spec) if is_valid(spec, state)]
        self.safe = {state for state in self.valid if is_safe(spec, state)}
        self.options = {
            state: [self._option(state, a) for a in allowed_sets(spec, state, ordering)] for state in self.valid
        }

    def _option(self, state: State, chosen: ActionSet) -> Option:
        following = frozenset(next_states(self.spec, state, chosen, self.ordering))
        after = successor(self.spec, state, chosen)
        return Option(chosen, after, residual_goal(self.spec, state, chosen), following)

    @cached_property
    def restorable(self) -> frozenset[State]:
        """`R`: the unsafe states that can be restored, each to a higher level."""
        found: set[State] = set()
        while True:
            more = {
                state for state in self.valid if state not in self.safe | found and self._restored_into(state, found)
            }
            if not more:
                return frozenset(found)
            found |= more

    def _restored_into(self, state: State, found: set[State]) -> bool:
        def leads(option: Option) -> bool:
            wanted = {option.after} if self.spec.restoration == "fair" else option.following
            return all(restored(self.spec, state, each) or each in found for each in wanted)

        return any(map(leads, self.options[state]))

    def kind(self, state: State) -> str | None:
        """Why a state fails, taken alone; None where it does not."""
        if not self.options[state] and (state in self.safe or self.spec.restoration == "one_step"):
            return "no-allowed-set"
        if state not in self.safe and self.spec.restoration != "one_step" and state not in self.restorable:
            return "no-restoration"
        return None if any(self._has_run(option) for option in self._steps(state)) else "no-plan"

    def _steps(self, state: State) -> Iterator[Option]:
        """The steps that a run of one state may take."""
        for option in self.options[state]:
            if (
                state in self.safe
                or self.spec.restoration != "bounded"
                or (
                    state not in option.following
                    and all(each in self.restorable or restored(self.spec, state, each) for each in option.following)
                )
            ):
                yield option

    def _has_run(self, first: Option) -> bool:
        layer, seen, steps = {first.after}, {first.after}, 1
        while layer and (self.spec.max_plan_length is None or steps <= self.spec.max_plan_length):
            if any(reached(self.spec, first.goal, state) for state in layer):
                return True
            layer = {option.after for state in layer for option in self._steps(state)} - seen
            seen |= layer
            steps += 1
        return False

    @property
    def policies(self) -> int:
        """How many policies there are with `Keep` everywhere."""
        return prod(map(len, self.options.values()))

    def serving(self) -> Iterator[Mapping[State, ActionSet]]:
        """Every sound and complete policy, by trying all."""
        for policy in self.policies_with_options():
            if self.serves(policy):
                yield {state: option.chosen for state, option in policy.items()}

    def has_policy(self) -> bool:
        """Whether some policy is sound and complete, by trying all; of sets from which the same follows, one."""
        different = ({(o.after, o.goal, o.following): o for o in options}.values() for options in self.options.values())
        return any(self.serves(dict(zip(self.options, each, strict=True))) for each in product(*different))

    def policies_with_options(self) -> Iterator[Mapping[State, Option]]:
        """Every policy with `Keep` everywhere."""
        return (dict(zip(self.options, each, strict=True)) for each in product(*self.options.values()))

    def serves(self, policy: Mapping[State, Option]) -> bool:
        """Whether decisions with `Keep` everywhere are sound and complete."""
        return all(self.meets(policy, state) for state in policy) and self.restores(policy)

    def meets(self, policy: Mapping[State, Option], state: State) -> bool:
        """Whether the run from a state meets its goal."""
        goal, here = policy[state].goal, state
        limit = self.spec.max_plan_length or len(policy) + 1
        for _ in range(min(limit, len(policy) + 1)):
            here = policy[here].after
            if reached(self.spec, goal, here):
                return True
        return False

    def restores(self, policy: Mapping[State, Option]) -> bool:
        """Whether every unsafe state is restored."""
        found: set[State] = set()
        unsafe = [state for state in policy if state not in self.safe]
        while True:
            more = set()
            for state in unsafe:
                wanted = {policy[state].after} if self.spec.restoration == "fair" else policy[state].following
                if state not in found and all(restored(self.spec, state, t) or t in found for t in wanted):
                    more.add(state)
            if not more:
                return len(found) == len(unsafe)
            found |= more
