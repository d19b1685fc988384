"""Policies from the starts: the part that is decided, and the warning of what may lead out (`docs/semantics.md`, 12).

A part is *closed* when no step leaves it. The greatest part in which no state fails holds every other one that a policy
may decide. Where goals conflict in it, each of these leaves out a state of the conflict: the larger ones are tried
first.
"""

from __future__ import annotations

from collections.abc import Sequence

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import count, listed
from tumato_symbolic.game import Problem
from tumato_symbolic.policy.unrealizability import Reason
from tumato_symbolic.semantics import named
from tumato_symbolic.semantics.lint_findings import no_start
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis.failing import reason_of
from tumato_symbolic.synthesis.parts import Part, Search, Solve, greatest
from tumato_symbolic.synthesis.result import (
    DecidedPart,
    Failure,
    SynthesisResult,
    Undecided,
    Unrealizable,
)


def solve_from_starts(problem: Problem, so_far: Undecided, solve: Solve, *, certify: bool) -> SynthesisResult:
    """A policy for the largest part of the valid states that has all starts, or why there is none.

    With `certify`, that is with a certificate.
    """
    starts = _starts(problem)
    problem.context.tell("finding what can be decided")
    whole = greatest(problem, problem, ())
    assert so_far.statistics is not None, "states are counted first"
    counted = _counted(whole, starts)
    so_far = replace(so_far, statistics=replace(so_far.statistics, part=counted))
    search = Search(problem, so_far, solve)
    if failures := whole.left_out(starts):
        return _certified(search, whole, _unrealizable(so_far, failures, problem.spec), starts, certify=certify)
    problem.context.learn(so_far)
    found = search.first(whole, starts)
    if found is None:
        states = search.minimal(whole, [*search.blamed])
        answer = _unrealizable(so_far, (Failure("conflict", len(states), states[0], states),), problem.spec)
        return _certified(search, whole, answer, starts, certify=certify)
    if isinstance(found, Undecided):
        return found
    part, outcome = found
    warnings = (*outcome.warnings, *_led_out(problem, part.states))
    counted = counted if part is whole else _counted(part, starts)
    return replace(outcome, warnings=warnings, statistics=replace(outcome.statistics, part=counted))


def solve_everywhere(problem: Problem, so_far: Undecided, solve: Solve) -> SynthesisResult:
    """A policy for all valid states, which no larger part can have, or why these have none."""
    starts = _starts(problem)
    assert so_far.statistics is not None, "states are counted first"
    part = _counted(Part(problem, ()), starts)
    return solve(problem, replace(so_far, statistics=replace(so_far.statistics, part=part)), None)


def _starts(problem: Problem) -> Bdd:
    """The start states. Raises `UserError` where there are none."""
    starts = problem.steps.valid & problem.encoding.formula(problem.spec.start)
    if starts == problem.false:
        raise UserError((no_start(problem.spec),))
    return starts


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


def _certified(search: Search, whole: Part, answer: Unrealizable, starts: Bdd, *, certify: bool) -> Unrealizable:
    """The answer, with its certificate where one is asked for and there is a form for it."""
    from tumato_symbolic.synthesis.no_part import no_part
    from tumato_symbolic.synthesis.unrealizability import certified

    problem = whole.stages[0].problem if whole.stages else whole.problem
    problem.context.learn(answer)
    if not certify:
        return answer
    problem.context.tell("certifying that there is no policy")
    reason: Reason | None = None
    if whole.stages and whole.stages[0].failing is not None:  # without starts they would fail as well
        reason = reason_of(problem, whole.stages[0].failing, starts)
    reason = reason or no_part(search, whole, starts)
    return answer if reason is None else replace(answer, certificate=certified(problem, reason))


def _unrealizable(so_far: Undecided, failures: tuple[Failure, ...], spec: Spec) -> Unrealizable:
    assert so_far.statistics is not None, "states are counted first"
    return Unrealizable(failures, so_far.statistics, None, so_far.warnings, spec=spec)


def _counted(part: Part, starts: Bdd) -> DecidedPart:
    count = part.problem.encoding.count_states
    every = part.problem.encoding.manager.true
    return DecidedPart(count(part.states), count(part.problem.steps.unsafe), count(starts), part.left_out(every))
