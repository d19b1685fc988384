"""A certificate of unrealizability in the numbers of a specification."""

from __future__ import annotations

from msgspec.structs import replace

from tumato_symbolic.policy.decisions import Renumbering
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.unrealizability.records import (
    Choice,
    Conflict,
    Cube,
    Divided,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    StartRemoved,
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
        case NoRestoration() | NoPlan() as reason:
            bound_reason = by.drawn(replace(reason, state=by.state(reason.state)))
            return replace(certificate, vocabulary=target, reason=bound_reason)
        case Conflict() as conflict:
            return replace(certificate, vocabulary=target, reason=_bound_conflict(conflict, by))
        case NoPart(parts):
            bound_parts = tuple(_bound_part(part, by) for part in parts)
            return replace(certificate, vocabulary=target, reason=NoPart(bound_parts))


def _bound_cube(cube: Cube, by: Renumbering) -> Cube:
    violation = cube.violation
    effects = tuple((by.actions[action], by.assignment(effect)) for action, effect in violation.outcome)
    actions = tuple(by.actions[action] for action in violation.actions)
    return Cube(
        by.action_set(cube.executed), by.action_set(cube.idle), replace(violation, actions=actions, outcome=effects)
    )


def _bound_conflict(reason: Conflict, by: Renumbering) -> Conflict:
    choices = tuple(
        Choice(
            by.state(choice.state),
            tuple((by.state(after), goal) for after, goal in choice.options),
            tuple(tuple(map(by.state, outcomes)) for outcomes in choice.outcomes),
        )
        for choice in reason.choices
    )
    cuts = tuple(replace(cut, end=None if cut.end is None else by.state(cut.end)) for cut in reason.cuts)
    return by.drawn(replace(reason, choices=choices, cuts=cuts))


def _bound_part(part: StartRemoved | Divided, by: Renumbering) -> StartRemoved | Divided:
    removals = tuple(map(by.drawn, part.removals))
    if isinstance(part, StartRemoved):
        return StartRemoved(removals, by.state(part.state))
    cases = tuple(replace(case, state=by.state(case.state)) for case in part.cases)
    return Divided(removals, _bound_conflict(part.conflict, by), cases)
