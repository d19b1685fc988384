"""The claims of a certificate about restoring safety in several steps, one by one (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterable

from tumato_symbolic.policy import Deviation, Restoring
from tumato_symbolic.semantics import AT_ONCE, ActionSet, Effort
from tumato_symbolic.verify.by_states.packed import Code, Packing
from tumato_symbolic.verify.by_states.several_steps import SeveralSteps
from tumato_symbolic.verify.claimed_ranks import ClaimedRanks


class RestoringClaims:
    """The efforts that a certificate gives to unsafe states, and its deviations."""

    def __init__(self, packing: Packing, several_steps: SeveralSteps, claimed: ClaimedRanks) -> None:
        self._packing, self._several_steps, self._claimed = packing, several_steps, claimed
        self._spec, self._steps, self._runs = several_steps.spec, several_steps.steps, several_steps.runs
        self._worst: dict[Code, Effort] = {}
        self._nominal: dict[Code, Effort] = {}
        self._listed: dict[tuple[Code, ActionSet], Code] = {}

    def look(self, valid: Iterable[Code]) -> None:
        """Say what became of the efforts: wrong where one is false, incomplete where one is missing.

        `valid` are all valid states.
        """
        claimed = self._claimed
        acting = [code for code in self._several_steps.unsafe if self._acts(code)]
        if not claimed.stands or (claimed.restoring is None and not acting):
            return
        if claimed.restoring is None:
            claimed.tells_nothing_of_restoring()
            return
        self._read(claimed.restoring, [code for code in valid if not self._steps.is_safe(code)])
        for code in (*self._worst, *self._nominal):
            if not self._is_true(code):
                claimed.false_effort(self._packing.unpack(code))
                return
        missing = next((code for code in acting if code not in self._worst and code not in self._nominal), None)
        if missing is not None:
            claimed.lacks_effort(self._packing.unpack(missing))
        claimed.serve()

    def look_closer(self) -> None:
        """Say whether the efforts are what it takes, and whether the deviations are true. After `look`."""
        claimed, efforts = self._claimed, self._several_steps.efforts
        if claimed.restoring is None:
            return
        for code, chosen in self._several_steps.unsafe.items():
            exact = efforts.worst.get(code)
            nominal = None
            if exact is None and self._spec.restoration == "fair" and self._acts(code):
                nominal = efforts.nominal(code, chosen)
            if (self._worst.get(code), self._nominal.get(code)) != (exact, nominal):
                claimed.inexact_effort(self._packing.unpack(code))
                break
        for deviation in claimed.restoring.deviations:
            if not self._misses(deviation):
                claimed.false_deviation(deviation)
                return
            state, missed = self._packing.pack(deviation.state), self._packing.pack(deviation.missed)
            self._listed[state, deviation.better] = missed

    def told(self, code: Code, chosen: ActionSet) -> Code | None:
        """The state that is said to miss its goal by a better set."""
        return self._listed.get((code, chosen))

    def deviates(self, code: Code, chosen: ActionSet) -> None:
        """A better set is not chosen: the certificate should tell why."""
        if self._claimed.restoring is not None and (code, chosen) not in self._listed:
            self._claimed.lacks_deviation(self._packing.unpack(code), chosen)

    def _read(self, restoring: Restoring, unsafe: Iterable[Code]) -> None:
        self._worst, self._nominal = {}, {}
        for code in unsafe:
            state = self._packing.unpack(code)
            worst = restoring.efforts.evaluate(restoring.worst, state)
            nominal = restoring.efforts.evaluate(restoring.nominal, state)
            if worst is not None:
                self._worst[code] = worst
            elif nominal is not None and self._spec.restoration == "fair":
                self._nominal[code] = nominal

    def _acts(self, code: Code) -> bool:
        return self._runs.follower(code) is not None

    def _is_true(self, code: Code) -> bool:
        """More than the effort of every state that it is about, by the decision, which has a nominal outcome."""
        after, chosen = self._runs.follower(code), self._several_steps.unsafe.get(code)
        if after is None or chosen is None:
            return False
        efforts, restored = self._several_steps.efforts, self._steps.restored
        if code in self._worst:
            unrestored = efforts.unrestored(code, chosen)
            return all(each in self._worst for each in unrestored) and self._worst[code] >= efforts.longer(
                chosen, max((self._worst[each] for each in unrestored), default=AT_ONCE)
            )
        if restored(code, after) or after in self._worst:
            return self._nominal[code] >= efforts.longer(chosen, AT_ONCE)
        return after in self._nominal and self._nominal[code] >= efforts.longer(chosen, self._nominal[after])

    def _misses(self, deviation: Deviation) -> bool:
        """Whether the run of `missed` reaches its goal by the policy, and misses it with the better set."""
        code, missed = self._packing.pack(deviation.state), self._packing.pack(deviation.missed)
        if code not in self._several_steps.unsafe or self._steps.after(code, deviation.better) is None:
            return False
        if code == missed:
            return not self._runs.serves_changed(code, deviation.better)
        return self._runs.loses(code, deviation.better, missed)
