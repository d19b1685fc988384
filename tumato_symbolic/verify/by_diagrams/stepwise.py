"""*restoring* and *minimal* by the walk, where safety may take several steps to restore (`docs/certificate.md`)."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from functools import cached_property

from tumato_symbolic.semantics import NOTHING, ActionSet, State
from tumato_symbolic.spec import Ordering
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.efforts import WalkEfforts
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.result import PropertyResult
from tumato_symbolic.verify.ways_back import Changed, RestoringWitnesses, arrival, spoils

MOST_RIVALS = 500
"""How many better sets in single states are looked at that no deviation of the certificate tells of."""


class Stepwise:
    """How one policy restores safety. Raises `BudgetError` where that is too much for the walk."""

    def __init__(
        self, model: ClosedLoop, goals: WalkGoals, ranks: WalkRanks, decisions: Decisions, ordering: Ordering
    ) -> None:
        self._model, self._walk, self._spec = model, model.walk, model.spec
        self._goals, self._ranks, self._decisions = goals, ranks, decisions
        self._efforts = WalkEfforts(model, ordering)
        self._witnesses = RestoringWitnesses(model.spec, decisions, ordering)
        self._looked_at = False
        self._claimed: tuple[Function, Function] | None = None

    @property
    def _fair(self) -> bool:
        return self._spec.restoration == "fair"

    def _look_at_the_certificate(self) -> None:
        """Say what became of the efforts of the certificate, and keep them where they are right."""
        if self._looked_at or not self._ranks.stands:
            return
        restoring, unsafe = self._ranks.restoring, self._efforts.unsafe
        if restoring is None:
            if unsafe != FALSE:
                self._ranks.tells_nothing_of_restoring()
            self._looked_at = True
            return
        worst, nominal = self._efforts.claimed(restoring)
        wrong = self._efforts.false_efforts(worst, nominal)
        self._looked_at = True
        if wrong != FALSE:
            self._ranks.false_effort(self._model.first_state(wrong))
            return
        missing = self._lost(worst, nominal)
        if missing != FALSE:
            self._ranks.lacks_effort(self._model.first_state(missing))
        self._ranks.serve()
        self._claimed = worst, nominal

    def _lost(self, worst: Function, nominal: Function) -> Function:
        """The states without either effort."""
        is_never = self._efforts.is_never
        return self._walk.all_of((self._efforts.unsafe, is_never(worst), is_never(nominal)))

    @cached_property
    def _worst(self) -> Function:
        return self._efforts.exact_worst(self._claimed[0] if self._claimed is not None else None)

    @cached_property
    def _nominal(self) -> Function:
        """The efforts along nominal runs, under `fair`."""
        return self._efforts.exact_nominal() if self._fair else self._efforts.never

    # restoring

    def restoring(self, policy_is_safe: Callable[[], bool]) -> PropertyResult:
        """Every unsafe state is restored as it has to be."""
        self._look_at_the_certificate()
        proved = PropertyResult("restoring", "proved", len(self._model.tiers), "walk")
        if self._claimed is not None and (not self._fair or policy_is_safe()) and self._lost(*self._claimed) == FALSE:
            return proved
        lost = self._lost(self._worst, self._nominal)
        return proved if lost == FALSE else self._witnesses.not_restored(self._model.first_state(lost))

    # minimal

    def minimal(self) -> PropertyResult:
        """No set restores better and keeps no run from its goal."""
        self._look_at_the_certificate()
        self._look_closer()
        rivals, goals = self._rivals()
        for state, chosen in self._listed():
            rivals = self._walk.without(rivals, self._at(state, chosen))
        for _ in range(MOST_RIVALS):
            if rivals == FALSE:
                return PropertyResult("minimal", "proved", 1 + goals, "walk")
            state = self._model.first_state(rivals)
            here = self._walk.all_of((rivals, self._model.is_state(state)))
            chosen = self._best(here)
            rivals = self._walk.without(rivals, self._at(state, chosen))
            changed = Changed(self._decisions, state, chosen)
            if arrival(self._spec, changed, state, chosen) is None:
                continue
            if not self._spoils_any(state, chosen):
                return self._witnesses.not_minimal(state, chosen)
            if self._ranks.restoring is not None:
                self._ranks.lacks_deviation(state, chosen)
        raise BudgetError("too many better sets would keep a run from its goal")

    def _look_closer(self) -> None:
        """Say whether the efforts of the certificate are what it takes."""
        if self._claimed is None:
            return
        walk, efforts = self._walk, self._efforts
        nominal = walk.select(efforts.is_never(self._worst), (efforts.never, self._nominal))
        pairs = zip(self._claimed, (self._worst, nominal), strict=True)
        same = walk.all_of(walk.apply(operator.eq, claimed, exact) for claimed, exact in pairs)
        inexact = walk.without(walk.without(self._model.decided, self._model.safe), same)
        if inexact != FALSE:
            self._ranks.inexact_effort(self._model.first_state(inexact))

    def _rivals(self) -> tuple[Function, int]:
        """Where a set restores better and, as far as ranks tell, reaches its goal; of how many goals that was asked."""
        model, walk, efforts = self._model, self._walk, self._efforts
        unsafe = walk.without(model.decided, model.safe)
        now = efforts.qualities(self._worst, self._nominal if self._fair else None)
        self._quality = efforts.rival_qualities(unsafe, self._worst)
        better = walk.all_of((unsafe, walk.apply(operator.lt, self._quality, now)))
        if better != FALSE:
            better = walk.all_of((better, model.allowed))
        pending, step, found = self._ranks.aims(better, model.chosen), model.successor(model.chosen), FALSE
        for goal, where in pending:
            after = walk.compose(self._ranks.near_at_least(goal), step)
            serves = walk.all_of((where, self._goals.own(goal, after, model.chosen)))
            found = walk.any_of((found, serves))
        return found, len(pending)

    def _listed(self) -> Iterator[tuple[State, ActionSet]]:
        """The deviations of the certificate, all of which are true."""
        restoring = self._ranks.restoring
        if restoring is None:
            return
        for each in restoring.deviations:
            if not spoils(self._spec, self._decisions, each):
                self._ranks.false_deviation(each)
                return
        yield from ((each.state, each.better) for each in restoring.deviations if each.missed != each.state)

    def _best(self, where: Function) -> ActionSet:
        """Of the sets that are possible in one state, the best, then smallest, then first one."""
        model, chosen = self._model, NOTHING
        for measure in (self._quality, model.size(model.chosen)):
            where = model.least(where, measure)
        for action, executed in enumerate(model.chosen):
            with_it = self._walk.all_of((where, executed))
            if with_it != FALSE:
                where, chosen = with_it, chosen | {action}
        return chosen

    def _spoils_any(self, state: State, chosen: ActionSet) -> bool:
        """Whether a set, in one state, takes another run its goal: backwards along the runs that pass that state."""
        spec, walk, model = self._spec, self._walk, self._model
        changed, bound = Changed(self._decisions, state, chosen), self._spec.max_plan_length
        here = self._model.is_state(state)
        for goal, pending in self._goals.residuals(walk.all_of((model.decided, model.acting)), model.policy):
            today = arrival(spec, self._decisions, state, self._decisions[state], goal)
            if today is None:
                continue  # no run to this goal passes the state
            then = arrival(spec, changed, state, chosen, goal)
            if bound is None and then is not None:
                continue
            steps, passing = 1, self._before(here, here)
            while passing != FALSE and (bound is None or steps + today <= bound):
                late = then is None or bound is None or steps + then > bound
                if late and walk.all_of((pending, passing)) != FALSE:
                    return True
                onward = walk.without(passing, self._goals.reached(goal))
                steps, passing = steps + 1, self._before(onward, here)
        return False

    def _before(self, where: Function, here: Function) -> Function:
        """The states, other than one, from where the policy's next step leads into `where`."""
        walk, model = self._walk, self._model
        return walk.without(walk.all_of((model.acting, model.next(where))), here)

    def _at(self, state: State, chosen: ActionSet) -> Function:
        """One state and one set."""
        each = zip(range(len(self._model.chosen)), self._model.chosen, strict=True)
        executed = (predicate if action in chosen else self._walk.negation(predicate) for action, predicate in each)
        return self._walk.all_of((self._model.is_state(state), *executed))
