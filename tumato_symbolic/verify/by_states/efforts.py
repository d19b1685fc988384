"""How well a policy restores safety, in all unsafe states at once (`docs/semantics.md`, sections 9 and 10)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property

from tumato_symbolic.semantics import ActionSet, duration, takes_effect
from tumato_symbolic.semantics.restoration import AT_ONCE, Effort, Quality, longer
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_states.packed import Code
from tumato_symbolic.verify.by_states.steps import Steps


class Efforts:
    """`Restorations` for the policy that decides `decided`, every number found once."""

    def __init__(
        self, spec: Spec, steps: Steps, decided: Mapping[Code, ActionSet], spend: Callable[[int], None]
    ) -> None:
        self._spec, self._steps, self._decided, self._spend = spec, steps, decided, spend
        self._lengths: dict[ActionSet, int] = {}
        self._nominal: dict[int, dict[Code, Effort | None]] = {}

    def longer(self, chosen: ActionSet, effort: Effort) -> Effort:
        """An effort with one step more before it."""
        length = self._lengths.get(chosen)
        if length is None:
            length = self._lengths[chosen] = duration(self._spec, chosen)
        return longer(effort, length)

    def unrestored(self, code: Code, chosen: ActionSet) -> set[Code]:
        """The states of `Next(s, A)` that satisfy no tier more than an unsafe state does."""
        restored = self._steps.restored
        return {after for after in self._steps.next_states(code, chosen) if not restored(code, after)}

    @cached_property
    def worst(self) -> dict[Code, Effort]:
        """`w_π(s)` of every unsafe state in which it is finite: states whose outcomes all have theirs come first."""
        left: dict[Code, set[Code]] = {}
        before: dict[Code, list[Code]] = {}
        for code, chosen in self._decided.items():
            if self._steps.is_safe(code) or self._steps.after(code, chosen) is None:
                continue
            left[code] = self.unrestored(code, chosen)
            for after in left[code]:
                before.setdefault(after, []).append(code)
        waiting = {code: len(following) for code, following in left.items()}
        found: dict[Code, Effort] = {}
        ready = [code for code, count in waiting.items() if not count]
        while ready:
            here = ready.pop()
            largest = max((found[after] for after in left[here]), default=AT_ONCE)
            found[here] = self.longer(self._decided[here], largest)
            for earlier in before.get(here, ()):
                waiting[earlier] -= 1
                if not waiting[earlier]:
                    ready.append(earlier)
        return found

    def quality(self, code: Code, chosen: ActionSet) -> Quality | None:
        """How well a set, whose nominal effects agree, restores an unsafe state that then follows the policy.

        A set that leads back to the state may get any quality that is not better than that of the policy's decision.
        """
        unrestored = self.unrestored(code, chosen)
        if not unrestored:
            return 0, self.longer(chosen, AT_ONCE)
        known = [self.worst[after] for after in unrestored if after in self.worst]
        if len(known) == len(unrestored):
            return 1, self.longer(chosen, max(known))
        nominal = self.nominal(code, chosen) if self._spec.restoration == "fair" else None
        return None if nominal is None else (2, nominal)

    def at_best(self, code: Code, chosen: ActionSet) -> Quality | None:
        """No set that contains this one restores an unsafe state better; None: none restores it at all.

        A larger set has all outcomes of a smaller one that takes effect.
        """
        alone = self.longer(chosen, AT_ONCE)
        if not takes_effect(self._spec, chosen):
            return 0, alone
        restored, outcomes = self._steps.restored, self._steps.outcomes(code, chosen)
        unrestored = {after for after in outcomes if not restored(code, after)}
        if not unrestored:
            return 0, alone
        known = [self.worst[after] for after in unrestored if after in self.worst]
        if len(known) == len(unrestored):
            return 1, self.longer(chosen, max(known))
        return (2, alone) if self._spec.restoration == "fair" else None

    def nominal(self, code: Code, chosen: ActionSet) -> Effort | None:
        """The sum of (duration, 1) along the nominal run until `code` is restored, if it ever is."""
        after = self._steps.after(code, chosen)
        left = None if after is None else self._left(self._steps.level(code), after)
        return None if left is None else self.longer(chosen, left)

    def _left(self, level: int, code: Code) -> Effort | None:
        """The same, until a state is above `level`, by the policy from `code` on."""
        known = self._nominal.setdefault(level, {})
        way: list[Code] = []
        here: Code | None = code
        while here is not None and here not in known:
            if self._steps.is_valid(here) and self._steps.level(here) > level:
                known[here] = AT_ONCE
            else:
                known[here] = None  # and it stays so where the run comes back here
                way.append(here)
                chosen = self._decided.get(here)
                here = None if chosen is None else self._steps.after(here, chosen)
        left = None if here is None else known[here]
        for earlier in reversed(way):
            left = None if left is None else self.longer(self._decided[earlier], left)
            known[earlier] = left
        self._spend(1 + len(way))
        return known[code]
