"""How long the runs of a policy are (`docs/semantics.md`, sections 4, 5 and 9)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property

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
        bodies, mentioned = self._active[key]
        return Residual(bodies, self._spec.as_actions(chosen) & mentioned)

    def serves(self, code: Code, chosen: ActionSet) -> bool:
        """Whether the run that begins with a set and goes on with the policy reaches its residual goal in 1 to `L`."""
        after = self._steps.after(code, chosen)
        left = None if after is None else self.steps_left(self.residual(code, chosen), after)
        return left is not None and (self._spec.max_plan_length is None or left < self._spec.max_plan_length)

    def serves_changed(self, code: Code, chosen: ActionSet) -> bool:
        """The same, where the policy is changed to the set: the run never serves once it is back in the state."""
        goal, after = self.residual(code, chosen), self._steps.after(code, chosen)
        return after is not None and self._arrives(goal, after, 1, self._way_back(code, after))

    def losing(self, code: Code, chosen: ActionSet) -> Iterator[Code]:
        """The other states whose run reaches its goal by the policy, and misses it once the policy is changed so.

        For an unsafe state, where safety may take several steps to restore: no goal is reached there.
        """
        after = self._steps.after(code, chosen)
        if after is None:
            return
        back, met, layer, steps = self._way_back(code, after), {code}, [code], 0
        while layer:
            steps += 1
            layer = [origin for state in layer for origin in self._origins.get(state, ()) if origin not in met]
            met.update(layer)
            self._spend(len(layer))
            for origin in layer:
                goal, first = self.residual(origin, self._decided[origin]), self.follower(origin)
                left = None if first is None else self.steps_left(goal, first)
                if left is None or not self._soon(1 + left) or left < steps:
                    continue  # it misses its goal anyway, or reaches it before it comes to the state
                if not self._arrives(goal, after, steps + 1, back):
                    yield origin

    def loses(self, code: Code, chosen: ActionSet, other: Code) -> bool:
        """Whether the run from a state reaches its goal by the policy, and misses it once the policy is changed so."""
        decision, after = self._decided.get(other), self._steps.after(code, chosen)
        if decision is None or after is None or other == code or not self.serves(other, decision):
            return False
        here, steps, goal = self.follower(other), 1, self.residual(other, decision)
        while here is not None and here != code and not self.reached(goal, here):
            here, steps = self.follower(here), steps + 1
        back = self._way_back(code, after)
        return here == code and not self._arrives(goal, after, steps + 1, back)

    def _soon(self, steps: int) -> bool:
        return self._spec.max_plan_length is None or steps <= self._spec.max_plan_length

    def _arrives(self, goal: Residual, after: Code, steps: int, back: int | None) -> bool:
        """Whether a run that is in `after` after some steps reaches the goal by the policy in less than `back` more."""
        left = self.steps_left(goal, after)
        return left is not None and self._soon(steps + left) and (back is None or left < back)

    def _way_back(self, code: Code, after: Code) -> int | None:
        """After how many steps the policy leads from one state to another, if it does."""
        here: Code | None = after
        met: set[Code] = set()
        while here is not None and here not in met:
            if here == code:
                return len(met)
            met.add(here)
            here = self.follower(here)
        self._spend(len(met))
        return None

    @cached_property
    def _origins(self) -> dict[Code, list[Code]]:
        """Every state with those that the policy leads to it."""
        found: dict[Code, list[Code]] = {}
        for code in self._decided:
            after = self.follower(code)
            if after is not None:
                found.setdefault(after, []).append(code)
        return found

    def follower(self, code: Code) -> Code | None:
        """`δ(s, π(s))`; None where nothing is decided, or the nominal effects disagree."""
        chosen = self._decided.get(code)
        return None if chosen is None else self._steps.after(code, chosen)

    def is_safe(self, code: Code) -> bool:
        """`s ∈ S`."""
        return self._steps.is_safe(code)

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
            hold, is_safe = all_hold(self._packing, bodies, goal.executed), self._steps.is_safe
            everywhere = not self._spec.restores_stepwise
            self._known[goal] = hold if everywhere else lambda code: is_safe(code) and hold(code), {}
        return self._known[goal]
