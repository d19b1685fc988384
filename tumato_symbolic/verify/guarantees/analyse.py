"""What a policy guarantees, of all states at once (`docs/semantics.md`, section 11)."""

from __future__ import annotations

from collections.abc import Iterator

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.limits import Budget, Context, LimitReachedError
from tumato_symbolic.policy import Policy, as_diagram, bind, judged_within
from tumato_symbolic.policy.guarantees import GuaranteesCertificate
from tumato_symbolic.semantics import Guarantee, Residual, Shortcoming, Shortcomings, State, residual_goal, shows
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import BudgetError, given_up
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.decisions import Decisions
from tumato_symbolic.verify.guarantees.certifying import certificate_of
from tumato_symbolic.verify.guarantees.prospects import WalkProspects
from tumato_symbolic.verify.guarantees.result import Guarantees, Level
from tumato_symbolic.verify.guarantees.state_sets import StateSets

BUDGET = 300.0
"""How many seconds the walk may take, where nothing else is said."""


def guarantees(
    policy: Policy,
    spec: Spec,
    ordering: Ordering,
    *,
    certify: bool = False,
    timeout: float | None = BUDGET,
    context: Context | None = None,
) -> Guarantees:
    """What a policy guarantees that is proved to be total, safe, and to reach its goals under `ordering`.

    `certify`: with a certificate. Undecided where the walk takes more time or memory than it is given.
    """
    context = context or Context()
    try:
        context.tell("computing what is guaranteed")
        bound = bind(policy, spec)
        analysis = Analysis(judged_within(spec, bound), bound, ordering, Budget(timeout, context))
        levels = analysis.levels()
        return Guarantees("known", levels, certificate=analysis.certificate(levels) if certify else None)
    except (BudgetError, RecursionError) as error:
        reason = given_up(error)
    except LimitReachedError as limit:
        reason = str(limit)
    return Guarantees("undecided", reason=context.described() if context.is_over else reason)


class Analysis:
    """The guarantees of one policy. Raises `BudgetError` where the walk gives up, and `LimitReachedError`."""

    def __init__(self, spec: Spec, policy: Policy, ordering: Ordering, budget: Budget) -> None:
        self._spec, self._ordering, self._context = spec, ordering, budget.context
        self._decisions = Decisions(spec, policy)
        self._model = ClosedLoop(spec, as_diagram(policy), ordering, budget.until())
        self._goals = WalkGoals(self._model)
        variables = sorted(range(len(spec.variables)), key=lambda each: self._model.walk.level_of[each])
        self._sets = StateSets(spec, variables, budget.context)
        self._prospects: dict[Residual, WalkProspects] = {}

    def levels(self) -> tuple[Level, ...]:
        """The levels of all states, the strongest first."""
        found: dict[Guarantee, list[Reference]] = {}
        for goal, pending in self._goals.residuals(self._model.decided, self._model.policy):
            self._context.check()
            self._model.walk.check_time()
            self._prospects[goal] = WalkProspects(self._model, self._goals, goal)
            for guarantee, states in self._prospects[goal].levels(pending):
                if guarantee is None:
                    raise RuntimeError("a nominal run misses its goal, although that it does not is proved")
                found.setdefault(guarantee, []).append(self._sets.of_walk(self._model.walk, states))
        return tuple(self._joined(found))

    def certificate(self, levels: tuple[Level, ...]) -> GuaranteesCertificate:
        """What shows that these are the levels."""
        ranks = {goal: each.ranks() for goal, each in self._prospects.items()}
        return certificate_of(self._spec, self._model.walk, self._ordering, ranks, levels)

    def _joined(self, found: dict[Guarantee, list[Reference]]) -> Iterator[Level]:
        """One level for all guaranteed states, and one for each weaker guarantee."""
        valid = self._sets.of_walk(self._model.walk, self._model.valid)
        forced = [each for each in found if each.kind == "guaranteed"]
        parts = {each: sets for each, sets in found.items() if each.kind != "guaranteed"}
        if forced:
            worst = max(forced, key=lambda each: each.steps or 0)
            parts[worst] = [states for each in forced for states in found[each]]
        for guarantee in sorted(parts, key=_strength):
            self._context.check()
            states = self._sets.union(parts[guarantee])
            cubes = self._sets.cubes(states, valid)
            shortcoming = self._shortcoming(self._sets.first(states), guarantee)
            yield Level(guarantee, self._sets.count(states), cubes, shortcoming)

    def _shortcoming(self, state: State, guarantee: Guarantee) -> Shortcoming | None:
        """Why a state is guaranteed no more, replayed.

        Raises `RuntimeError` where the explicit meaning says otherwise: a bug of ours.
        """
        prospects = self._prospects[residual_goal(self._spec, state, self._decisions[state])]
        told = Shortcomings(self._spec, self._decisions, self._ordering, prospects.endures, prospects.forced)
        found = told.of(state, guarantee)
        if found is not None and not shows(self._spec, self._decisions, self._ordering, guarantee, found):
            raise RuntimeError(f"{found} does not show that {state} is {guarantee.kind} at most")
        return found


def _strength(guarantee: Guarantee) -> tuple[int, int]:
    """Guaranteed first, then fair, then the more deviations the better."""
    kinds = ("guaranteed", "fair", "survives", "nominal")
    return kinds.index(guarantee.kind), -(guarantee.deviations or 0)
