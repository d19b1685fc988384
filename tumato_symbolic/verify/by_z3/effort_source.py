"""Where efforts come from: the policy's certificate as long as it holds, otherwise the policy itself."""

from __future__ import annotations

from functools import cached_property

from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Restoring
from tumato_symbolic.semantics import AT_ONCE, Effort, Restorations, State, duration, is_safe, longer, restored
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_z3.efforts import Efforts
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.rank_source import RankSource
from tumato_symbolic.verify.by_z3.solver import UndecidedError

MOST_UNSAFE = 20_000
"""In how many unsafe states efforts are recomputed."""


class EffortSource:
    """The efforts of one policy, proved; `ranks` tells what became of its certificate."""

    def __init__(self, problem: PolicyProblem, ranks: RankSource, ordering: Ordering, policy_is_safe: bool) -> None:
        self._problem, self.ranks = problem, ranks
        self._ordering: Ordering = ordering
        self.policy_is_safe = policy_is_safe
        self._checked: Efforts | None = None

    def claimed(self) -> Efforts | None:
        """Those of the certificate, nowhere too small; None where that cannot be said. Raises `UndecidedError`."""
        restoring = self.ranks.restoring
        if restoring is None:
            return None
        if self._checked is None:
            efforts = Efforts(self._problem, restoring, self._ordering, conflicting=not self.policy_is_safe)
            false = efforts.first_false()
            if false is not None:
                self.ranks.false_effort(false)
                return None
            self._checked = efforts
        return self._checked

    def exact(self) -> Efforts:
        """Efforts with a `w` that is nowhere too large either. Raises `UndecidedError`.

        So are nominal ones, as long as the policy can be looked at state by state.
        """
        claimed = self.claimed()
        too_large = None if claimed is None else claimed.too_large()
        if too_large is not None:
            self.ranks.inexact_effort(too_large)
        if claimed is None or too_large is not None:
            return self.recomputed
        if not claimed.fair or claimed.nominal_is_exact():
            return claimed
        try:
            found = self.recomputed
        except UndecidedError:
            return claimed
        self._compare(claimed.record)
        return found

    def _compare(self, claimed: Restoring) -> None:
        """Record where nominal efforts of the certificate are not those that the policy has."""
        for state in self._unsafe or ():
            worst, nominal = (claimed.efforts.evaluate(root, state) for root in (claimed.worst, claimed.nominal))
            if worst is None and nominal != self._nominal(state):
                self.ranks.inexact_effort(state)
                return

    @cached_property
    def _unsafe(self) -> list[State] | None:
        """The unsafe states where the policy acts; None where there are too many."""
        decisions = self.ranks.decisions
        if decisions.rows is None:
            return None
        found = [state for state in decisions.followers if not is_safe(self._problem.spec, state)]
        return None if len(found) > MOST_UNSAFE else found

    @cached_property
    def recomputed(self) -> Efforts:
        """Those that the policy has, wherever it restores safety. Raises `UndecidedError`.

        Without nominal ones where these do not fall: where a step leads to a lower level, which no safe policy allows.
        """
        efforts = self._exact_ones(nominal=self._problem.spec.restoration == "fair")
        if efforts is None and not self.policy_is_safe:
            efforts = self._exact_ones(nominal=False)
        if efforts is None:
            if self.policy_is_safe:
                raise RuntimeError("the efforts of a policy are no efforts")
            raise UndecidedError("safety is restored", "the policy is not safe")
        return efforts

    def first_lost(self) -> State | None:
        """An unsafe state that the policy does not restore, if there is one. Raises `UndecidedError`."""
        without = self.recomputed.first_without()
        if without is None or not self.recomputed.fair or self._nominal(without) is None:
            return without
        worst_of, unsafe = self.recomputed.worst_of, self._unsafe or ()
        return next((each for each in unsafe if worst_of(each) is None and self._nominal(each) is None), None)

    def _exact_ones(self, *, nominal: bool) -> Efforts | None:
        """Efforts by the explicit meaning, `nominal` ones too, if the solver finds them exact."""
        record = self._restoring(nominal=nominal)
        efforts = Efforts(self._problem, record, self._ordering, conflicting=not self.policy_is_safe)
        return efforts if efforts.first_false() is None and efforts.too_large() is None else None

    def _restoring(self, *, nominal: bool) -> Restoring:
        spec, decisions = self._problem.spec, self.ranks.decisions
        unsafe = self._unsafe
        if unsafe is None:
            why = f"there are no exact efforts, and over {MOST_UNSAFE} unsafe states are too many to check one by one"
            raise UndecidedError("safety is restored", why)
        rows = {state: decisions[state] for state in unsafe}
        worst = Restorations(spec, rows, self._ordering).worst
        runs = {state: effort for state in unsafe if (effort := self._nominal(state)) is not None} if nominal else {}
        builder = DiagramBuilder[Effort | None](
            range(len(spec.variables)), [None, *sorted({*worst.values(), *runs.values()})]
        )
        sizes = [len(variable.values) for variable in spec.variables]
        worst_root, nominal_root = (builder.from_table(sizes, table, None) for table in (worst, runs))
        return Restoring(builder.finish(), worst_root, nominal_root)

    def _nominal(self, state: State) -> Effort | None:
        """What the nominal run takes until `state` is restored, if it ever is."""
        spec, decisions = self._problem.spec, self.ranks.decisions
        effort, here, met = AT_ONCE, state, set[State]()
        while here not in met and here in decisions.followers:
            met.add(here)
            effort, here = longer(effort, duration(spec, decisions[here])), decisions.followers[here]
            if restored(spec, state, here):
                return effort
        return None
