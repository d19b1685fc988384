"""The pipeline of an explanation why there is no policy, and which part of the time each stage may take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, TypeAlias

from msgspec.structs import replace

from tumato_symbolic.explain.as_predicates import predicate_text
from tumato_symbolic.explain.explanation import (
    STAGES,
    Explanation,
    FailingGroup,
    Found,
    LeftOut,
    NothingToExplain,
    RealizablePart,
    Stage,
    Unexplained,
    Wanted,
    so_far,
    stopped,
)
from tumato_symbolic.explain.near_misses import near_misses
from tumato_symbolic.explain.realizable_part import largest_part
from tumato_symbolic.explain.reasons import reasons_found
from tumato_symbolic.explain.repairs import repairs_found
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.work import Work
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import Backend, available_backend
from tumato_symbolic.synthesis import Realizable, Undecided, Unrealizable, synthesize

MAX_CUBES = 1_000
"""So many cubes of failing states are listed where nothing else is asked for."""

REPAIRS = 3
"""So many ways to change lines are looked for where nothing else is asked for."""

NEAR_MISSES = 3
"""So many sets that come near to being allowed are told of each reason."""

_SHARES: Final[dict[Stage, float]] = {"states": 0.25, "part": 0.35, "reasons": 0.5, "near": 0.2, "repairs": 0.95}
"""The part of the time that is left which a stage may take, so that there is some for those behind it."""

_Run: TypeAlias = Callable[[Work, Explanation], Iterator[Explanation]]
"""A stage: from what is known to what is known then, with every step between that is worth telling."""


def explain(
    spec: Spec,
    ordering: Ordering | None = None,
    *,
    max_cubes: int = MAX_CUBES,
    cores: int = 1,
    wanted_repairs: Wanted = REPAIRS,
    backend: Backend | None = None,
    context: Context | None = None,
) -> Found:
    """Why `spec` has no policy: all failing states by reason, repairs, and the largest realizable part.

    `max_cubes` caps each list of cubes, `cores` is how many cores each reason gets, `wanted_repairs` how many ways to
    change lines are looked for. Raises `UserError` where no state is valid.
    """
    *_, found = explained(
        spec,
        ordering,
        max_cubes=max_cubes,
        cores=cores,
        wanted_repairs=wanted_repairs,
        backend=backend,
        context=context,
    )
    return found


def explained(
    spec: Spec,
    ordering: Ordering | None = None,
    *,
    max_cubes: int = MAX_CUBES,
    cores: int = 1,
    wanted_repairs: Wanted = REPAIRS,
    backend: Backend | None = None,
    context: Context | None = None,
) -> Iterator[Found]:
    """What `explain` returns, again and again as more of it is known: the last one is all that limits allow."""
    context = context or Context()
    ordering, backend = ordering or spec.ordering, backend or available_backend()
    outcome = synthesize(spec, ordering, backend=backend, context=context.within(), certify=False)
    if isinstance(outcome, Realizable):
        yield NothingToExplain(outcome.statistics)
        return
    if isinstance(outcome, Undecided):
        yield Unexplained(outcome.limit, outcome.statistics)
        return
    known = _verdict(spec, ordering, outcome)
    yield known
    try:
        context.tell("encoding what every line requires")
        requirements = Requirements(spec, ordering, backend, context)
    except LimitReachedError as limit:
        yield stopped(known, str(limit))
        return
    work = Work(requirements, context, outcome, max_cubes, cores, wanted_repairs)
    for stage in STAGES:
        for more in _within_its_share(work, known, stage):
            known = more
            yield known


def _verdict(spec: Spec, ordering: Ordering, outcome: Unrealizable) -> Explanation:
    """That there is no policy, and how many states fail."""
    groups = tuple(
        FailingGroup(each.kind, each.count, (), each.count, each.example, each.states)
        if each.kind == "conflict"
        else FailingGroup(each.kind, each.count, (), each.count, each.example)
        for each in outcome.failures
    )
    failing = sum(group.count for group in groups if group.kind != "conflict")
    return Explanation(spec, ordering, outcome.statistics, failing, groups, restorability=outcome.restorability)


def _within_its_share(work: Work, found: Explanation, stage: Stage) -> Iterator[Explanation]:
    """What a stage adds, until its share of the time is used up."""
    known = found
    try:
        with work.within(_SHARES[stage]):
            for more in _RUNS[stage](work, found):
                known = more
                yield known
        if not known.is_over(stage):
            known = replace(known, finished=(*known.finished, stage))
    except LimitReachedError as limit:
        why = str(limit) if work.context.is_over else work.share_met()
        known = replace(known, left_out=(*known.left_out, LeftOut(stage, so_far(known, stage), why)))
    yield known


def _states(work: Work, found: Explanation) -> Iterator[Explanation]:
    """The failing states as cubes."""
    groups, left = [], work.max_cubes
    for number, group in enumerate(found.groups):
        work.context.tell(f"listing the failing states: group {number + 1} of {len(found.groups)}")
        states = work.states_of(group.kind)
        cover = work.cubes(states, left)
        left -= len(cover.cubes)
        example = group.example if group.kind == "conflict" else work.typical(states)
        omitted = work.count(cover.rest)
        groups.append(replace(group, cubes=cover.cubes, omitted=omitted, example=example))
    yield replace(found, groups=tuple(groups))


def _part(work: Work, found: Explanation) -> Iterator[Explanation]:
    """The largest realizable part."""
    requirements = work.requirements
    work.context.tell("looking for the largest realizable part")
    part = largest_part(requirements)
    if part is not None:
        given_up = work.count(requirements.starts) - part.count
        text = predicate_text(requirements.spec, part.formula)
        numbers = part.count, given_up
        less = part.steady
        steady = None if less is None else (less.count, predicate_text(requirements.spec, less.formula))
        known = RealizablePart(*numbers, part.formula, text, part.unique, part.largest, part.environment, steady)
        yield replace(found, part=known)


def _near(work: Work, found: Explanation) -> Iterator[Explanation]:
    """What comes near in the examples of states without an allowed set."""
    reasons, passed_over = list(found.reasons), 0
    stuck = [n for n, reason in enumerate(reasons) if reason.kind == "no-allowed-set" and not reason.later]
    for place, number in enumerate(stuck):
        work.context.tell(f"looking for what comes near: reason {place + 1} of {len(stuck)}")
        work.requirements.manager.context.check()
        nearest = near_misses(found.spec, reasons[number].example, found.ordering, NEAR_MISSES)
        passed_over += nearest.passed_over
        reasons[number] = replace(reasons[number], near=nearest.misses)
        yield (found := replace(found, reasons=tuple(reasons)))
    if passed_over:
        why = "sets with too many outcomes were passed over"
        yield replace(found, left_out=(*found.left_out, LeftOut("near", f"{passed_over} were not looked at", why)))


_RUNS: Final[dict[Stage, _Run]] = {
    "states": _states,
    "part": _part,
    "reasons": reasons_found,
    "near": _near,
    "repairs": repairs_found,
}
