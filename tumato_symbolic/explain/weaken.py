"""Changing a rule a little instead of dropping it: exceptions, wider preconditions, the smallest sufficient bound."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import combinations
from typing import TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.explain.additions import every_state
from tumato_symbolic.explain.as_predicates import cube_formula, predicate_text
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.elements import Element, Elements, rule_of, without
from tumato_symbolic.explain.failing_states import FailingStates, failing
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable, trial
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import Action, And, Or, Rule, Spec, variables_of
from tumato_symbolic.synthesis import Realizable

MOST_VARIABLES = 3
"""An exception is about so many variables at most."""

TRIES = 400
"""So many exceptions are looked at for one repair at most."""

MOST_STATES = 10_000
"""In larger specifications no exceptions are looked for that settle conflicts of goals."""

_LITERAL = re.compile(r"(NOT )?\w+ is \w+")
"""A predicate that needs no parentheses."""

_Test: TypeAlias = Callable[[Requirements, Elements], bool]
"""Whether the specification that is left when some elements are dropped will do."""


class Edit(Struct, frozen=True):
    """An element with the text that takes its place."""

    element: Element
    text: str


class Weakening(Struct, frozen=True):
    """Edits that make the specification realizable, and what is dropped beside them; both are needed."""

    edits: tuple[Edit, ...]
    dropped: Elements
    spec: Spec


def weakening(requirements: Requirements, repair: Elements) -> Weakening | None:
    """A repair in which as much as possible is changed rather than dropped; None where nothing can be.

    A rule or a precondition gets the exception `OR c` for one cube `c`, of as few variables and values as can be, which
    has a variable in common with it and leaves something of it. The plan bound is raised as little as possible.
    Verified by synthesis.
    """
    for suffices in (_no_state_fails, _is_realizable):
        found = _weakened(requirements, repair, suffices)
        if found is None or is_realizable(requirements, found.spec):
            return found
    return None


def _weakened(requirements: Requirements, repair: Elements, suffices: _Test) -> Weakening | None:
    """A weakening that passes a test, None where nothing can be changed."""
    edits: list[Edit] = []
    dropped = repair
    for element in [each for each in requirements.elements if each in repair]:
        others = dropped - {element}
        found = (
            _raised(requirements, element, others)
            if element.kind == "plan-bound"
            else _excepted(requirements, element, others, suffices)
        )
        if found is not None:
            requirements, edit = found
            edits.append(edit)
            dropped = others
    return Weakening(tuple(edits), dropped, without(requirements.spec, dropped)) if edits else None


def _raised(requirements: Requirements, bound: Element, others: Elements) -> tuple[Requirements, Edit] | None:
    """The smallest bound that suffices: realizability is monotone in it."""
    base = without(requirements.spec, others)
    outcome = trial(requirements, without(requirements.spec, others | {bound}))
    if not isinstance(outcome, Realizable) or base.max_plan_length is None:
        return None
    too_small, enough = base.max_plan_length, outcome.statistics.longest_run or 1
    while enough - too_small > 1:
        middle = (too_small + enough) // 2
        if is_realizable(requirements, replace(base, max_plan_length=middle)):
            enough = middle
        else:
            too_small = middle
    return requirements.bounded(enough), Edit(bound, f"max_plan_length: {enough}")


def _excepted(
    requirements: Requirements, element: Element, others: Elements, suffices: _Test
) -> tuple[Requirements, Edit] | None:
    """The rule with an exception of as few variables as can be, and then of as few values; None where none will do.

    An exception that leaves nothing of the rule is none.
    """
    spec, rule = requirements.spec, rule_of(requirements.spec, element)
    if rule is None:
        return None
    own, everything, tries = variables_of(rule.formula), every_state(spec), 0

    def enough(cube: StateCube) -> bool:
        nonlocal tries
        tries += 1
        return tries <= TRIES and suffices(requirements.changed(element, _with_exception(spec, rule, cube)), others)

    for variables in _variable_sets(spec, element, rule):
        cube = _smallest(spec, variables, enough)
        if tries > TRIES:
            return None
        wider = _with_exception(spec, rule, cube)
        related = any(cube[variable] != everything[variable] for variable in own)
        if related and requirements.formula(wider.formula) != requirements.valid:
            return requirements.changed(element, wider), Edit(element, wider.text)
    return None


def _variable_sets(spec: Spec, element: Element, rule: Rule) -> Iterator[tuple[int, ...]]:
    """The sets of variables that an exception may be about, the smallest first; those of the rule before others.

    One is the rule's own; the others have to do with these: of a precondition, the same action requires or changes
    them; of a rule, some action or rule has both.
    """
    own = variables_of(rule.formula)
    actions = [spec.actions[element.number]] if element.kind == "precondition" else spec.actions
    groups = [_variables(action) for action in actions]
    if element.kind != "precondition":
        groups += [variables_of(each.formula) for each in (*spec.state_rules, *spec.reaction_rules)]
    related = frozenset[int]().union(*(group for group in groups if group & own))
    candidates = [*sorted(own), *sorted(related - own)]
    for size in range(1, MOST_VARIABLES + 1):
        yield from (each for each in combinations(candidates, size) if own.intersection(each))


def _variables(action: Action) -> frozenset[int]:
    """What an action requires and changes."""
    required = frozenset[int]().union(*(variables_of(each.formula) for each in action.preconditions))
    return required.union(variable for effect in action.effects for variable, _ in effect)


def _smallest(spec: Spec, variables: tuple[int, ...], enough: Callable[[StateCube], bool]) -> StateCube:
    """A cube over some variables that is enough, and is not when one value is taken away."""
    everything = every_state(spec)
    pairs = [(variable, value) for variable in variables for value in everything[variable]]

    def cube(kept: frozenset[tuple[int, int]]) -> StateCube:
        return tuple(
            tuple(value for value in values if (variable, value) in kept) if variable in variables else values
            for variable, values in enumerate(everything)
        )

    return cube(minimal(pairs, lambda kept: all(cube(kept)) and enough(cube(kept))))


def _is_realizable(requirements: Requirements, dropped: Elements) -> bool:
    """The exact test, for where goals conflict; it is too slow for large specifications."""
    return count_states(requirements.spec) <= MOST_STATES and is_realizable(
        requirements, without(requirements.spec, dropped)
    )


def _no_state_fails(requirements: Requirements, dropped: Elements) -> bool:
    kept = requirements.everything - dropped
    if requirements.spec.starts:
        return FailingStates(requirements).left_out(kept, requirements.starts) == requirements.false
    stuck = requirements.stuck(kept)
    return stuck == requirements.false and failing(requirements, kept, requirements.valid) == requirements.false


def _with_exception(spec: Spec, rule: Rule, cube: StateCube) -> Rule:
    exception = cube_formula(spec, cube)
    text = predicate_text(spec, exception)
    text = f"({text})" if isinstance(exception, And) else text
    own = one_line(rule.text)
    own = own if _LITERAL.fullmatch(own) else f"({own})"
    return Rule(Or((rule.formula, exception)), f"{own} OR {text}", rule.span)
