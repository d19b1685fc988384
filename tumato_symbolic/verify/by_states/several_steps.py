"""*restoring* and *minimal* where safety may take several steps to restore (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property

from msgspec import Struct

from tumato_symbolic.semantics import ActionSet, Quality
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_states.efforts import Efforts
from tumato_symbolic.verify.by_states.packed import Code
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.by_states.steps import Steps


class Rival(Struct, frozen=True):
    """A set that would restore an unsafe state better and whose own run would reach its goal.

    `misses` is a state that the policy leads to its goal, and would not if it were changed to that set; None where
    there is none, so that the policy is not minimal.
    """

    chosen: ActionSet
    quality: Quality
    misses: Code | None


class SeveralSteps:
    """How the policy that decides `decided` restores safety."""

    def __init__(
        self,
        spec: Spec,
        steps: Steps,
        runs: Runs,
        decided: Mapping[Code, ActionSet],
        spend: Callable[[int], None],
    ) -> None:
        self.spec, self.steps, self.runs, self._decided = spec, steps, runs, decided
        self.efforts = Efforts(spec, steps, decided, spend)

    @cached_property
    def unsafe(self) -> dict[Code, ActionSet]:
        """The decisions in unsafe states."""
        return {code: chosen for code, chosen in self._decided.items() if not self.steps.is_safe(code)}

    def now(self, code: Code) -> Quality | None:
        """How well the policy restores a state; None where it does not."""
        chosen = self._decided[code]
        return None if self.steps.after(code, chosen) is None else self.efforts.quality(code, chosen)

    def not_restored(self) -> Iterator[Code]:
        """The unsafe states that the policy does not restore, of those where its nominal effects agree."""
        for code, chosen in self.unsafe.items():
            if self.steps.after(code, chosen) is not None and self.efforts.quality(code, chosen) is None:
                yield code

    def rivals(self, code: Code, told: Callable[[ActionSet], Code | None]) -> Iterator[Rival]:
        """The rivals of the decision in an unsafe state: the best, then smallest, then first ones first.

        `told` is a state of which it is said that it would miss its goal by a set, to be looked at first.
        """
        now, found = self.now(code), list[tuple[Quality, int, list[int]]]()
        for chosen in self.steps.allowed_sets(code, lambda chosen: self._may_be_better(code, chosen, now)):
            quality = self.efforts.quality(code, chosen)
            if quality is not None and (now is None or quality < now):
                found.append((quality, len(chosen), sorted(chosen)))
        for quality, _, numbers in sorted(found):
            chosen = frozenset(numbers)
            if self.runs.serves_changed(code, chosen):
                missed = told(chosen)
                if missed is None or not self.runs.loses(code, chosen, missed):
                    missed = next(self.runs.losing(code, chosen), None)
                yield Rival(chosen, quality, missed)

    def _may_be_better(self, code: Code, chosen: ActionSet, now: Quality | None) -> bool:
        at_best = self.efforts.at_best(code, chosen)
        return at_best is not None and (now is None or at_best < now)
