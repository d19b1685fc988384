"""Warnings that need the whole state space, found state by state: what is legal, but surely not meant."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, combinations
from math import prod
from typing import TypeAlias

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.semantics.cases import actions_of, case_in, cases_in
from tumato_symbolic.semantics.lint_findings import (
    SETS,
    STATES,
    goals_to_reach,
    idle_action,
    idle_goal,
    idle_rule,
    in_order,
    keeps_guard,
    no_start,
    no_valid_state,
    reached_goal,
)
from tumato_symbolic.semantics.states import ActionSet, State, all_states, count_states, holds, is_start, is_valid
from tumato_symbolic.semantics.step import allowed, nominal_agrees, takes_effect
from tumato_symbolic.spec import (
    ConditionalGoal,
    Formula,
    Goal,
    GoalList,
    Rule,
    Spec,
    executing_atoms,
    subgoals,
)
from tumato_symbolic.spec.forgotten import joined_rules
from tumato_symbolic.spec.formula import atoms

MAX_STATES = 10_000
"""The most states that are looked at one by one."""

MAX_WORK = 500_000
"""How many atoms are looked at for one specification; questions that are open then stay open."""

States: TypeAlias = Sequence[State]


def lint(spec: Spec) -> tuple[Diagnostic, ...]:
    """Goals that are never entered or hold already, rules that nothing breaks, actions that are allowed nowhere.

    In source order. An error (TUM312) where no state is valid; none of this where there are more than `MAX_STATES`
    states. What a predicate's own variables decide is left out: that is said when the specification is read.
    """
    work, found = _Work(), list(joined_rules(spec))
    if count_states(spec) > MAX_STATES or not work.affords(count_states(spec) * _cost(spec.assumptions)):
        return in_order(found)
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    if not valid:
        return (no_valid_state(spec),)
    if spec.starts and not any(is_start(spec, state) for state in valid):
        return (no_start(spec),)
    try:
        for one in chain(
            _goals(spec, valid, work),
            _reached(spec, valid, work),
            _rules(spec, valid, work),
            _actions(spec, valid, work),
        ):
            found.append(one)  # noqa: PERF402 - what is found before the work is spent stays
    except _SpentError:
        pass
    return in_order(found)


class _SpentError(Exception):
    """All work that may be done is done."""


class _Work:
    """What may still be done."""

    def __init__(self) -> None:
        self._left = MAX_WORK

    def affords(self, amount: int) -> bool:
        """Whether so much may be done; it is counted as done."""
        self._left -= amount
        return self._left >= 0

    def spend(self, amount: int) -> None:
        """Count what is about to be done. Raises `_SpentError` where that is too much."""
        if not self.affords(amount):
            raise _SpentError

    def holds(self, formula: Formula, cost: int, state: State, executed: ActionSet = frozenset()) -> bool:
        """Whether a formula with `cost` atoms is true."""
        self.spend(cost)
        return holds(formula, state, executed)


def _cost(rules: Iterable[Rule]) -> int:
    return 1 + sum(sum(1 for _ in atoms(rule.formula)) for rule in rules)


def _goals(spec: Spec, valid: States, work: _Work) -> Iterator[Diagnostic]:
    if spec.goals is None:
        return
    entered: set[int] = set()
    costs = {id(goal): _cost([goal.condition]) for goal in subgoals(spec.goals) if isinstance(goal, ConditionalGoal)}
    everything = {id(goal) for goal in subgoals(spec.goals)}
    for state in valid:
        if entered == everything:
            return
        _enter(spec.goals, state, entered, costs, work)
    for goal in _idle(spec.goals, entered):
        if isinstance(goal, ConditionalGoal):
            formula, cost = goal.condition.formula, costs[id(goal)]
            if not any(work.holds(formula, cost, state) for state in all_states(spec)):
                continue
        yield idle_goal(goal)


def _enter(goal: Goal, state: State, entered: set[int], costs: dict[int, int], work: _Work) -> bool:
    """Whether a goal is entered in a state; those that are, are noted."""
    if isinstance(goal, ConditionalGoal):
        if not work.holds(goal.condition.formula, costs[id(goal)], state):
            return False
        _enter(goal.goal, state, entered, costs, work)
    elif isinstance(goal, GoalList):
        for member in goal.members:
            if _enter(member, state, entered, costs, work) and goal.kind == "priority":
                break
    work.spend(1)
    entered.add(id(goal))
    return True


def _idle(goal: Goal, entered: set[int]) -> Iterator[Goal]:
    """The goals that are not entered, but for those inside others of them."""
    if id(goal) not in entered:
        yield goal
    elif isinstance(goal, ConditionalGoal):
        yield from _idle(goal.goal, entered)
    elif isinstance(goal, GoalList):
        for member in goal.members:
            yield from _idle(member, entered)


def _reached(spec: Spec, valid: States, work: _Work) -> Iterator[Diagnostic]:
    for body, when in goals_to_reach(spec):
        cost, whole = sum(1 for _ in atoms(when)), _cost([body])
        active = [state for state in valid if work.holds(when, cost, state)]
        if not active or not all(work.holds(body.formula, whole, state) for state in active):
            continue
        if not all(work.holds(body.formula, whole, state) for state in all_states(spec)):
            yield reached_goal(body)


def _rules(spec: Spec, valid: States, work: _Work) -> Iterator[Diagnostic]:
    for rule in spec.state_rules:
        cost = _cost([rule])
        if keeps_guard(spec, rule):
            continue
        if all(work.holds(rule.formula, cost, state) for state in valid) and not all(
            work.holds(rule.formula, cost, state) for state in all_states(spec)
        ):
            yield idle_rule(rule, STATES)
    for rule in spec.reaction_rules:
        cost = _cost([rule])
        if keeps_guard(spec, rule):
            continue
        sets = list(_compatible(spec, actions_of(spec, executing_atoms(rule.formula)), work))
        broken = (
            chosen
            for state in valid
            for chosen in _meant(spec, state, sets)
            if not work.holds(rule.formula, cost, state, chosen) and _applicable(spec, state, chosen, work)
        )
        if next(broken, None) is None and not all(
            work.holds(rule.formula, cost, state, chosen)
            for state in all_states(spec)
            for chosen in _meant(spec, state, sets)
        ):
            yield idle_rule(rule, SETS)


def _actions(spec: Spec, valid: States, work: _Work) -> Iterator[Diagnostic]:
    """With an allowed set, the action and those of the set that reaction rules speak of are allowed as well.

    Where none of these has effects, they may need one of the others, which restores safety.
    """
    executing = (executing_atoms(rule.formula) for rule in spec.reaction_rules)
    mentioned = actions_of(spec, frozenset[int]().union(*executing))
    acting = frozenset(number for number, cases in enumerate(spec.cases) if takes_effect(spec, frozenset(cases)))
    for number, cases in enumerate(spec.cases):
        alone = frozenset((number,))
        sets = [chosen | alone for chosen in _compatible(spec, mentioned - alone, work)]
        if not all(spec.actions[case].effects for case in cases):
            idle = [chosen for chosen in sets if not (chosen - alone) & acting]
            sets += [chosen | {other} for chosen in idle for other in sorted(acting)]
        applicable = (
            state for state in valid if _applicable(spec, state, frozenset((case_in(spec, number, state),)), work)
        )
        if not any(
            _is_allowed(spec, state, chosen, work) for state in applicable for chosen in _meant(spec, state, sets)
        ):
            yield idle_action(spec.actions[cases[0]])


def _is_allowed(spec: Spec, state: State, chosen: ActionSet, work: _Work) -> bool:
    """`Ok(s, A)`; the outcomes, of which there may be very many, are counted before they are looked at."""
    work.spend(_cost(spec.reaction_rules))
    if not all(holds(rule.formula, state, chosen) for rule in spec.reaction_rules):
        return False
    if not _applicable(spec, state, chosen, work):
        return False
    ways = prod(1 + len(spec.actions[number].effects) for number in chosen)
    work.spend(ways * _cost((*spec.state_rules, *spec.assumptions)))
    return allowed(spec, state, chosen, spec.ordering)


def _meant(spec: Spec, state: State, sets: Sequence[ActionSet]) -> Iterator[ActionSet]:
    """Sets of actions by the cases that are meant in a state, without those that disagree nominally."""
    if not spec.has_cases:
        yield from sets
        return
    for chosen in sets:
        cases = cases_in(spec, chosen, state)
        if nominal_agrees(spec, cases):
            yield cases


def _compatible(spec: Spec, actions: frozenset[int], work: _Work) -> Iterator[ActionSet]:
    """The sets of some actions that neither share a resource nor disagree nominally, smaller ones first.

    Whether actions with cases disagree depends on the state, and is left open.
    """
    for size in range(len(actions) + 1):
        for chosen in combinations(sorted(actions), size):
            work.spend(1)
            first = frozenset(spec.cases[number][0] for number in chosen)
            held = [resource for number in first for resource in spec.actions[number].resources]
            if len(held) == len(set(held)) and (spec.has_cases or nominal_agrees(spec, first)):
                yield frozenset(chosen)


def _applicable(spec: Spec, state: State, chosen: ActionSet, work: _Work) -> bool:
    rules = [rule for number in chosen for rule in spec.actions[number].conditions]
    work.spend(_cost(rules))
    return all(holds(rule.formula, state) for rule in rules)
