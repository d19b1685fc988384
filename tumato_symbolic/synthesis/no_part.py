"""The certificate that no part of the valid states which has all starts has a policy (`docs/certificate.md`)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Literal

from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.game import Layers, Problem
from tumato_symbolic.policy import RankedGoal, Vocabulary, minimized
from tumato_symbolic.policy.unrealizability import Case, Conflict, Divided, NoPart, Removal, StartRemoved
from tumato_symbolic.semantics import Residual
from tumato_symbolic.symbolic import Bdd, Extractor, one_by_one
from tumato_symbolic.synthesis.certificate import goal_names
from tumato_symbolic.synthesis.failing import Failing
from tumato_symbolic.synthesis.parts import Part, Search
from tumato_symbolic.synthesis.result import Unrealizable

MOST_CASES = 200
"""With more cases there is no certificate that no part has a policy."""

MOST_GOALS = 500
"""With more residual goals in one removal there is none either."""


class _TooMuchError(Exception):
    """There is no certificate of a reasonable size."""


def no_part(search: Search, whole: Part, starts: Bdd) -> NoPart | Conflict | None:
    """Why no part has all starts and a policy; None where that would be too large."""
    try:
        found = _Arguments(search, starts).of(whole)
    except _TooMuchError:
        return None
    first = found[0]
    return first.conflict if isinstance(first, Divided) and not first.removals and not first.cases else NoPart(found)


def failing_at_once(problem: Problem, failing: Failing) -> NoPart:
    """That no policy decides the first failing state, which has no plan."""
    encoding, steps = problem.encoding, problem.steps
    state = encoding.first_state(encoding.manager.union(failing.kinds.values()))
    alone = encoding.state_cube(state)
    pairs = alone & (steps.allowed if failing.way is None else failing.way.pairs)
    removal = _removal(problem, "no-plan", alone, steps.valid, [*_pending(problem, failing.apart, pairs)])
    return NoPart((StartRemoved((removal,), state),))


class _Arguments:
    """The argument about a part, and those about its cases, case by case."""

    def __init__(self, search: Search, starts: Bdd) -> None:
        self._search = search
        self._starts = starts

    def of(self, whole: Part) -> tuple[StartRemoved | Divided, ...]:
        """That about a part, and all others that it needs. Raises `_TooMuchError`."""
        found, waiting = list[StartRemoved | Divided](), [(whole, 0)]
        while len(found) < len(waiting):
            if len(waiting) > MOST_CASES:
                raise _TooMuchError
            part, known = waiting[len(found)]
            argument, smaller = self._argument(part, known, len(waiting))
            waiting += ((each, len(part.stages) + 1) for each in smaller)
            found.append(argument)
        return tuple(found)

    def _argument(self, part: Part, known: int, number: int) -> tuple[StartRemoved | Divided, list[Part]]:
        """That about one part, of which the first stages are `known` already; and its cases, numbered from there."""
        problem, removals = part.problem, list[Removal]()
        contains = problem.encoding.contains
        problem.context.check()
        for stage in part.stages[known:]:
            assert stage.failing is not None, "a conflict is a case of its own"
            removals += _removals(stage.problem, stage.failing)
            lost = self._starts & problem.encoding.manager.union(stage.kinds.values())
            if lost != problem.false:
                return StartRemoved(tuple(removals), problem.encoding.first_state(lost)), []
        conflict = self._conflict(part)
        states = [conflict.choices[start].state for start in conflict.starts]
        others = [state for state in states if not contains(self._starts, state)]
        cases = tuple(Case(state, place) for place, state in enumerate(others, number))
        return Divided(tuple(removals), conflict, cases), [self._search.without(part, state) for state in others]

    def _conflict(self, part: Part) -> Conflict:
        """The goals that conflict in a part."""
        result = self._search.result(part)
        reason = result.certificate.reason if isinstance(result, Unrealizable) and result.certificate else None
        if not isinstance(reason, Conflict):
            raise _TooMuchError
        return reason


def _removals(problem: Problem, failing: Failing) -> Iterator[Removal]:
    """The states that fail together: first those that cannot be restored, then, without these, the others."""
    false = problem.false
    lost = failing.kinds.get("no-restoration", false)
    if lost != false:
        yield _removal(problem, "no-restoration", lost, problem.steps.valid, [])
    states = problem.encoding.manager.union(failing.kinds.values()) & ~lost
    if states != false:
        pairs = states & (problem.steps.allowed if failing.way is None else failing.way.pairs)
        goals = list(islice(_pending(problem, failing.apart, pairs), MOST_GOALS + 1))
        if len(goals) > MOST_GOALS:
            raise _TooMuchError
        yield _removal(problem, "no-plan", states, problem.steps.valid & ~lost, goals)


def _pending(problem: Problem, apart: Sequence[Layers], pairs: Bdd) -> Iterator[tuple[Residual, Layers]]:
    """The residual goals of some pairs, each with the distances from it."""
    encoding = problem.encoding
    for every, layers in zip(problem.targets, apart, strict=True):
        for target, bits in one_by_one(encoding, every, pairs):
            distances = [encoding.manager.cofactor(layer, bits) for layer in layers]
            for residual, pending in target.residuals:
                if (pending & pairs) != problem.false:
                    yield residual, distances


def _removal(
    problem: Problem,
    kind: Literal["no-restoration", "no-plan"],
    states: Bdd,
    left: Bdd,
    goals: Sequence[tuple[Residual, Layers]],
) -> Removal:
    """The removal of some of the states that are `left`, with the distances from some goals.

    What the diagram says of other states is free, and chosen so that it is small.
    """
    deepest = max((len(layers) for _, layers in goals), default=1)
    builder: DiagramBuilder[int | None] = DiagramBuilder(problem.encoding.order, (None, *range(deepest)))
    extract = Extractor(problem.encoding, builder, default=None)
    ranked = [
        RankedGoal(*goal_names(problem.spec, residual), extract.function(list(enumerate(layers))))
        for residual, layers in goals
    ]
    ranked.sort(key=lambda goal: (goal.bodies, goal.executed))
    root = extract.function([(0, states)])
    whole: DiagramBuilder[bool] = DiagramBuilder(problem.encoding.order, (False, True))
    meant = Extractor(problem.encoding, whole, default=False).function([(True, left)])
    removal = Removal(kind, builder.finish(), root, tuple(ranked))
    return minimized(removal, Vocabulary.of(problem.spec).sizes, (whole.finish(), meant))
