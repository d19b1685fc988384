"""The claims of a certificate about runs, looked at one by one (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tumato_symbolic.policy import Certificate
from tumato_symbolic.semantics import ActionSet, Residual
from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_states.packed import Code, Packing
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.claimed_ranks import ClaimedRanks


class Claims:
    """The numbers that a certificate gives to states."""

    def __init__(
        self, spec: Spec, packing: Packing, runs: Runs, certificate: Certificate, claimed: ClaimedRanks
    ) -> None:
        self._spec, self._packing, self._runs = spec, packing, runs
        self._ranks, self._claimed = certificate.ranks, claimed

    def look(self, claimed: Iterable[Code], pending: Mapping[Code, ActionSet]) -> None:
        """Say what became of the certificate: wrong where a number is false, incomplete where one is missing.

        `claimed` are all states where a number claims something; `pending` the decided states with an allowed decision,
        and that decision.
        """
        if not self._claimed.stands:
            return
        states = list(claimed)
        numbers = {goal: self._numbers(goal, states) for goal in self._claimed.roots}
        for goal, known in numbers.items():
            if not all(self._is_true(goal, known, code, number) for code, number in known.items()):
                self._claimed.reject(f"the ranks of {self._claimed.described(goal)} do not decrease to it")
                return
        self._look_at_the_bound(numbers, pending)

    def _look_at_the_bound(self, numbers: dict[Residual, dict[Code, int]], pending: Mapping[Code, ActionSet]) -> None:
        whole, bound = True, self._spec.max_plan_length
        for code, chosen in pending.items():
            goal, after = self._runs.residual(code, chosen), self._runs.follower(code)
            if after is None or (not goal.bodies and self._nothing_pending(code)):
                continue
            number = numbers.get(goal, {}).get(after)
            if number is None:
                if whole:
                    self._claimed.lacks(goal, self._packing.unpack(code) if goal in numbers else None)
                whole = False
            elif bound is not None and number >= bound:
                self._claimed.reject(f"its ranks of {self._claimed.described(goal)} exceed the bound")
                return
        if whole:
            self._claimed.serve()

    def _nothing_pending(self, code: Code) -> bool:
        """Whether nothing is pending without an active goal. In several steps, unsafe states have to become safe."""
        return not self._spec.restores_stepwise or self._runs.is_safe(code)

    def _numbers(self, goal: Residual, states: list[Code]) -> dict[Code, int]:
        root, found = self._claimed.roots[goal], dict[Code, int]()
        for code in states:
            number = self._ranks.evaluate(root, self._packing.unpack(code))
            if number is not None:
                found[code] = number
        return found

    def _is_true(self, goal: Residual, known: dict[Code, int], code: Code, number: int) -> bool:
        """0 where the goal holds; otherwise more than that of the next state, if that has one."""
        if number == 0:
            return self._runs.reached(goal, code)
        after = self._runs.follower(code)
        following = None if after is None else known.get(after)
        return following is not None and following < number
