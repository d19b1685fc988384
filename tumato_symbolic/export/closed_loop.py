"""The closed loop of a policy as guarded commands: decide, let effects happen, halt, decide again.

From every valid state, or with starts from every one that is decided, whenever nothing is being executed, the policy
chooses a set of actions. Then, under `any`, the actions that have not taken effect take one of their effects each, in
any order, until the robot halts the rest, which it may do after any effect; under `first`, one action takes one effect,
or all nominal effects happen at once. A set whose actions have no effects changes nothing. What has to hold, and when,
is said here as formulas; targets print them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from msgspec import Struct

from tumato_symbolic.export.request import Request
from tumato_symbolic.semantics import excluded
from tumato_symbolic.spec import (
    FALSE,
    TRUE,
    Action,
    And,
    Connectives,
    Constant,
    Formula,
    Iff,
    Not,
    Or,
    Ordering,
    Restoration,
    Rule,
    Spec,
    Variable,
    active_bodies,
)


class Required(Struct, frozen=True):
    """Where `when` holds in the state of a decision, `rule` has to hold after every effect of what was decided."""

    when: Formula
    rule: Formula


class ActiveGoal(Struct, frozen=True):
    """Where `when` holds in the state of a decision, the run from there has to reach `body`.

    Atoms `executing` in it mean that first decision.
    """

    when: Formula
    body: Formula


class ClosedLoop(Struct, frozen=True):
    """A specification as conditions on the steps of a policy.

    `cases[action]` are the numbers of the entries of `actions` that share the name of an action of the policy: the one
    whose preconditions hold when it starts is executed. `excluded` are pairs of entries that must not be executed
    together. `levels[n]` holds where the `n + 1` most severe tiers of state rules do. `several_steps` tells that goals
    count in safe states only, and that `restoration` asks for more than the required rules. Valid states where `starts`
    holds have to be decided; all of them where it is None. With starts, others may be left undecided, and then no
    effect of a decision may lead there (`docs/semantics.md`, section 12).
    """

    variables: tuple[Variable, ...]
    actions: tuple[Action, ...]
    cases: tuple[tuple[int, ...], ...]
    valid: Formula
    starts: Formula | None
    levels: tuple[Formula, ...]
    reaction_rules: Formula
    excluded: tuple[tuple[int, int], ...]
    required: tuple[Required, ...]
    goals: tuple[ActiveGoal, ...]
    bound: int | None
    ordering: Ordering
    restoration: Restoration
    several_steps: bool
    preconditions_last: bool

    @property
    def begins(self) -> str:
        """Where runs begin, in words."""
        return "every valid state" if self.starts is None else "every start, and every other state that is decided"

    @property
    def safe(self) -> Formula:
        """Where all state rules hold, besides the assumptions."""
        return conjunction((self.valid, self.levels[-1]))

    @classmethod
    def of(cls, request: Request) -> ClosedLoop:
        """The closed loop of a policy and its specification."""
        spec = request.spec
        names = request.policy.vocabulary.actions
        by_name = {spec.actions[cases[0]].name: tuple(cases) for cases in spec.cases}
        cases = tuple(by_name[name] for name in names)
        active = active_bodies(spec.goals, lambda formula: formula, _SHORT)
        return cls(
            spec.variables,
            spec.actions,
            cases,
            _all(spec.assumptions),
            spec.start if spec.starts else None,
            tuple(_levels(spec)),
            _all(spec.reaction_rules),
            tuple(_excluded(spec)),
            tuple(_required(spec)),
            tuple(ActiveGoal(when, spec.bodies[body].formula) for body, when in sorted(active.items())),
            spec.max_plan_length,
            request.ordering,
            spec.restoration,
            spec.restores_stepwise,
            spec.preconditions == "throughout",
        )


def conjunction(formulas: Sequence[Formula]) -> Formula:
    """All of some formulas."""
    formulas = [each for each in formulas if each != TRUE]
    if FALSE in formulas:
        return FALSE
    return And(tuple(formulas)) if len(formulas) > 1 else formulas[0] if formulas else TRUE


def disjunction(formulas: Sequence[Formula]) -> Formula:
    """Some of some formulas."""
    formulas = [each for each in formulas if each != FALSE]
    if TRUE in formulas:
        return TRUE
    return Or(tuple(formulas)) if len(formulas) > 1 else formulas[0] if formulas else FALSE


def negation(formula: Formula) -> Formula:
    """What holds where a formula does not."""
    if isinstance(formula, Constant):
        return Constant(not formula.value)
    return formula.operand if isinstance(formula, Not) else Not(formula)


_SHORT: Connectives[Formula] = Connectives(Constant, negation, conjunction, disjunction, Iff)
"""Formulas of formulas, without constants where these make no difference."""


def preconditions(action: Action) -> Formula:
    """All that has to hold where an action starts."""
    return _all(action.conditions)


def lasting(action: Action) -> Formula:
    """What may have to hold until an action takes effect."""
    return _all(action.preconditions)


def guard(action: Action) -> Formula:
    """Where a case of an action is the one that is meant, besides its preconditions."""
    return TRUE if action.guard is None else action.guard.formula


def _all(rules: Sequence[Rule]) -> Formula:
    return conjunction([rule.formula for rule in rules])


def _excluded(spec: Spec) -> Iterator[tuple[int, int]]:
    masks, of = excluded(spec), spec.first_case
    for first, second in combinations(range(len(spec.actions)), 2):
        if masks[first] >> second & 1 and of[first] != of[second]:
            yield first, second


def _levels(spec: Spec) -> Iterator[Formula]:
    for count in range(1, len(spec.tiers) + 1):
        yield conjunction([_all(tier) for tier in spec.tiers[:count]])


def _required(spec: Spec) -> Iterator[Required]:
    """What `semantics.required_rules` says, rule by rule."""
    yield from (Required(TRUE, rule.formula) for rule in spec.assumptions)
    more_severe: list[Rule] = []
    for tier in spec.tiers:
        concerned = _all(more_severe)
        for rule in tier:
            when = concerned if spec.restoration == "one_step" else conjunction((concerned, rule.formula))
            yield Required(when, rule.formula)
        more_severe += tier
