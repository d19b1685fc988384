"""Parts of the valid states that a policy may decide: closed, and without states that fail (section 12)."""

from __future__ import annotations

import heapq
from collections.abc import Callable

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.game import OwnRegions, Problem, only_region, with_goals
from tumato_symbolic.policy import formula_of
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import Formula
from tumato_symbolic.symbolic import Bdd, Encoding, Extractor, build_steps
from tumato_symbolic.synthesis.failing import Failing, failing_states, failures_of
from tumato_symbolic.synthesis.result import Failure, FailureKind, Realizable, SynthesisResult, Undecided

PARTS = 200
"""So many parts are tried at most where goals conflict."""

Solve = Callable[[Problem, Undecided, OwnRegions | None], SynthesisResult]
"""A policy for all valid states of a problem, or why there is none; the policy of the own regions may be known."""


class Stage(Struct, frozen=True):
    """States that were left out together, by why they fail where only the valid states of `problem` may be met.

    `failing` has more of that; it is None where goals conflict.
    """

    problem: Problem
    kinds: dict[FailureKind, Bdd]
    failing: Failing | None = None


class Part(Struct, frozen=True):
    """A closed part of the valid states in which none fails, as a problem, and what was left out before.

    `own` is the policy of its own regions, where that was found on the way.
    """

    problem: Problem
    stages: tuple[Stage, ...]
    own: OwnRegions | None = None

    @property
    def states(self) -> Bdd:
        """The states of the part."""
        return self.problem.steps.valid

    def left_out(self, states: Bdd) -> tuple[Failure, ...]:
        """Those of some states that are left out, by why they fail, each kind with where its example does."""
        problem, union = self.problem, self.problem.encoding.manager.union
        kinds = dict.fromkeys(kind for stage in self.stages for kind in stage.kinds)
        together = {kind: states & union(s.kinds[kind] for s in self.stages if kind in s.kinds) for kind in kinds}
        return tuple(replace(each, within=self._where(each)) for each in failures_of(problem, together))

    def _where(self, failure: Failure) -> Formula | None:
        """Where the example of a failure fails; None where that is among all valid states."""
        encoding = self.problem.encoding
        for number, stage in enumerate(self.stages):
            if failure.kind in stage.kinds and encoding.contains(stage.kinds[failure.kind], failure.example):
                return _formula(encoding, stage.problem.steps.valid) if number else None
        return None


def _formula(encoding: Encoding, states: Bdd) -> Formula:
    builder = DiagramBuilder[bool](encoding.order, (False, True))
    root = Extractor(encoding, builder, default=False).function([(True, states)])
    return formula_of(builder.finish(), root)


def greatest(whole: Problem, problem: Problem, stages: tuple[Stage, ...]) -> Part:
    """The greatest closed part of the valid states of a problem in which none fails; `whole` has all valid states.

    Those that fail are left out, then those that fail without them, and so on. Where the others lose no step by that,
    what they can do alone is what they could before: none of them fails.
    """
    own: OwnRegions | None = None
    while problem.steps.valid != problem.false:
        own = only_region(problem)
        failing = failing_states(problem, own)
        if not failing.kinds:
            break
        problem.context.check()
        stages, before = (*stages, Stage(problem, failing.kinds, failing)), problem
        problem = _within(whole, before.steps.valid & ~whole.encoding.manager.union(failing.kinds.values()))
        if problem.steps.allowed == before.steps.allowed & problem.steps.valid:
            own = own and own.within(problem.steps.safe)
            break
        own = None
    return Part(problem, stages, own)


def _within(whole: Problem, states: Bdd) -> Problem:
    """The problem where only these states are valid."""
    return with_goals(build_steps(whole.encoding, whole.encoding.spec, whole.steps.ordering, states))


class Search:
    """The search for a part that a policy serves, where goals conflict in the greatest one.

    `blamed` are starts that no policy serves together, once there is no such part.
    """

    def __init__(self, problem: Problem, so_far: Undecided, solve: Solve) -> None:
        self._problem = problem
        self._so_far = so_far
        self._solve = solve
        self._tried: dict[Bdd, SynthesisResult] = {}
        self.blamed: dict[State, None] = {}

    def first(self, whole: Part, starts: Bdd) -> tuple[Part, Realizable] | Undecided | None:
        """The largest part with these starts, and the policy; None where there is none."""
        problem, encoding = self._problem, self._problem.encoding
        waiting, seen = [(0, 0, whole)], {whole.states}
        while waiting:
            part = heapq.heappop(waiting)[2]
            result = self.result(part)
            if isinstance(result, Realizable):
                return part, result
            if isinstance(result, Undecided):
                return result
            for state in result.failures[0].states:
                if encoding.contains(starts, state):
                    self.blamed[state] = None
                    continue
                smaller = self.without(part, state)
                lost = starts & ~smaller.states
                if lost != problem.false:
                    self.blamed[encoding.first_state(lost)] = None
                elif smaller.states not in seen:
                    seen.add(smaller.states)
                    heapq.heappush(waiting, (-encoding.count_states(smaller.states), len(seen), smaller))
        return None

    def without(self, part: Part, state: State) -> Part:
        """The greatest part without a state, where a conflict has it left out."""
        alone = self._problem.encoding.state_cube(state)
        stages = (*part.stages, Stage(part.problem, {"conflict": alone}))
        return greatest(self._problem, _within(self._problem, part.states & ~alone), stages)

    def result(self, part: Part) -> SynthesisResult:
        """A policy for a part, or why there is none."""
        if part.states not in self._tried:
            if len(self._tried) == PARTS:
                limit = f"{PARTS} parts of the states did not settle how the goals interact"
                return replace(self._so_far, limit=limit)
            self._tried[part.states] = self._solve(part.problem, self._so_far, part.own)
        return self._tried[part.states]

    def minimal(self, whole: Part, blamed: list[State]) -> tuple[State, ...]:
        """Those of the blamed starts that still cannot be served together: each in turn is left out, if that may be."""
        encoding = self._problem.encoding
        needed, open_ = list[State](), sorted(blamed)
        while open_:
            rest = [*needed, *open_[1:]]
            if not rest or self.first(whole, encoding.manager.union(map(encoding.state_cube, rest))) is not None:
                needed.append(open_[0])
            open_ = open_[1:]
        return tuple(needed)
