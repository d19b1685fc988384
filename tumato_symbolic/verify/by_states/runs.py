"""How long the runs of a policy are (`docs/semantics.md`, sections 4 and 5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tumato_symbolic.semantics import ActionSet, ActiveGoals, Residual, residual_goal
from tumato_symbolic.spec import ConditionalGoal, Spec, subgoals, variables_of
from tumato_symbolic.verify.by_states.packed import Code, Packing, all_hold
from tumato_symbolic.verify.by_states.steps import Steps


class Runs:
    """The runs of the policy that decides `decided`, remembered by residual goal and state."""

    def __init__(
        self,
        spec: Spec,
        packing: Packing,
        steps: Steps,
        decided: Mapping[Code, ActionSet],
        spend: Callable[[int], None],
    ) -> None:
        self._spec, self._packing, self._steps, self._decided, self._spend = spec, packing, steps, decided, spend
        conditions = [goal.condition for goal in subgoals(spec.goals) if isinstance(goal, ConditionalGoal)]
        self._mask = packing.mask({variable for rule in conditions for variable in variables_of(rule.formula)})
        self._active: dict[int, tuple[ActiveGoals, ActionSet]] = {}
        self._known: dict[Residual, tuple[Callable[[Code], bool], dict[Code, int | None]]] = {}

    def residual(self, code: Code, chosen: ActionSet) -> Residual:
        """What a set, executed first in a state, leaves to be reached."""
        key = code & self._mask
        if key not in self._active:
            everything = frozenset(range(len(self._spec.actions)))
            goal = residual_goal(self._spec, self._packing.unpack(key), everything)
            self._active[key] = goal.bodies, goal.executed
        bodies, spoken_of = self._active[key]
        return Residual(bodies, chosen & spoken_of)

    def serves(self, code: Code, chosen: ActionSet) -> bool:
        """Whether the run that begins with a set and goes on with the policy reaches its residual goal in 1 to `L`."""
        after = self._steps.after(code, chosen)
        left = None if after is None else self.steps_left(self.residual(code, chosen), after)
        return left is not None and (self._spec.max_plan_length is None or left < self._spec.max_plan_length)

    def follower(self, code: Code) -> Code | None:
        """`δ(s, π(s))`; None where nothing is decided, or the nominal effects disagree."""
        chosen = self._decided.get(code)
        return None if chosen is None else self._steps.after(code, chosen)

    def reached(self, goal: Residual, code: Code) -> bool:
        """Whether a residual goal holds."""
        return self._of(goal)[0](code)

    def steps_left(self, goal: Residual, code: Code) -> int | None:
        """The least `k ≥ 0` after which the run from a state satisfies the goal; None: it never does."""
        holds, known = self._of(goal)
        way: list[Code] = []
        here: Code | None = code
        while here is not None and here not in known:
            if holds(here):
                known[here] = 0
            else:
                known[here] = None  # and it stays so where the run comes back here
                way.append(here)
                here = self.follower(here)
        left = None if here is None else known[here]
        for earlier in reversed(way):
            left = None if left is None else left + 1
            known[earlier] = left
        self._spend(1 + len(way))
        return known[code]

    def _of(self, goal: Residual) -> tuple[Callable[[Code], bool], dict[Code, int | None]]:
        if goal not in self._known:
            bodies = [self._spec.bodies[body] for body in sorted(goal.bodies)]
            self._known[goal] = all_hold(self._packing, bodies, goal.executed), {}
        return self._known[goal]
