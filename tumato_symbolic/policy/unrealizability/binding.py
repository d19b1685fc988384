"""A certificate of unrealizability in the numbers of a specification."""

from __future__ import annotations

from dataclasses import replace

from tumato_symbolic.policy.decisions import Renumbering
from tumato_symbolic.policy.records import RankedGoal, Vocabulary
from tumato_symbolic.policy.unrealizability.records import (
    Choice,
    Conflict,
    Cube,
    Cut,
    NoAllowedSet,
    NoPlan,
    NoRestoration,
    Unrealizability,
)
from tumato_symbolic.spec import Spec


def bind(certificate: Unrealizability, spec: Spec) -> Unrealizability:
    """The same certificate, renumbered so that its vocabulary is that of `spec`.

    Raises `UserError` with (at most 20 of) the names that only one side has (TUM503, TUM504, TUM505).
    """
    target = Vocabulary.of(spec)
    by = Renumbering.between(certificate.vocabulary, target, "certificate")
    match certificate.reason:
        case NoAllowedSet(state, cubes):
            bound = None if cubes is None else tuple(_bound_cube(cube, by) for cube in cubes)
            return replace(certificate, vocabulary=target, reason=NoAllowedSet(by.state(state), bound))
        case NoRestoration(state, diagram, root):
            diagram, (root,) = by.diagram(diagram, [root])
            return replace(certificate, vocabulary=target, reason=NoRestoration(by.state(state), diagram, root))
        case NoPlan() as no_plan:
            return replace(certificate, vocabulary=target, reason=_bound_plan(no_plan, by))
        case Conflict() as conflict:
            return replace(certificate, vocabulary=target, reason=_bound_conflict(conflict, by))


def _bound_cube(cube: Cube, by: Renumbering) -> Cube:
    violation = cube.violation
    effects = tuple((by.actions[action], by.assignment(effect)) for action, effect in violation.outcome)
    actions = tuple(by.actions[action] for action in violation.actions)
    return Cube(
        by.action_set(cube.executed), by.action_set(cube.idle), replace(violation, actions=actions, outcome=effects)
    )


def _bound_plan(reason: NoPlan, by: Renumbering) -> NoPlan:
    return replace(reason, state=by.state(reason.state)).drawn(*by.diagram(reason.diagram, reason.roots))


def _bound_conflict(reason: Conflict, by: Renumbering) -> Conflict:
    diagram, roots = by.diagram(reason.distances, [goal.root for goal in reason.goals])
    return Conflict(
        reason.starts,
        tuple(
            Choice(by.state(choice.state), tuple((by.state(after), goal) for after, goal in choice.options))
            for choice in reason.choices
        ),
        tuple(
            Cut(cut.kind, cut.goal, cut.states, None if cut.end is None else by.state(cut.end)) for cut in reason.cuts
        ),
        diagram,
        tuple(RankedGoal(goal.bodies, goal.executed, root) for goal, root in zip(reason.goals, roots, strict=True)),
    )
