"""How safety is restored when it may take several steps (`docs/semantics.md`, sections 9 and 10)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from tumato_symbolic.semantics.states import ActionSet, State, duration, is_safe, is_valid, level
from tumato_symbolic.semantics.step import next_states, nominal_agrees, successor
from tumato_symbolic.spec import Ordering, Spec

Effort: TypeAlias = tuple[int, int]
"""(duration, steps) of several steps: added by component, compared by duration, then by steps."""

AT_ONCE: Effort = (0, 0)
"""The effort of what is safe already."""

Quality: TypeAlias = tuple[int, Effort]
"""How well a set restores safety, the smaller the better; see `Restorations.quality`."""


def longer(effort: Effort, lasting: int) -> Effort:
    """An effort with one step more, which lasts so long."""
    return effort[0] + lasting, effort[1] + 1


def restored(spec: Spec, state: State, after: State) -> bool:
    """Whether `after` satisfies a tier of state rules more than `state` does: with one tier, whether it is safe."""
    return is_valid(spec, after) and level(spec, after) > level(spec, state)


class Restorations:
    """How a policy, which need not be defined everywhere, restores the unsafe states that it decides.

    `worst` has `w_π(s)` for each of them; states where it is infinite are absent. Where it is given, neither it nor the
    policy is listed.
    """

    def __init__(
        self,
        spec: Spec,
        policy: Mapping[State, ActionSet],
        ordering: Ordering,
        worst: Mapping[State, Effort] | None = None,
    ) -> None:
        self._spec = spec
        self._policy = policy
        self._ordering: Ordering = ordering
        self.worst: Mapping[State, Effort] = {} if worst is None else worst
        if worst is None:
            self._find_worst()

    def _find_worst(self) -> None:
        spec, policy, ordering = self._spec, self._policy, self._ordering
        known: dict[State, Effort] = {}
        self.worst = known
        open_ = {
            state: next_states(spec, state, chosen, ordering)
            for state, chosen in policy.items()
            if not is_safe(spec, state) and nominal_agrees(spec, chosen)
        }
        while found := {
            state: effort for state, after in open_.items() if (effort := self._worst_after(state, after)) is not None
        }:
            known |= {state: longer(effort, duration(spec, policy[state])) for state, effort in found.items()}
            open_ = {state: after for state, after in open_.items() if state not in found}

    def quality(self, state: State, chosen: ActionSet) -> Quality | None:
        """How well `chosen`, whose nominal effects agree, restores an unsafe state that then follows the policy.

        One step comes before more (0 before 1), and what is restored whatever happens before what is restored where
        nominal effects recur (2, under `fair` only); among equals the smaller effort is better. None: it restores
        nothing.
        """
        after = next_states(self._spec, state, chosen, self._ordering)
        worst = self._worst_after(state, after)
        if worst is not None:
            kind = 0 if worst == AT_ONCE else 1
            return kind, longer(worst, duration(self._spec, chosen))
        if self._spec.restoration == "fair":
            nominal = self.nominal(state, chosen)
            return None if nominal is None else (2, nominal)
        return None

    def nominal(self, state: State, chosen: ActionSet) -> Effort | None:
        """The sum of (duration, 1) along the nominal run until `state` is restored, if it ever is.

        The run is that of the policy changed to `chosen` in `state`.
        """
        spec, effort, here = self._spec, AT_ONCE, state
        executed: ActionSet | None = chosen
        seen: set[State] = set()
        while here not in seen and executed is not None and nominal_agrees(spec, executed):
            seen.add(here)
            effort = longer(effort, duration(spec, executed))
            here = successor(spec, here, executed)
            if restored(spec, state, here):
                return effort
            executed = chosen if here == state else self._policy.get(here)
        return None

    def _worst_after(self, state: State, after: set[State]) -> Effort | None:
        """`max { w(t) : t ∈ after }`, with (0, 0) for states that are restored; None where it is infinite."""
        still_unsafe = [each for each in after if not restored(self._spec, state, each)]
        if all(each in self.worst for each in still_unsafe):
            return max((self.worst[each] for each in still_unsafe), default=AT_ONCE)
        return None
