"""What each of the two readers makes of a specification, in one form, so that it can be compared."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import prod
from pathlib import Path
from typing import Any

from tests.checker.standalone import checker
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.semantics import State, case_in, holds
from tumato_symbolic.spec import ConditionalGoal, Goal, GoalList, Rule, SimpleGoal, Spec, canonical_text, digest, load
from tumato_symbolic.syntax import read_source

REFUSED = "refused"
NO_VERDICT = "no verdict"
MOST_STATES = 60
"""In so many states, at least half of them, the effects of actions with clauses are compared."""

Meaning = dict[str, Any]


@contextmanager
def deep() -> Iterator[None]:
    """The recursion limit under which the checker works."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(10_000, limit))
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)


def read_by_package(path: Path) -> Spec | str:
    """The specification in a file, or that it is refused."""
    try:
        return load(read_source(str(path))).spec or REFUSED
    except UserError:
        return REFUSED


def read_by_checker(path: Path) -> Any:
    """The same; the checker may also say that the question is too large for it."""
    try:
        with deep():
            return checker.read_specification(path.read_bytes())
    except (checker.Unreadable, UnicodeDecodeError, RecursionError):
        return REFUSED
    except checker.TooLarge:
        return NO_VERDICT


def meaning_by_package(spec: Spec) -> Meaning:
    """What a specification says, by names."""

    def rules(found: Iterable[Rule]) -> list[tuple[str, int]]:
        return [(canonical_text(spec, rule.formula), rule.span.line) for rule in found]

    def assignment(pairs: Iterable[tuple[int, int]]) -> list[tuple[str, str]]:
        return sorted(
            (spec.variables[variable].name, spec.variables[variable].values[value]) for variable, value in pairs
        )

    def effects(number: int, state: State) -> list[Any]:
        case = spec.actions[case_in(spec, number, state)]
        if case.guard is not None and not holds(case.guard.formula, state):
            return []
        return [assignment(case.nominal), sorted(map(assignment, case.effects))]

    def goal(found: Goal | None) -> list[Any] | None:
        match found:
            case SimpleGoal(body):
                return ["goal", canonical_text(spec, spec.bodies[body].formula)]
            case ConditionalGoal(condition, inner):
                return ["when", canonical_text(spec, condition.formula), goal(inner)]
            case GoalList(kind, members):
                return [kind, *map(goal, members)]
            case _:
                return None

    return {
        "variables": [(variable.name, list(variable.values)) for variable in spec.variables],
        "resources": list(spec.resources),
        "actions": [
            {
                "name": action.name,
                "duration": action.duration,
                "resources": sorted(spec.resources[number] for number in action.resources),
                "preconditions": rules(action.preconditions),
                "effects": [effects(number, state) for state in _states([len(each.values) for each in spec.variables])]
                if action.written
                else effects(number, ()),
            }
            for number, action in enumerate(spec.actions[cases[0]] for cases in spec.cases)
        ],
        "reaction rules": rules(spec.reaction_rules),
        "state rules": rules(spec.state_rules),
        "assumptions": rules(spec.assumptions),
        "goals": goal(spec.goals),
        "bound": spec.max_plan_length,
        "severities": [rule.severity for rule in spec.state_rules],
        "ordering": spec.effect_ordering,
        "restoration": spec.restoration,
        "digest": digest(spec),
    }


def meaning_by_checker(spec: Any) -> Meaning:
    """The same."""
    names, domains = list(spec.variables), list(spec.variables.values())

    def rules(found: Iterable[Any]) -> list[tuple[str, int]]:
        return [(checker.text_of(formula, spec), line) for formula, line in found]

    def assignment(effect: dict[int, str]) -> list[tuple[str, str]]:
        return sorted((names[place], value) for place, value in effect.items())

    def effects(action: Any, state: State) -> list[Any]:
        found = action.effects_in(tuple(values[place] for values, place in zip(domains, state, strict=False)))
        return [assignment(found[0]), _once_each(map(assignment, found if any(found) else []))] if found else []

    def goal(found: Any) -> list[Any]:
        if found.kind == "goal":
            bare = ["goal", checker.text_of(found.body, spec)]
        else:
            bare = [found.kind, *map(goal, found.members)]
        return bare if found.condition is None else ["when", checker.text_of(found.condition, spec), bare]

    return {
        "variables": [(name, list(values)) for name, values in spec.variables.items()],
        "resources": list(spec.resources),
        "actions": [
            {
                "name": action.name,
                "duration": action.duration,
                "resources": sorted(action.holds_resources),
                "preconditions": rules(action.preconditions),
                "effects": [effects(action, state) for state in _states([len(values) for values in domains])]
                if action.conditional
                else effects(action, ()),
            }
            for action in spec.actions.values()
        ],
        "reaction rules": rules(spec.reaction_rules),
        "state rules": rules(spec.state_rules),
        "assumptions": rules(spec.assumptions),
        "goals": goal(spec.goals) if spec.goals is not None and spec.goals.members else None,
        "bound": spec.bound,
        "severities": spec.severities,
        "ordering": spec.ordering,
        "restoration": spec.restoration or "one_step",
        "digest": checker.digest(spec),
    }


def _states(sizes: list[int]) -> list[State]:
    """Some states, evenly spread."""
    total = prod(sizes)
    found = []
    for number in range(0, total, max(1, total // MOST_STATES)):
        rest, state = number, []
        for size in reversed(sizes):
            rest, value = divmod(rest, size)
            state.append(value)
        found.append(tuple(reversed(state)))
    return found


def _once_each(effects: Iterable[list[tuple[str, str]]]) -> list[list[tuple[str, str]]]:
    return sorted(list(each) for each in {tuple(effect) for effect in effects})


def differences(one: Meaning, other: Meaning) -> list[str]:
    """Where two meanings differ."""
    return [f"{key}: {one[key]!r} is not {other[key]!r}"[:600] for key in one if one[key] != other[key]]
