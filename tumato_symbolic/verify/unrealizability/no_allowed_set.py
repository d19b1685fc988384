"""*No set is allowed in this state*: cubes that cover all sets, each with a condition that none of its sets meets."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Final

import z3

from tumato_symbolic.policy.unrealizability import Cube, NoAllowedSet
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    holds,
    is_safe,
    is_valid,
    nominal_agrees,
    replay,
    settled_truth,
    state_text,
    successor,
    without_cases,
)
from tumato_symbolic.spec import Ordering, Spec, canonical_text
from tumato_symbolic.verify.by_z3.encoding import Place, formula_term
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.terms import Term
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep, is_state
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.named_goals import set_text

_CLAIM: Final = "no set is allowed in the state"

COUNTED: Final = 64
"""Sets of so many actions are counted in messages."""


def check_no_allowed_set(reason: NoAllowedSet, step: AllowedStep, ordering: Ordering) -> int:
    """How many claims were checked without Z3. Raises `FalseClaimError` and `UndecidedError`."""
    spec, state = step.spec, reason.state
    if not is_valid(spec, state):
        raise FalseClaimError(f"the state {state_text(spec, state)} is not valid, so nothing has to be allowed in it")
    if reason.cubes is None:
        found = step.some_step(_CLAIM, is_state(step.state, state))
        if found is not None:
            raise FalseClaimError(_allowed(spec, state, found[1]), state, found[1])
        return 1
    try:
        _check_cubes(step, state, reason.cubes, ordering)
    except FalseClaimError as false:
        witness = _witness(step, state)
        if witness is None:
            raise
        raise FalseClaimError(f"{false.reason}; {_allowed(spec, state, witness)}", state, witness) from None
    return 3 + len(reason.cubes)


def _witness(step: AllowedStep, state: State) -> ActionSet | None:
    """A set that is allowed in a state, where one is found in time."""
    try:
        found = step.some_step(_CLAIM, is_state(step.state, state))
    except UndecidedError:
        return None
    return None if found is None else found[1]


def _allowed(spec: Spec, state: State, chosen: ActionSet) -> str:
    return f"in the state {state_text(spec, state)}, {set_text(spec, chosen)} is allowed"


def _check_cubes(step: AllowedStep, state: State, cubes: Sequence[Cube], ordering: Ordering) -> None:
    """Every set is in exactly one cube, and each cube's condition is violated by all its sets.

    Raises `FalseClaimError` and `UndecidedError`.
    """
    spec = without_cases(step.spec, state)
    count, covered, deadline = len(spec.actions), 0, step.deadline()
    earlier: list[tuple[int, int]] = []
    for number, cube in enumerate(cubes):
        if time.monotonic() > deadline:
            raise UndecidedError("the cubes are disjoint", "the time limit of one obligation is over")
        executed, idle = (sum(1 << action for action in part) for part in (cube.executed, cube.idle))
        if executed & idle:
            raise FalseClaimError(f"cube {number} executes an action that it leaves idle")
        for other, (other_executed, other_idle) in enumerate(earlier):
            if not executed & other_idle and not idle & other_executed:
                raise FalseClaimError(f"cubes {other} and {number} have sets in common")
        earlier.append((executed, idle))
        covered += 1 << (count - len(cube.executed) - len(cube.idle))
        wrong = _unproved(step, spec, state, cube, ordering)
        if wrong is not None:
            raise FalseClaimError(f"the violation of cube {number} ({cube.violation.kind}) does not hold: {wrong}")
    if covered != 1 << count:
        held = f"{covered:,} of {1 << count:,}" if count <= COUNTED else "not all"
        raise FalseClaimError(f"the cubes hold {held} sets of actions")


def _unproved(step: AllowedStep, spec: Spec, state: State, cube: Cube, ordering: Ordering) -> str | None:
    """Why the condition that a cube names is not violated by all its sets; None where it is.

    `spec` is what the specification says of this state.
    """
    violation = cube.violation
    settled = len(cube.executed) + len(cube.idle) == len(spec.actions)
    match violation.kind:
        case "precondition":
            return _precondition(spec, state, cube)
        case "resource" | "nominal-conflict":
            return _exclusion(spec, cube)
        case "reaction-rule":
            return _reaction_rule(step, spec, state, cube)
        case "unsafe":
            return _unsafe(spec, state, cube, ordering)
        case "falsified":
            return _falsified(spec, state, cube, ordering)
        case "idle":
            if any(action.effects for number, action in enumerate(spec.actions) if number not in cube.idle):
                return "some of its sets execute an action that has effects"
            return "the state is safe" if is_safe(spec, state) else None
        case "nominal-unsafe":
            if not settled:
                return "it leaves actions open"
            if not nominal_agrees(spec, cube.executed):
                return "the nominal effects do not agree"
            return "the next state is safe" if is_safe(spec, successor(spec, state, cube.executed)) else None


def _precondition(spec: Spec, state: State, cube: Cube) -> str | None:
    wrong = _precondition_of(cube)
    if wrong is not None:
        return wrong
    action = spec.actions[cube.violation.actions[0]]
    return "all preconditions hold" if all(holds(rule.formula, state) for rule in action.conditions) else None


def _precondition_of(cube: Cube) -> str | None:
    """Why a cube does not name one action that all its sets execute."""
    named = len(cube.violation.actions) == 1 and cube.executed.issuperset(cube.violation.actions)
    return None if named else "it names no action that all its sets execute"


def _exclusion(spec: Spec, cube: Cube) -> str | None:
    pair = frozenset(cube.violation.actions)
    if len(pair) != 2 or not pair <= cube.executed:
        return "it names no two actions that all its sets execute"
    if cube.violation.kind == "nominal-conflict":
        return "the nominal effects agree" if nominal_agrees(spec, pair) else None
    first, second = (spec.actions[number].resources for number in pair)
    return None if first & second else "the two actions have no resource in common"


def _reaction_rule(step: AllowedStep, spec: Spec, state: State, cube: Cube) -> str | None:
    """By the explicit meaning where the settled actions decide the rule, otherwise by Z3 for all others."""
    rules = {canonical_text(spec, rule.formula): rule.formula for rule in spec.reaction_rules}
    formula = rules.get(cube.violation.rule or "")
    if formula is None:
        return "the specification has no such rule"
    truth = settled_truth(formula, state, cube.executed, cube.idle)
    if truth is not None:
        return "its sets keep the rule" if truth else None
    solver = Solver()
    executed: list[Term] = [
        True if number in cube.executed else False if number in cube.idle else z3.Bool(f"open.{number}", solver.context)
        for number in range(len(spec.actions))
    ]
    here = Place.fresh(spec, "fixed", solver.context).after(tuple(enumerate(state)))
    answer = solver.ask(formula_term(formula, here, executed), deadline=step.deadline())
    if answer == "unknown":
        raise UndecidedError("a reaction rule is false for all sets of a cube")
    if answer == "sat":
        return "some of its sets keep the rule"
    step.proved += 1
    return None


def _unsafe(spec: Spec, state: State, cube: Cube, ordering: Ordering) -> str | None:
    wrong = _not_possible(spec, cube, ordering)
    if wrong is not None:
        return wrong
    return "the outcome is safe" if is_safe(spec, replay(state, cube.violation.outcome)[-1].after) else None


def _falsified(spec: Spec, state: State, cube: Cube, ordering: Ordering) -> str | None:
    wrong = _precondition_of(cube) or _not_possible(spec, cube, ordering)
    if wrong is not None:
        return wrong
    if spec.preconditions != "throughout":
        return "preconditions have to hold at the start only"
    (number,), effects = cube.violation.actions, cube.violation.outcome
    if number in {action for action, _ in effects}:
        return "the action has taken effect"
    reached = replay(state, effects)[-1].after
    kept = all(holds(rule.formula, reached) for rule in spec.actions[number].preconditions)
    return "all preconditions hold" if kept else None


def _not_possible(spec: Spec, cube: Cube, ordering: Ordering) -> str | None:
    """Why the effects that a cube names cannot happen in this order, whichever of its sets is executed."""
    effects = cube.violation.outcome
    acting = [action for action, _ in effects]
    if not effects or not cube.executed.issuperset(acting):
        return "it names no effects of actions that all its sets execute"
    if len(set(acting)) < len(acting):
        return "an action takes effect twice"
    if ordering == "first" and len(effects) > 1:
        return "only the first effect counts"
    if any(effect not in spec.actions[action].effects for action, effect in effects):
        return "an action does not have the effect"
    return None
