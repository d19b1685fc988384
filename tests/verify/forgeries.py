"""Certificates of unrealizability, changed in every small way: each number by one, each part left out or repeated."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeVar

from msgspec.structs import replace

from tumato_symbolic.policy.unrealizability import (
    Choice,
    Conflict,
    Cut,
    NoAllowedSet,
    NoPlan,
    Reason,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import State

Entry = TypeVar("Entry")


def fewer(entries: tuple[Entry, ...]) -> Iterator[tuple[Entry, ...]]:
    """Each entry left out."""
    for place in range(len(entries)):
        yield entries[:place] + entries[place + 1 :]


def exchanged(entries: tuple[Entry, ...], place: int, entry: Entry) -> tuple[Entry, ...]:
    """Another entry at a place."""
    return (*entries[:place], entry, *entries[place + 1 :])


def cuts(reason: Conflict, states: list[State]) -> Iterator[Cut]:
    """Every cut with one thing changed."""
    for cut in reason.cuts:
        yield cut
        for goal in range(len(reason.goals)):
            yield replace(cut, goal=goal)
        for each in fewer(cut.states):
            if each:
                yield replace(cut, states=each)
        for place in range(len(cut.states)):
            yield replace(cut, states=(*cut.states[: place + 1], *cut.states[place:]))
            for other in range(len(reason.choices)):
                yield replace(cut, states=exchanged(cut.states, place, other))
        for state in states:
            yield replace(cut, kind="path", end=state)
        yield replace(cut, kind="path", end=None)
        yield replace(cut, kind="loop", end=None)


def conflicts(reason: Conflict, states: list[State]) -> Iterator[Conflict]:
    """Every conflict with one thing changed; its cuts are changed by `cuts`."""
    for starts in fewer(reason.starts):
        if starts:
            yield replace(reason, starts=starts)
    for each in fewer(reason.cuts):
        yield replace(reason, cuts=each)
    for place, choice in enumerate(reason.choices):
        for state in states[:3]:
            yield replace(reason, choices=exchanged(reason.choices, place, Choice(state, choice.options)))
        for options in fewer(choice.options):
            yield replace(reason, choices=exchanged(reason.choices, place, Choice(choice.state, options)))
        for option, (after, goal) in enumerate(choice.options):
            others = [(state, goal) for state in states[:3]] + [(after, other) for other in range(len(reason.goals))]
            for changed_option in others:
                changed = Choice(choice.state, exchanged(choice.options, option, changed_option))
                yield replace(reason, choices=exchanged(reason.choices, place, changed))
    for place, leaf in enumerate(reason.distances.leaves):
        for distance in (None, 0) if leaf is None else (None, leaf + 1, max(0, leaf - 1)):
            if distance not in reason.distances.leaves:
                leaves = exchanged(reason.distances.leaves, place, distance)
                yield replace(reason, distances=replace(reason.distances, leaves=leaves))
    for node, (level, below) in enumerate(reason.distances.nodes):
        for place in range(len(below)):
            for leaf in range(len(reason.distances.leaves)):
                nodes = exchanged(reason.distances.nodes, node, (level, exchanged(below, place, leaf)))
                yield replace(reason, distances=replace(reason.distances, nodes=nodes))
    for place, ranked in enumerate(reason.goals):
        for same in reason.goals:
            yield replace(reason, goals=exchanged(reason.goals, place, replace(ranked, root=same.root)))


def plans(reason: NoPlan, states: list[State]) -> Iterator[NoPlan]:
    """Every certificate of layers with one thing changed."""
    for state in states:
        yield replace(reason, state=state)
    for goals in fewer(reason.goals):
        yield replace(reason, goals=goals)
    for place, goal in enumerate(reason.goals):
        for roots in (
            *fewer(goal.roots),
            (*goal.roots, goal.roots[-1]),
            (goal.roots[0], *goal.roots),
            goal.roots[::-1],
        ):
            yield replace(reason, goals=exchanged(reason.goals, place, replace(goal, roots=roots)))
        for number in range(len(goal.roots)):
            for root in range(2 + len(reason.diagram.nodes)):
                roots = exchanged(goal.roots, number, root)
                yield replace(reason, goals=exchanged(reason.goals, place, replace(goal, roots=roots)))
    for node, (level, below) in enumerate(reason.diagram.nodes):
        for place in range(len(below)):
            for leaf in (0, 1):
                nodes = exchanged(reason.diagram.nodes, node, (level, exchanged(below, place, leaf)))
                yield replace(reason, diagram=replace(reason.diagram, nodes=nodes))


def cubes(reason: NoAllowedSet, states: list[State], actions: int) -> Iterator[NoAllowedSet]:
    """Every certificate of cubes with one thing changed."""
    for state in states:
        yield replace(reason, state=state)
        yield replace(reason, state=state, cubes=None)
    if reason.cubes is None:
        return
    for each in fewer(reason.cubes):
        yield replace(reason, cubes=each)
    for place, cube in enumerate(reason.cubes):
        yield replace(reason, cubes=(*reason.cubes, cube))
        changed = [
            replace(cube, executed=cube.executed ^ {action}, idle=idle)
            for action in range(actions)
            for idle in (cube.idle, cube.idle ^ {action})
        ]
        changed += [replace(cube, idle=cube.idle ^ {action}) for action in range(actions)]
        changed += [replace(cube, violation=other) for other in violations(cube.violation, actions)]
        for other in changed:
            yield replace(reason, cubes=exchanged(reason.cubes, place, other))


def violations(given: Violation, actions: int, rules: Sequence[str] = ()) -> Iterator[Violation]:
    """Every other condition that a cube may name, and the one that it names a little changed."""
    yield Violation("idle")
    yield Violation("nominal-unsafe")
    for one in range(actions):
        yield Violation("precondition", (one,))
        for other in range(actions):
            yield Violation("precondition", (one, other))
            yield Violation("resource", (one, other))
            yield Violation("nominal-conflict", (other, one))
            yield Violation("resource", (one, other, (other + 1) % actions))
    for rule in (*rules, "executing nobody"):
        yield Violation("reaction-rule", rule=rule)
    for outcome in (*fewer(given.outcome), given.outcome[::-1], given.outcome * 2):
        yield replace(given, kind="unsafe", outcome=outcome)


def forged(certificate: Unrealizability, states: list[State]) -> Iterator[Unrealizability]:
    """The certificate with one thing changed, in every small way."""
    match certificate.reason:
        case NoAllowedSet() as reason:
            found: Iterator[Reason] = cubes(reason, states, len(certificate.vocabulary.actions))
        case NoPlan() as reason:
            found = plans(reason, states)
        case Conflict() as reason:
            found = conflicts(reason, states)
    for each in found:
        yield replace(certificate, reason=each)
