"""Changing a rule a little instead of dropping it: exceptions, wider preconditions, the smallest sufficient bound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

from tumato_symbolic.explain.as_predicates import cube_formula, predicate_text
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.elements import Element, Elements, rule_of, without
from tumato_symbolic.explain.failing_states import failing
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable, trial
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import And, Or, Rule, Spec
from tumato_symbolic.synthesis import Realizable

TRIES = 400
"""So many exceptions are looked at for one repair at most."""

MOST_STATES = 10_000
"""In larger specifications no exceptions are looked for that settle conflicts of goals."""

_Test: TypeAlias = Callable[[Requirements, Elements], bool]
"""Whether the specification that is left when some elements are dropped will do."""


@dataclass(frozen=True)
class Edit:
    """An element with the text that takes its place."""

    element: Element
    text: str


@dataclass(frozen=True)
class Weakening:
    """Edits that make the specification realizable, and what is dropped beside them; both are needed."""

    edits: tuple[Edit, ...]
    dropped: Elements
    spec: Spec


def weakening(requirements: Requirements, repair: Elements) -> Weakening | None:
    """A repair in which as much as possible is changed rather than dropped; None where nothing can be.

    A rule or a precondition gets the exception `OR c` for one cube `c`, which is as small as can be: with one value of
    one variable less it would not do. The plan bound is raised as little as possible. Verified by synthesis.
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
    """The rule with the smallest exception that this search finds; None where it must be dropped whole."""
    spec, rule = requirements.spec, rule_of(requirements.spec, element)
    if rule is None:
        return None
    everything: StateCube = tuple(tuple(range(len(variable.values))) for variable in spec.variables)
    cube, tries = everything, 0
    for variable, values in enumerate(everything):
        for value in values if len(values) > 1 else ():
            smaller = tuple(kept for kept in cube[variable] if kept != value)
            candidate = (*cube[:variable], smaller, *cube[variable + 1 :])
            tries += 1
            if tries > TRIES:
                return None
            if smaller and suffices(requirements.changed(element, _with_exception(spec, rule, candidate)), others):
                cube = candidate
    if cube == everything:
        return None
    wider = _with_exception(spec, rule, cube)
    return requirements.changed(element, wider), Edit(element, wider.text)


def _is_realizable(requirements: Requirements, dropped: Elements) -> bool:
    """The exact test, for where goals conflict; it is too slow for large specifications."""
    return count_states(requirements.spec) <= MOST_STATES and is_realizable(
        requirements, without(requirements.spec, dropped)
    )


def _no_state_fails(requirements: Requirements, dropped: Elements) -> bool:
    kept = requirements.everything - dropped
    stuck = requirements.stuck(kept)
    return stuck == requirements.false and failing(requirements, kept, requirements.valid) == requirements.false


def _with_exception(spec: Spec, rule: Rule, cube: StateCube) -> Rule:
    exception = cube_formula(spec, cube)
    text = predicate_text(spec, exception)
    text = f"({text})" if isinstance(exception, And | Or) else text
    return Rule(Or((rule.formula, exception)), f"({' '.join(rule.text.split())}) OR {text}", rule.span)
