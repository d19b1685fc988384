"""Nominal runs of a policy (`docs/semantics.md`, section 5)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics.goals import reached, residual_goal
from tumato_symbolic.semantics.states import ActionSet, State
from tumato_symbolic.semantics.step import nominal_agrees, successor
from tumato_symbolic.spec import Spec

End: TypeAlias = Literal["goal", "bound", "loop", "undefined"]
"""How an execution ends: in the goal, at a bound, in a loop (the last state was met before), or without a decision."""


class Run(Struct, frozen=True):
    """The nominal run from `states[0]`, as far as it matters.

    `end` tells how it ended; the bound is that of plans. `decisions` has one entry for every step taken.
    """

    states: tuple[State, ...]
    decisions: tuple[ActionSet, ...]
    end: End

    @property
    def steps(self) -> int:
        """How many steps the run has."""
        return len(self.decisions)


def follow(spec: Spec, policy: Mapping[State, ActionSet], start: State, first: ActionSet) -> Run:
    """Execute `first` in `start`, then the policy, until the residual goal of the first step is reached or cannot be.

    The first step may differ from what the policy says of `start`; a loop is one of the later states.
    """
    goal = residual_goal(spec, start, first)
    states, decisions = [start], [first]
    met: set[State] = set()
    while True:
        here = successor(spec, states[-1], decisions[-1])
        states.append(here)
        if reached(spec, goal, here):
            return Run(tuple(states), tuple(decisions), "goal")
        if len(decisions) == spec.max_plan_length:
            return Run(tuple(states), tuple(decisions), "bound")
        if here in met:
            return Run(tuple(states), tuple(decisions), "loop")
        chosen = policy.get(here)
        if chosen is None or not nominal_agrees(spec, chosen):
            return Run(tuple(states), tuple(decisions), "undefined")
        met.add(here)
        decisions.append(chosen)
