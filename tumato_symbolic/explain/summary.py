"""A long core in one sentence: that nothing changes a variable as it would have to be."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.explain.additions import every_state
from tumato_symbolic.explain.cubes import StateCube, expanded, set_of
from tumato_symbolic.explain.elements import Elements, rule_of
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.semantics import State, active_goals, holds
from tumato_symbolic.spec import Formula, Spec, variables_of
from tumato_symbolic.symbolic import Bdd

LONG = 6
"""Cores of more elements are summed up."""

MOST_LITERALS = 3
"""Where it takes more variables to say where nothing changes a variable, nothing is said."""

Change: TypeAlias = Literal["raises", "lowers", "changes"]


class Summary(Struct, frozen=True):
    """In the states of a cube, nothing changes a variable in one way: sets it to one of some values.

    `by_itself`: no action that may start there does; else no set of actions that is allowed.
    """

    variable: int
    change: Change
    values: tuple[int, ...]
    where: StateCube
    by_itself: bool


def summary(requirements: Requirements, core: Elements, states: Bdd, example: State) -> Summary | None:
    """What a core of some states comes to; None where it is short, or comes to nothing that can be said shortly."""
    if len(core) <= LONG:
        return None
    found = [
        said
        for by_itself in (True, False)
        for wanted in _wanted(requirements, core, example)
        if (said := _said(requirements, states, example, wanted, by_itself)) is not None
    ]
    everything = every_state(requirements.spec)

    def literals(said: Summary) -> int:
        return sum(values != all_ for values, all_ in zip(said.where, everything, strict=True))

    return min((each for each in found if literals(each) <= MOST_LITERALS), key=literals, default=None)


def _wanted(requirements: Requirements, core: Elements, example: State) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Variables with the values that would mend what is wrong: the core's broken rules, or else the goals."""
    spec = requirements.spec
    rules = [rule_of(spec, each) for each in requirements.elements if each in core and each.kind == "state-rule"]
    broken = [rule.formula for rule in rules if rule is not None and not holds(rule.formula, example)]
    bodies = (spec.bodies[body].formula for body in sorted(active_goals(spec, example)))
    wrong = broken or [body for body in bodies if not _holds(body, example)]
    for variable in sorted(frozenset[int]().union(*map(variables_of, wrong))):
        others = [value for value in range(len(spec.variables[variable].values)) if value != example[variable]]
        mending = [value for value in others if all(_holds(each, _put(example, variable, value)) for each in wrong)]
        if others:
            yield variable, tuple(mending or others)


def _holds(formula: Formula, state: State) -> bool:
    return holds(formula, state, frozenset())


def _put(state: State, variable: int, value: int) -> State:
    return (*state[:variable], value, *state[variable + 1 :])


def _said(
    requirements: Requirements, states: Bdd, example: State, wanted: tuple[int, tuple[int, ...]], by_itself: bool
) -> Summary | None:
    """That nothing sets a variable to one of the wanted values in some states, in as few words as can be."""
    spec, encoding, (variable, values) = requirements.spec, requirements.encoding, wanted
    change = _change(spec, variable, example[variable], values)
    changing = requirements.manager.union(_changing(requirements, variable, values, change, by_itself))
    forbidden = changing & requirements.valid
    if states & forbidden != requirements.false:
        return None
    others = [other for other in range(len(spec.variables)) if other != variable]
    orders = ([variable, *others], [variable, *reversed(others)], [*others, variable])
    cubes = [expanded(encoding, example, forbidden, order) for order in orders]
    cubes = [cube for cube in cubes if states & ~set_of(encoding, cube) == requirements.false]
    if not cubes:
        return None
    where = max(cubes, key=lambda cube: sum(kept == free for kept, free in zip(cube, every_state(spec), strict=True)))
    return Summary(variable, change, values, where, by_itself)


def _change(spec: Spec, variable: int, value: int, values: tuple[int, ...]) -> Change:
    """How the value of a variable would have to change; up or down only where its values are numbered."""
    numbers = [re.search(r"\d+$", name) for name in spec.variables[variable].values]
    ordered = [int(number[0]) for number in numbers if number is not None]
    if len(ordered) < len(numbers) or any(low >= high for low, high in pairwise(ordered)):
        return "changes"
    return "raises" if min(values) > value else "lowers" if max(values) < value else "changes"


def _changing(
    requirements: Requirements, variable: int, values: tuple[int, ...], change: Change, by_itself: bool
) -> Iterator[Bdd]:
    """The states where some action changes a variable in one way, for each action."""
    encoding, manager = requirements.encoding, requirements.manager
    allowed = None if by_itself else requirements.allowed(requirements.everything)
    for number, action in enumerate(requirements.spec.actions):
        written = dict(action.nominal).get(variable)
        if written is None or (change == "changes" and written not in values):
            continue
        if allowed is None:
            able = encoding.all_of(rule.formula for rule in action.preconditions)
        else:
            able = manager.exists(encoding.all_choice_bits, allowed & encoding.executing(number))
        count = len(requirements.spec.variables[variable].values)
        before = {"raises": range(written), "lowers": range(written + 1, count)}.get(change)
        if before is None:
            yield able & ~encoding.value(variable, written)
        else:
            yield able & manager.union(encoding.value(variable, value) for value in before)
