"""A tour through the goals of all regions, where goals take turns for ever: runs that follow it meet their own in time.

Where a robot's goal changes as soon as it is reached, as with tasks that follow each other, goals of several robots
are met together only on the way to other goals. A loop of safe states that meets every target serves each of its
states, whichever goal is active there, and each state that is led to it.
"""

from __future__ import annotations

from tumato_symbolic.game import Evaluation, Evaluator, Problem, attractor, by_any_step
from tumato_symbolic.symbolic import Bdd, preferred

ROUNDS_BEFORE_TOUR = 8
"""After so many rounds of repair, one loop through all goals is looked for, which serves as well."""

MOST_TARGETS = 256
"""Tours meet so many targets at most."""


def tour(evaluator: Evaluator, found: Evaluation) -> Evaluation | None:
    """A policy that leads into loops which meet all targets, one after the other; None where some state fails then.

    `found` says which states fail as yet. States from where no loop is reached keep their decisions.
    """
    problem = evaluator.problem
    if problem.goals_are_many or len(problem.targets) > MOST_TARGETS:
        return None
    alone = _one_by_one(problem)
    policy, open_ = found.closed_loop.policy, problem.steps.safe & found.failing
    while open_ != problem.false:
        problem.context.check()
        component = _last_component(problem, open_)
        loop = _loop(problem, component, alone)
        if loop is None:
            loop = _loop(problem, component, problem.steps.allowed)
        if loop is None:
            return None
        towards = _leading_to(problem, _leading_to(problem, loop, alone), problem.steps.allowed)
        policy = towards | (policy & ~problem.steps.states_of(towards))
        open_ = open_ & ~problem.steps.states_of(towards)
    evaluated = evaluator.evaluate(policy)
    return evaluated if evaluated.failing == problem.false else None


def _last_component(problem: Problem, starts: Bdd) -> Bdd:
    """States that all reach each other and nothing else, and that are reached from some of the starts."""
    step, safe = by_any_step(problem, problem.steps.allowed), problem.steps.safe
    while True:
        start = _first(problem, starts)
        reached = _reached(problem, start)
        back = problem.encoding.manager.union(attractor(problem, start, step, reached, None))
        if back == reached:
            return reached & safe
        starts = reached & ~back


def _reached(problem: Problem, start: Bdd) -> Bdd:
    """A set of safe states, and all that allowed steps make of them."""
    met, front = start, start
    while front != problem.false:
        problem.context.check()
        front = problem.steps.successors(problem.steps.allowed & front) & ~met
        met = met | front
    return met


def _one_by_one(problem: Problem) -> Bdd:
    """The allowed pairs of a single action: a policy of these does few different things, and is judged quickly."""
    encoding = problem.encoding
    singles = (encoding.choices_cube(frozenset((action,))) for action in range(len(encoding.spec.actions)))
    return problem.steps.allowed & encoding.manager.union(singles)


def _loop(problem: Problem, component: Bdd, pairs: Bdd) -> Bdd | None:
    """Pairs that make a loop which meets every target there is in some states; None where none was found.

    From each target it goes on to the nearest one that it has not met, through states where it has not been.
    """
    left = [target.states & component for target in problem.targets if (target.states & component) != problem.false]
    first = here = _first(problem, left[0] if left else component)
    free, decisions = component & ~here, problem.false
    left = [states for states in left if (states & here) == problem.false]
    while left:
        way = _way(problem, pairs, here, problem.encoding.manager.union(left) & free, free)
        if way is None:
            return None
        taken, here, passed = way
        decisions, free = decisions | taken, free & ~passed
        left = [states for states in left if (states & passed) == problem.false]
    back = _way(problem, pairs, here, first, free | first)
    return None if back is None else decisions | back[0]


def _way(problem: Problem, pairs: Bdd, start: Bdd, aim: Bdd, through: Bdd) -> tuple[Bdd, Bdd, Bdd] | None:
    """The decisions of a shortest way from a state to a set, where it ends, and all states after its first one."""
    layers, left = [aim], through & ~aim
    step = by_any_step(problem, pairs)
    while step(start, layers[-1]) == problem.false:
        problem.context.check()
        layer = step(left, layers[-1])
        if layer == problem.false:
            return None
        layers.append(layer)
        left = left & ~layer
    decisions, here, passed = problem.false, start, problem.false
    for layer in reversed(layers):
        pair = preferred(problem.encoding, pairs & here & problem.steps.before(layer))
        decisions, here = decisions | pair, problem.steps.successors(pair)
        passed = passed | here
    return decisions, here, passed


def _leading_to(problem: Problem, decisions: Bdd, pairs: Bdd) -> Bdd:
    """Some decisions, and those of some pairs by which other safe states come to them, in the fewest steps."""
    steps = problem.steps
    front = steps.states_of(decisions)
    left = steps.safe & ~front
    while front != problem.false:
        problem.context.check()
        nearer = preferred(problem.encoding, pairs & left & steps.before(front))
        front = steps.states_of(nearer)
        decisions, left = decisions | nearer, left & ~front
    return decisions


def _first(problem: Problem, states: Bdd) -> Bdd:
    """One of some states, as a set."""
    encoding = problem.encoding
    return encoding.state_cube(encoding.first_state(states))
