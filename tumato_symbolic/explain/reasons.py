"""The stage that finds reasons, the larger first: cores, and all failing states that have them in common."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.explain.conflicts import conflict_core, conflicting
from tumato_symbolic.explain.cores import Cause, causes, core_finder, element_list, more_cores
from tumato_symbolic.explain.elements import Element, Elements
from tumato_symbolic.explain.explanation import Explanation, Reason
from tumato_symbolic.explain.failing_states import shortest_plan
from tumato_symbolic.explain.summary import summary
from tumato_symbolic.explain.unmet_goals import own_goals
from tumato_symbolic.explain.work import Work

MAX_CAUSES = 1_000
"""So many different reasons are looked for at most."""


def reasons_found(work: Work, found: Explanation) -> Iterator[Explanation]:
    """Every reason as it is found; reasons of larger cubes of states come first."""
    if found.groups[0].kind == "conflict":
        work.context.tell("cores: 1 of 1, of the conflict")
        yield replace(found, reasons=(_conflict(work, found),))
        return
    found, left = replace(found, omitted=found.failing_states), work.max_cubes
    _tell(work, found)
    for cause in causes(work.oracle, work.failing):
        reason = _reason(work, cause, left)
        left -= len(reason.cubes)
        found = replace(found, reasons=(*found.reasons, reason), omitted=found.omitted - reason.count)
        yield found
        if len(found.reasons) == MAX_CAUSES:
            break
        _tell(work, found)
    yield found


def _tell(work: Work, found: Explanation) -> None:
    number, told = len(found.reasons) + 1, found.failing_states - found.omitted
    work.context.tell(f"cores: reason {number}, {told:,} of {found.failing_states:,} failing states explained")


def _reason(work: Work, cause: Cause, limit: int) -> Reason:
    requirements, example = work.requirements, cause.example
    shown = more_cores(requirements, cause.core, work.cores, core_finder(work.oracle, cause))
    bounded = Element("plan-bound") in cause.core and not cause.later
    cover = work.cubes(cause.states, limit)
    return Reason(
        cause.kind,
        work.count(cause.states),
        cover.cubes,
        work.count(cover.rest),
        example,
        tuple(element_list(requirements, core) for core in shown),
        () if cause.kind != "no-plan" else own_goals(requirements, example),
        shortest_plan=shortest_plan(requirements, requirements.encoding.state_cube(example)) if bounded else None,
        summary=None if cause.later else summary(requirements, cause.core, cause.states, example),
        later=cause.later,
    )


def _conflict(work: Work, found: Explanation) -> Reason:
    group = found.groups[0]
    cores = tuple(element_list(work.requirements, core) for core in _conflict_cores(work))
    return Reason(group.kind, group.count, group.cubes, group.omitted, group.example, cores, together=group.together)


def _conflict_cores(work: Work) -> tuple[Elements, ...]:
    requirements, states = work.requirements, work.states_of("conflict")
    together = work.outcome.failures[0].states

    def find(among: Elements) -> Elements | None:
        return conflict_core(requirements, together, among) if conflicting(requirements, states, among) else None

    first = conflict_core(requirements, together, requirements.everything)
    return more_cores(requirements, first, work.cores, find)
