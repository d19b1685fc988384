"""*No policy that stays in these valid states decides any of some of them*, by the walk (`docs/certificate.md`)."""

from __future__ import annotations

import operator

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy.unrealizability import Removal
from tumato_symbolic.semantics import Residual, state_text
from tumato_symbolic.spec import Ordering, Spec, executing_atoms
from tumato_symbolic.verify.by_diagrams.functions import FALSE, BudgetError, Function, given_up
from tumato_symbolic.verify.by_diagrams.goals import StepGoals
from tumato_symbolic.verify.by_diagrams.steps import Steps
from tumato_symbolic.verify.undecided import UndecidedError
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import goal_text, named_goal
from tumato_symbolic.verify.unrealizability.no_restoration import states_let_out


def removed(removal: Removal) -> tuple[Diagram[bool], Reference]:
    """The states that are removed, as a root of a diagram."""
    diagram = removal.diagram
    return Diagram(diagram.order, tuple(leaf is not None for leaf in diagram.leaves), diagram.nodes), removal.root


def check_removal(removal: Removal, name: str, spec: Spec, ordering: Ordering, deadline: float) -> int:
    """How many obligations were proved; the valid states of `spec` are those that are left before.

    Raises `FalseClaimError`, and `UndecidedError` where the walk gives up.
    """
    steps = Steps(spec, ordering, removal.diagram.order, deadline)
    try:
        if removal.kind == "no-restoration":
            return _check_traps(removal, name, steps)
        return _check_no_plan(removal, name, steps)
    except (BudgetError, RecursionError) as error:
        raise UndecidedError(f"{name} removes no state that a policy may decide", given_up(error)) from None


def _check_traps(removal: Removal, name: str, steps: Steps) -> int:
    """The states of each level that are removed are a trap."""
    spec, walk = steps.spec, steps.walk
    if spec.restoration == "one_step":
        raise FalseClaimError(f"{name} speaks of traps, but safety has to be restored in one step")
    diagram, root = removed(removal)
    held = walk.import_diagram(diagram, int)[root]
    safe = walk.all_of((held, steps.safe))
    if safe != FALSE:
        state = state_text(spec, steps.first_state(safe))
        raise FalseClaimError(f"{name} removes {state} as not restored, which is safe")
    for level in range(len(spec.tiers)):
        left = states_let_out(steps, walk.all_of((held, steps.tiers[level])), level)
        if left != FALSE:
            state = state_text(spec, steps.first_state(left))
            raise FalseClaimError(f"something that may be executed in {state} leads out of the trap of {name}")
    return 1 + len(spec.tiers)


def _check_no_plan(removal: Removal, name: str, steps: Steps) -> int:
    """Whatever is allowed in a state that is removed leads where its residual goal is too far away."""
    spec, walk = steps.spec, steps.walk
    diagram, root = removed(removal)
    held = walk.all_of((steps.valid, walk.import_diagram(diagram, int)[root]))
    distances = _Distances(removal, name, steps)
    for goal in distances.goals:
        distances.check(goal)
    for goal, pairs in StepGoals(steps).residuals(walk.all_of((held, distances.taken)), steps.chosen):
        left = walk.without(pairs, distances.too_far_after(goal))
        if left != FALSE:
            state, told = state_text(spec, steps.first_state(left)), goal_text(spec, goal)
            raise FalseClaimError(
                f"in {state}, which {name} removes, something is allowed after which {told} may be reached"
            )
    return 1 + 2 * len(distances.goals)


class _Distances:
    """Lower bounds of how many steps the states that are left are away from goals: numbers, cut off at the bound."""

    def __init__(self, removal: Removal, name: str, steps: Steps) -> None:
        self._name, self._steps, self._walk = name, steps, steps.walk
        finite = [leaf for leaf in removal.diagram.leaves if leaf is not None]
        if any(leaf < 0 for leaf in finite):
            raise FalseClaimError("a distance is negative")
        bound = steps.spec.max_plan_length
        self._far = far = max(finite, default=0) + 2 if bound is None else bound
        taken = self._walk.import_diagram(removal.diagram, lambda leaf: far if leaf is None else min(leaf, far))
        self.goals: dict[Residual, list[Function]] = {}
        for entry in removal.goals:
            self.goals.setdefault(_plain(steps.spec, entry.bodies, entry.executed), []).append(taken[entry.root])
        self._following = steps.successor(steps.chosen)
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
            after = walk.compose(here, self._following)
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
        return walk.any_of(walk.compose(far, self._following) for far in here)


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
