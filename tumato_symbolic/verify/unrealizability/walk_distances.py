"""Lower bounds of how many steps goals are away, in the walk (`docs/certificate.md`)."""

from __future__ import annotations

import operator
from collections.abc import Iterable

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy import RankedGoal
from tumato_symbolic.semantics import Residual, state_text
from tumato_symbolic.spec import Spec, executing_atoms
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.by_diagrams.goals import StepGoals
from tumato_symbolic.verify.by_diagrams.steps import Steps
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import goal_text, named_goal


class WalkDistances:
    """Lower bounds of how many steps the valid states are away from goals: numbers, cut off at the bound.

    `taken` are the steps that a policy may take, `members` the goals by the root of their distances.
    """

    def __init__(self, diagram: Diagram[int | None], goals: Iterable[RankedGoal], name: str, steps: Steps) -> None:
        self._name, self._steps, self._walk = name, steps, steps.walk
        finite = [leaf for leaf in diagram.leaves if leaf is not None]
        if any(leaf < 0 for leaf in finite):
            raise FalseClaimError("a distance is negative")
        bound = steps.spec.max_plan_length
        self._far = far = max(finite, default=0) + 2 if bound is None else bound
        taken = self._walk.import_diagram(diagram, lambda leaf: far if leaf is None else min(leaf, far))
        self.goals: dict[Residual, list[Function]] = {}
        self.members: dict[Reference, set[Residual]] = {}
        for entry in goals:
            goal = _plain(steps.spec, entry.bodies, entry.executed)
            self.goals.setdefault(goal, []).append(taken[entry.root])
            self.members.setdefault(entry.root, set()).add(goal)
        self.following = steps.successor(steps.chosen)
        self.taken = self._walk.without(steps.allowed, _staying(steps))
        self._reached = StepGoals(steps).reached

    def check(self, goal: Residual) -> None:
        """They are 0 where the goal is met, and no step makes them smaller by more than one.

        They are of all states that runs may be in: of safe ones, and where safety may take several steps to restore,
        of all that are left. Raises `FalseClaimError`.
        """
        steps, walk, spec = self._steps, self._walk, self._steps.spec
        covered = steps.valid if spec.restores_stepwise else steps.safe
        met = walk.all_of((covered, self._reached(goal)))
        pairs = walk.all_of((covered, self.taken))
        for here in self.goals[goal]:
            wrong = walk.without(met, walk.apply(operator.eq, here, FALSE))
            if wrong != FALSE:
                self._refuse(wrong, f"meets {goal_text(spec, goal)}, and its distance is not 0")
            after = walk.compose(here, self.following)
            wrong = walk.without(pairs, walk.apply(_at_most_one_more, here, after))
            if wrong != FALSE:
                self._refuse(wrong, f"leads where {goal_text(spec, goal)} is nearer by more than one step")

    def _refuse(self, wrong: Function, what: str) -> None:
        state = state_text(self._steps.spec, self._steps.first_state(wrong))
        raise FalseClaimError(f"of the distances of {self._name}: {state} {what}")

    def too_far_after(self, goal: Residual) -> Function:
        """The pairs after which a goal is too far away, wherever they are met."""
        walk = self._walk
        here = (walk.apply(operator.ge, each, walk.constant(self._far)) for each in self.goals.get(goal, ()))
        return walk.any_of(walk.compose(far, self.following) for far in here)


def _at_most_one_more(one: int, other: int) -> int:
    """`one ≤ other + 1`."""
    return int(one <= other + 1)


def _plain(spec: Spec, bodies: tuple[str, ...], executed: tuple[str, ...]) -> Residual:
    """The residual goal with these names, without executed actions that its bodies do not mention."""
    named = named_goal(spec, bodies, executed)
    mentioned = frozenset[int]().union(*(executing_atoms(spec.bodies[body].formula) for body in named.bodies))
    return Residual(named.bodies, named.executed & spec.as_actions(mentioned))


def _staying(steps: Steps) -> Function:
    """The pairs, under `bounded`, of an unsafe state and a set by which it may stay as it is: they never restore it.

    Effects that lead back to the state end with one that writes what was there: so does that one alone.
    """
    walk, spec = steps.walk, steps.spec
    if spec.restoration != "bounded":
        return FALSE
    acting = [chosen for chosen, action in zip(steps.chosen, spec.actions, strict=True) if action.effects]
    still = [walk.negation(walk.any_of(acting))]
    for chosen, action in zip(steps.chosen, spec.actions, strict=True):
        for effect in action.effects:
            kept = (walk.apply(operator.eq, walk.variable(place), walk.constant(value)) for place, value in effect)
            still.append(walk.all_of((chosen, *kept)))
    return walk.all_of((walk.without(steps.valid, steps.safe), walk.any_of(still)))
