"""States and the truth of predicates (`docs/semantics.md`, sections 1 and 2)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import prod
from typing import TypeAlias

from tumato_symbolic.spec import And, Assignment, Executing, Formula, Iff, Is, Not, Or, Rule, Spec, Value, value_of

State: TypeAlias = tuple[int, ...]
"""One value number for every variable, in the order of declaration."""

ActionSet: TypeAlias = frozenset[int]
"""The numbers of the actions executed at the same time."""

NOTHING: ActionSet = frozenset()


def holds(formula: Formula, state: State, executed: ActionSet = NOTHING) -> bool:
    """Whether `formula` is true in `state` while the actions `executed` run.

    Nothing is asked as often, so that it loops and compares types: that takes a fifth of the time of patterns.
    """
    if isinstance(formula, Is):
        return state[formula.variable] == formula.value
    if isinstance(formula, And):
        for part in formula.operands:  # noqa: SIM110
            if not holds(part, state, executed):
                return False
        return True
    if isinstance(formula, Or):
        for part in formula.operands:  # noqa: SIM110
            if holds(part, state, executed):
                return True
        return False
    if isinstance(formula, Not):
        return not holds(formula.operand, state, executed)
    if isinstance(formula, Executing):
        return formula.action in executed
    if isinstance(formula, Iff):
        return holds(formula.left, state, executed) == holds(formula.right, state, executed)
    return formula.value


def apply(assignment: Assignment, state: State) -> State:
    """`state` after an effect: the assigned variables change, every other one keeps its value."""
    after = list(state)
    for variable, value in assignment:
        after[variable] = value
    return tuple(after)


def count_states(spec: Spec) -> int:
    """How many states there are, valid or not."""
    return prod(len(variable.values) for variable in spec.variables)


def all_states(spec: Spec) -> Iterator[State]:
    """Every state; the last variable changes fastest."""
    return product(*(range(len(variable.values)) for variable in spec.variables))


def is_valid(spec: Spec, state: State) -> bool:
    """`state ∈ V`: it satisfies every assumption."""
    return all(holds(rule.formula, state) for rule in spec.validity)


def is_safe(spec: Spec, state: State) -> bool:
    """`state ∈ S`: it is valid and satisfies every state rule."""
    return is_valid(spec, state) and all(holds(rule.formula, state) for rule in spec.state_rules)


def is_start(spec: Spec, state: State) -> bool:
    """Whether a valid state is a start: it satisfies a start condition, or there is none."""
    return is_valid(spec, state) and holds(spec.start, state)


def level(spec: Spec, state: State) -> int:
    """How many tiers of state rules, the most severe first, a valid state satisfies whole (section 10)."""
    tiers = spec.tiers
    broken = (n for n, tier in enumerate(tiers) if not all(holds(rule.formula, state) for rule in tier))
    return next(broken, len(tiers))


def required_rules(spec: Spec, state: State) -> tuple[Rule, ...]:
    """What every state that a step from `state` leads to has to satisfy: the assumptions and some state rules.

    Of the state rules, those that hold in `state`, but for such as are milder than the severest tier that it breaks; in
    a safe state that is all. Where safety is to be restored in one step, that whole tier as well (sections 9 and 10).
    """
    severities = [tier[0].severity for tier in spec.tiers if tier]
    concerned = severities[: level(spec, state) + 1]
    rules = (rule for rule in spec.state_rules if rule.severity in concerned)
    if spec.restoration != "one_step":
        rules = (rule for rule in rules if holds(rule.formula, state))
    return (*spec.assumptions, *rules, *spec.in_part)


def in_json(spec: Spec, state: State) -> dict[str, Value]:
    """A state as JSON and Python have it: value by variable, where numbers are numbers."""
    return {name: value_of(value) for name, value in named(spec, state).items()}


def named(spec: Spec, state: State) -> dict[str, str]:
    """A state as the user writes it: value by variable."""
    return {variable.name: variable.values[value] for variable, value in zip(spec.variables, state, strict=True)}


def state_text(spec: Spec, state: State) -> str:
    """A state as `decide` reads it."""
    return " ".join(f"{name}={value}" for name, value in named(spec, state).items())


def action_names(spec: Spec, chosen: ActionSet) -> tuple[str, ...]:
    """The names of a set of actions, in the order of declaration."""
    return tuple(spec.actions[number].name for number in sorted(chosen))


def duration(spec: Spec, chosen: ActionSet) -> int:
    """The duration of a set: the sum of its actions' durations (`docs/semantics.md`, section 5)."""
    return sum(spec.actions[number].duration for number in chosen)
