"""Policies from the starts: the part of the valid states that is decided (`docs/semantics.md`, section 12).

A part is *closed* when no step leaves it. The greatest part in which no state fails holds every other one that a policy
may decide. Where goals conflict in it, each of these leaves out a state of the conflict: the larger ones are tried
first.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import count, listed
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.game import Problem, with_goals
from tumato_symbolic.policy import formula_of
from tumato_symbolic.semantics import State, named
from tumato_symbolic.semantics.lint import no_start
from tumato_symbolic.spec import Formula
from tumato_symbolic.symbolic import Bdd, Encoding, Extractor, build_steps
from tumato_symbolic.synthesis.failing import failing_states, failures_of, reason_of
from tumato_symbolic.synthesis.result import (
    DecidedPart,
    Failure,
    FailureKind,
    Realizable,
    SynthesisResult,
    Undecided,
    Unrealizable,
)

PARTS = 200
"""So many parts are tried at most where goals conflict."""

Solve = Callable[[Problem, Undecided], SynthesisResult]
"""A policy for all valid states of a problem, or why there is none."""


@dataclass(frozen=True)
class _Stage:
    """States that were left out together, by why they fail where only the states in `within` may be met."""

    within: Bdd
    kinds: dict[FailureKind, Bdd]


@dataclass(frozen=True)
class _Part:
    """A closed part of the valid states in which none fails, as a problem, and what was left out before."""

    problem: Problem
    stages: tuple[_Stage, ...]

    @property
    def states(self) -> Bdd:
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
                return _formula(encoding, stage.within) if number else None
        return None


def _formula(encoding: Encoding, states: Bdd) -> Formula:
    builder = DiagramBuilder[bool](encoding.order, (False, True))
    root = Extractor(encoding, builder, default=False).function([(True, states)])
    return formula_of(builder.finish(), root)


def solve_from_starts(problem: Problem, so_far: Undecided, solve: Solve, *, certify: bool) -> SynthesisResult:
    """A policy for the largest part of the valid states that has all starts, or why there is none.

    With `certify`, that is with a certificate where a start fails at once: without starts it would fail as well.
    """
    starts = problem.steps.valid & problem.encoding.formula(problem.spec.start)
    if starts == problem.false:
        raise UserError((no_start(problem.spec),))
    problem.context.tell("finding what can be decided")
    whole = _greatest(problem, problem, ())
    assert so_far.statistics is not None, "states are counted first"
    so_far = replace(so_far, statistics=replace(so_far.statistics, part=_counted(whole, starts)))
    if failures := whole.left_out(starts):
        answer = _unrealizable(so_far, failures)
        problem.context.learn(answer)
        return _certified(problem, answer, starts) if certify else answer
    problem.context.learn(so_far)
    search = _Search(problem, so_far, solve)
    found = search.first(whole, starts)
    if found is None:
        states = search.minimal(whole, [*search.blamed])
        return _unrealizable(so_far, (Failure("conflict", len(states), states[0], states),))
    if isinstance(found, Undecided):
        return found
    part, outcome = found
    warnings = (*outcome.warnings, *_led_out(problem, part.states))
    return replace(outcome, warnings=warnings, statistics=replace(outcome.statistics, part=_counted(part, starts)))


def _led_out(problem: Problem, decided: Bdd) -> tuple[Diagnostic, ...]:
    """The warning about variables that no action changes: where they change by themselves, to what is not decided."""
    spec, encoding = problem.spec, problem.encoding

    def beyond(variables: Sequence[int]) -> Bdd:
        bits = [bit for variable in variables for bit in encoding.state_bits[variable]]
        return encoding.manager.exists(bits, decided) & problem.steps.valid & ~decided

    changing = sorted(spec.environment)
    outside = beyond(changing)
    if outside == problem.false:
        return ()
    alone = [variable for variable in changing if beyond((variable,)) != problem.false]
    names = listed([spec.variables[variable].name for variable in alone or changing])
    example = " ".join(f"{name}={value}" for name, value in named(spec, encoding.first_state(outside)).items())
    message = (
        f"no action changes {names}; if that changes by itself, it may lead out of what the policy decides, "
        f"to {count(encoding.count_states(outside), 'state')} such as {example}"
    )
    way_out = "if that can happen, such states have to be starts: let a start condition hold there as well"
    return (Diagnostic(Code.TUM357, message, spec.starts[0].span, way_out),)


def _certified(problem: Problem, answer: Unrealizable, starts: Bdd) -> Unrealizable:
    from tumato_symbolic.synthesis.unrealizability import certified

    problem.context.tell("certifying that there is no policy")
    reason = reason_of(problem, failing_states(problem), starts)
    return answer if reason is None else replace(answer, certificate=certified(problem, reason))


def _unrealizable(so_far: Undecided, failures: tuple[Failure, ...]) -> Unrealizable:
    assert so_far.statistics is not None, "states are counted first"
    return Unrealizable(failures, so_far.statistics, None, so_far.warnings)


def _counted(part: _Part, starts: Bdd) -> DecidedPart:
    count = part.problem.encoding.count_states
    every = part.problem.encoding.manager.true
    return DecidedPart(count(part.states), count(part.problem.steps.unsafe), count(starts), part.left_out(every))


def _greatest(whole: Problem, problem: Problem, stages: tuple[_Stage, ...]) -> _Part:
    """The greatest closed part of the valid states of a problem in which none fails; `whole` has all valid states.

    Those that fail are left out, then those that fail without them, and so on.
    """
    while problem.steps.valid != problem.false and (kinds := failing_states(problem).kinds):
        problem.context.check()
        stages = (*stages, _Stage(problem.steps.valid, kinds))
        problem = _within(whole, problem.steps.valid & ~whole.encoding.manager.union(kinds.values()))
    return _Part(problem, stages)


def _within(whole: Problem, states: Bdd) -> Problem:
    """The problem where only these states are valid."""
    return with_goals(build_steps(whole.encoding, whole.steps.ordering, states))


class _Search:
    """The search for a part that a policy serves, where goals conflict in the greatest one.

    `blamed` are starts that no policy serves together, once there is no such part.
    """

    def __init__(self, problem: Problem, so_far: Undecided, solve: Solve) -> None:
        self._problem = problem
        self._so_far = so_far
        self._solve = solve
        self._tried: dict[Bdd, SynthesisResult] = {}
        self.blamed: dict[State, None] = {}

    def first(self, whole: _Part, starts: Bdd) -> tuple[_Part, Realizable] | Undecided | None:
        """The largest part with these starts, and the policy; None where there is none."""
        problem, encoding = self._problem, self._problem.encoding
        waiting, seen = [(0, 0, whole)], {whole.states}
        while waiting:
            part = heapq.heappop(waiting)[2]
            result = self._result(part)
            if isinstance(result, Realizable):
                return part, result
            if isinstance(result, Undecided):
                return result
            for state in result.failures[0].states:
                if encoding.contains(starts, state):
                    self.blamed[state] = None
                    continue
                alone = encoding.state_cube(state)
                stages = (*part.stages, _Stage(part.states, {"conflict": alone}))
                smaller = _greatest(problem, _within(problem, part.states & ~alone), stages)
                lost = starts & ~smaller.states
                if lost != problem.false:
                    self.blamed[encoding.first_state(lost)] = None
                elif smaller.states not in seen:
                    seen.add(smaller.states)
                    heapq.heappush(waiting, (-encoding.count_states(smaller.states), len(seen), smaller))
        return None

    def _result(self, part: _Part) -> SynthesisResult:
        if part.states not in self._tried:
            if len(self._tried) == PARTS:
                limit = f"{PARTS} parts of the states did not settle how the goals interact"
                return replace(self._so_far, limit=limit)
            self._tried[part.states] = self._solve(part.problem, self._so_far)
        return self._tried[part.states]

    def minimal(self, whole: _Part, blamed: list[State]) -> tuple[State, ...]:
        """Those of the blamed starts that still cannot be served together: each in turn is left out, if that may be."""
        encoding = self._problem.encoding
        needed, open_ = list[State](), sorted(blamed)
        while open_:
            rest = [*needed, *open_[1:]]
            if not rest or self.first(whole, encoding.manager.union(map(encoding.state_cube, rest))) is not None:
                needed.append(open_[0])
            open_ = open_[1:]
        return tuple(needed)
