"""From a specification to the explanation why it has no policy: the pipeline."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from tumato_symbolic.explain.conditions import Conditions
from tumato_symbolic.explain.conflicts import conflict_core, served_together
from tumato_symbolic.explain.cores import (
    Cause,
    Failing,
    causes,
    core_finder,
    element_list,
    failing_states,
    more_cores,
)
from tumato_symbolic.explain.cubes import Cover, StateCube, disjoint_cubes, set_of
from tumato_symbolic.explain.elements import Element, Elements
from tumato_symbolic.explain.explanation import (
    Change,
    Explanation,
    NothingToExplain,
    RealizablePart,
    Reason,
    Repair,
    Unexplained,
)
from tumato_symbolic.explain.near import near_misses
from tumato_symbolic.explain.part import largest_part
from tumato_symbolic.explain.plans import shortest_plan
from tumato_symbolic.explain.predicates import predicate_text
from tumato_symbolic.explain.repairs import repairs
from tumato_symbolic.explain.unmet import own_goals
from tumato_symbolic.explain.weaken import weakening
from tumato_symbolic.limits import Context
from tumato_symbolic.semantics import State, count_states
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.symbolic import Backend, Bdd, available_backend
from tumato_symbolic.synthesis import Failure, Realizable, Statistics, Undecided, Unrealizable, synthesize
from tumato_symbolic.synthesis.repair import RoundsExhaustedError

MAX_CAUSES = 1_000
"""So many different reasons are looked for at most."""

MAX_CUBES = 1_000
"""So many cubes are listed where nothing else is asked for."""

NEAR_MISSES = 3
"""So many sets that come near to being allowed are told of each reason."""

MOST_WEAKENED = 3
"""A repair of more elements is not one that anybody would make line by line."""


def explain(
    spec: Spec,
    ordering: Ordering | None = None,
    *,
    max_cubes: int = MAX_CUBES,
    cores: int = 1,
    wanted_repairs: int = 3,
    backend: Backend | None = None,
    context: Context | None = None,
) -> Explanation | NothingToExplain | Unexplained:
    """Why `spec` has no policy: all failing states by reason, repairs, and the largest realizable part.

    `max_cubes` caps the list of cubes, `cores` is how many cores each reason gets, `wanted_repairs` how many ways to
    drop elements are looked for. Raises `UserError` where no state is valid.
    """
    context = context or Context()
    tell = context.tell
    tell("encoding states and steps")
    conditions = Conditions(spec, ordering or spec.ordering, backend or available_backend())
    failing = failing_states(conditions)
    if (failing.no_allowed_set | failing.no_plan) == conditions.false:
        tell("synthesizing")
        outcome = synthesize(spec, conditions.ordering, backend=conditions.manager.backend)
        if isinstance(outcome, Realizable):
            return NothingToExplain(outcome.statistics)
        if isinstance(outcome, Undecided):
            return Unexplained(outcome.limit, _statistics(conditions))
        tell("explaining the conflict")
        found: tuple[Reason, ...] = (_conflict(conditions, outcome, max_cubes, cores),)
        omitted = 0
    else:
        tell("explaining the failing states")
        found, omitted = _reasons(conditions, failing, max_cubes, cores)
    count = conditions.encoding.count_states
    tell("looking for repairs")
    mended = repairs(conditions, [frozenset(reason.core) for reason in found], wanted_repairs)
    tell("looking for the largest realizable part")
    return Explanation(
        spec,
        conditions.ordering,
        _statistics(conditions),
        count(failing.no_allowed_set) + count(failing.no_plan),
        found,
        omitted,
        tuple(_with_weakenings(conditions, mended.found)),
        mended.complete,
        mended.hopeless,
        _part(conditions),
    )


def _statistics(conditions: Conditions) -> Statistics:
    count = conditions.encoding.count_states
    rules = conditions.encoding.all_of(rule.formula for rule in conditions.spec.state_rules)
    valid, safe = count(conditions.valid), count(conditions.valid & rules)
    backend = conditions.manager.backend
    return Statistics(count_states(conditions.spec), valid, safe, valid - safe, None, backend, conditions.ordering)


def _reasons(conditions: Conditions, failing: Failing, max_cubes: int, cores: int) -> tuple[tuple[Reason, ...], int]:
    """The reasons, the largest first, and how many failing states have one that was not looked for."""
    count = conditions.encoding.count_states
    found = list(islice(causes(conditions, failing), MAX_CAUSES))
    found.sort(key=lambda cause: -count(cause.states))
    explained = conditions.manager.union(cause.states for cause in found)
    omitted = count((failing.no_allowed_set | failing.no_plan) & ~explained)
    covered = _covered(conditions, found, max_cubes)
    return tuple(_reason(conditions, cause, cover, cores) for cause, cover in covered), omitted


def _covered(conditions: Conditions, found: list[Cause], max_cubes: int) -> Iterator[tuple[Cause, Cover]]:
    left = max_cubes
    for cause in found:
        cover = cubes_of(conditions, cause.states, left)
        left -= len(cover.cubes)
        yield cause, cover


def cubes_of(conditions: Conditions, states: Bdd, limit: int) -> Cover:
    """Disjoint cubes of valid states, the largest first."""
    encoding = conditions.encoding
    cover = disjoint_cubes(encoding, states, encoding.domain() & ~conditions.valid, limit)

    def size(cube: StateCube) -> int:
        return encoding.count_states(states & set_of(encoding, cube))

    return Cover(tuple(sorted(cover.cubes, key=lambda cube: -size(cube))), cover.rest)


def _reason(conditions: Conditions, cause: Cause, cover: Cover, cores: int) -> Reason:
    count = conditions.encoding.count_states
    spec, example = conditions.spec, cause.example
    shown = more_cores(conditions, cause.core, cores, core_finder(conditions, cause))
    stuck = cause.kind == "no-allowed-set"
    bounded = Element("plan-bound") in cause.core
    return Reason(
        cause.kind,
        count(cause.states),
        cover.cubes,
        count(cover.rest),
        example,
        tuple(element_list(conditions, core) for core in shown),
        () if stuck else own_goals(conditions, example),
        near_misses(spec, example, conditions.ordering, NEAR_MISSES).misses if stuck else (),
        shortest_plan=shortest_plan(conditions, conditions.encoding.state_cube(example)) if bounded else None,
    )


def _conflict(conditions: Conditions, outcome: Unrealizable, max_cubes: int, cores: int) -> Reason:
    failure: Failure = outcome.failures[0]
    states = conditions.manager.union(map(conditions.encoding.state_cube, failure.states))
    cover = cubes_of(conditions, states, max_cubes)
    count = conditions.encoding.count_states
    shown = _conflict_cores(conditions, failure.states, states, cores)
    return Reason(
        "conflict",
        failure.count,
        cover.cubes,
        count(cover.rest),
        failure.example,
        tuple(element_list(conditions, core) for core in shown),
        together=failure.states,
    )


def _conflict_cores(
    conditions: Conditions, together: tuple[State, ...], states: Bdd, cores: int
) -> tuple[Elements, ...]:
    """Cores of a conflict; where the question is too hard, everything is to blame."""
    try:
        first = conflict_core(conditions, together, conditions.everything)
    except RoundsExhaustedError:
        return (conditions.everything,)

    def find(among: Elements) -> Elements | None:
        return None if served_together(conditions, states, among) else conflict_core(conditions, together, among)

    return more_cores(conditions, first, cores, find)


def _with_weakenings(conditions: Conditions, found: tuple[Elements, ...]) -> Iterator[Repair]:
    """Every repair as it is; single elements, and the first repair, if it is small, also weakened."""
    for number, dropped in enumerate(found):
        yield Repair(tuple(Change(element, None) for element in element_list(conditions, dropped)))
        worth_it = len(dropped) <= (MOST_WEAKENED if number == 0 else 1)
        weaker = weakening(conditions, dropped) if worth_it else None
        if weaker is not None:
            texts: dict[Element, str | None] = {edit.element: edit.text for edit in weaker.edits}
            yield Repair(tuple(Change(each, texts.get(each)) for each in element_list(conditions, dropped)))


def _part(conditions: Conditions) -> RealizablePart | None:
    found = largest_part(conditions)
    if found is None:
        return None
    return RealizablePart(
        found.count,
        conditions.encoding.count_states(conditions.valid) - found.count,
        found.formula,
        predicate_text(conditions.spec, found.formula),
        found.unique,
        found.largest,
    )
