"""*No policy serves these states together*, where runs may be in unsafe states, by the walk.

Why this is a proof: `docs/certificate.md`, the section on unrealizability.
"""

from __future__ import annotations

from tumato_symbolic.limits import Budget
from tumato_symbolic.policy.unrealizability import Choice, Conflict
from tumato_symbolic.semantics import State, state_text
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function, given_up
from tumato_symbolic.verify.by_diagrams.goals import StepGoals
from tumato_symbolic.verify.by_diagrams.steps import Steps
from tumato_symbolic.verify.undecided import UndecidedError
from tumato_symbolic.verify.unrealizability.conflict import check_choices, outcomes_of, refute_choices
from tumato_symbolic.verify.unrealizability.distances import Distances
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import goal_text
from tumato_symbolic.verify.unrealizability.obligations import Obligations
from tumato_symbolic.verify.unrealizability.walk_distances import WalkDistances


def check_stepwise_conflict(reason: Conflict, spec: Spec, ordering: Ordering, budget: Budget) -> Obligations:
    """What was proved. Raises `FalseClaimError`, and `UndecidedError` where a claim is left open."""
    check_choices(reason, spec)
    steps = Steps(spec, ordering, reason.distances.order, budget.until())
    try:
        distances = WalkDistances(reason.distances, reason.goals, "the conflict", steps)
        for goal in distances.goals:
            distances.check(goal)
        _Options(reason, distances, steps).check()
    except (BudgetError, RecursionError) as error:
        raise UndecidedError("the goals conflict", given_up(error)) from None
    refute_choices(reason, Distances(reason.distances, spec.max_plan_length), spec, budget.until())
    walked = 2 * len(distances.goals) + len(reason.choices)
    return Obligations(len(reason.choices) + len(reason.cuts), 1, walked)


class _Options:
    """What may be done in the states that have choices."""

    def __init__(self, reason: Conflict, distances: WalkDistances, steps: Steps) -> None:
        self._reason = reason
        self._distances = distances
        self._steps = steps
        self._goals = StepGoals(steps)
        self._leading: dict[State, Function] = {}

    def check(self) -> None:
        """Whatever may be done in one of these states is one of its options. Raises `FalseClaimError`."""
        walk, steps = self._steps.walk, self._steps
        for choice in self._reason.choices:
            here = walk.all_of((steps.is_state(choice.state), self._distances.taken))
            for goal, pairs in self._goals.residuals(here, steps.chosen):
                named = (
                    self._pairs(choice, number)
                    for number, (_, known) in enumerate(choice.options)
                    if goal in self._distances.members[self._reason.goals[known].root]
                )
                if walk.without(pairs, walk.any_of(named)) != FALSE:
                    spec = steps.spec
                    text = f"in {state_text(spec, choice.state)}, something that may be done is no option"
                    raise FalseClaimError(f"{text}, with {goal_text(spec, goal)} pending")

    def _pairs(self, choice: Choice, number: int) -> Function:
        """The steps that lead where an option says, and whose outcomes may be those that it has."""
        walk, (after, _) = self._steps.walk, choice.options[number]
        there = walk.compose(self._steps.is_state(after), self._distances.following)
        return walk.all_of((there, *map(self._may_lead_to, outcomes_of(choice, number))))

    def _may_lead_to(self, state: State) -> Function:
        """The steps with a state among `Next(s, A)`."""
        if state not in self._leading:
            walk = self._steps.walk
            surely_not = self._steps.into(walk.negation(self._steps.is_state(state)))
            self._leading[state] = walk.negation(surely_not)
        return self._leading[state]
