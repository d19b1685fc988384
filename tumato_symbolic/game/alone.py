"""What each state can do taken alone, where safety may take several steps to restore (section 9.8)."""

from __future__ import annotations

from collections.abc import Callable

from msgspec import Struct

from tumato_symbolic.game.evaluation import winning
from tumato_symbolic.game.fixpoints import Layers, distances, preimage
from tumato_symbolic.game.problem import Problem
from tumato_symbolic.symbolic import Bdd, compatible_sets, staying_in, without_effect


class Alone(Struct, frozen=True):
    """`restorable` is `R`, the safe states included; `pairs` are the steps that a run of one state may take."""

    restorable: Bdd
    pairs: Bdd


def alone(problem: Problem, pending: Bdd | None = None) -> Alone:
    """Which states can be restored, and by which steps a run may go back to safety and on to its goal.

    Under `bounded` a step from an unsafe state stays where everything can be restored, and never stays in place. Under
    `one_step` and `fair` every allowed step will do. `pending` is as in `staying_in`, if it is known. Raises
    `LimitReachedError` when time is up.
    """
    steps, encoding = problem.steps, problem.encoding
    restorable, pairs = steps.safe, steps.allowed & steps.safe
    compatible = compatible_sets(encoding) if pending is None else pending
    for states, upper in steps.levels:
        here = steps.allowed & states
        if here == problem.false:
            continue
        if problem.spec.restoration == "bounded":

            def into(target: Bdd, asked: Bdd) -> Bdd:
                return asked & staying_in(encoding, steps.ordering, target, compatible, asked)

        else:

            def into(target: Bdd, asked: Bdd) -> Bdd:
                return preimage(problem, asked)(target)

        found = _attracted(problem, here, upper, into)
        restorable = restorable | (found & ~upper)
        if problem.spec.restoration == "bounded":
            here = into(found, here) & ~_staying_in_place(problem)
        pairs = pairs | here
    return Alone(restorable, pairs)


def way_of(problem: Problem, pending: Bdd | None = None) -> Alone | None:
    """`alone`, where safety may take several steps to restore."""
    return alone(problem, pending) if problem.spec.restores_stepwise else None


def chances(problem: Problem, way: Alone | None) -> tuple[tuple[Layers, ...], Bdd]:
    """How far states are from each target when each is taken alone, and the steps that they may take."""
    if way is None:
        return distances(problem), problem.steps.allowed
    return distances(problem, way.pairs), way.pairs


def winning_alone(problem: Problem, pending: Bdd | None = None) -> Bdd:
    """The states that have a plan when each is taken alone; `pending` is as in `staying_in`, if it is known."""
    return winning(problem, *chances(problem, way_of(problem, pending)))


def _attracted(problem: Problem, pairs: Bdd, target: Bdd, into: Callable[[Bdd, Bdd], Bdd]) -> Bdd:
    """`μ X. target ∪ {s : ∃ A. (s, A) ∈ pairs leads into X}`."""
    found = target
    while True:
        problem.context.check()
        left = pairs & ~found
        more = problem.steps.states_of(into(found, left)) if left != problem.false else problem.false
        if more == problem.false:
            return found
        found = found | more


def _staying_in_place(problem: Problem) -> Bdd:
    """The pairs with the state itself among the outcomes.

    The last effect on the way back writes what was there: then it alone changes nothing either.
    """
    encoding, manager = problem.encoding, problem.encoding.manager
    still = without_effect(encoding)
    for number, action in enumerate(problem.spec.actions):
        unchanged = manager.union(manager.cube(encoding.assignment_bits(effect)) for effect in action.effects)
        still = still | (encoding.executing(number) & unchanged)
    return still
