"""Warnings about a text: variables and values that nothing mentions, changes or leaves; the environment's."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Set
from math import prod

from tumato_symbolic.diagnostics import Code, Diagnostic, Note
from tumato_symbolic.diagnostics.wording import count, listed, quoted
from tumato_symbolic.spec.fold import subgoals
from tumato_symbolic.spec.formula import And, Formula, Is, Not, Or, atoms, variables_of
from tumato_symbolic.spec.satisfiability import Budget, OutOfBudgetError, models, unknowns
from tumato_symbolic.spec.specification import Action, ConditionalGoal, Rule, Spec

NOT_KNOWN = "unknown"
"""A value of this name, in any case, is what a sensor says that has failed: that another is treated alike is meant."""

MAX_WORK = 500_000
"""How many terms are looked at to find out which values actions leave; what is open then is taken for left."""

MAX_DECIDED = 10_000
"""The most assignments to the variables of preconditions with which it is decided which values actions leave."""


def forgotten(spec: Spec, used_variables: Set[int]) -> Iterator[Diagnostic]:
    """Every finding; `used_variables` are those that some predicate of the text names."""
    yield from _unmentioned(spec, used_variables)
    if spec.actions:
        yield from _environment(spec, used_variables)
        yield from _kept_for_ever(spec)
        yield from _commanded(spec)


def _unmentioned(spec: Spec, used_variables: Set[int]) -> Iterator[Diagnostic]:
    """Variables, and values where names tell more than numbers: one may stand for all others that are not named."""
    mentioned = _mentioned_values(spec)
    environment = spec.environment
    for number, variable in enumerate(spec.variables):
        if number not in used_variables:
            message = f"nothing mentions the state variable {quoted(variable.name)}"
            yield Diagnostic(Code.TUM341, message, variable.span, "remove it, or say where it matters")
            continue
        texts = [text for value, text in enumerate(variable.values) if (number, value) not in mentioned]
        if all(text.lstrip("-").isdigit() for text in variable.values) or not texts:
            continue
        known = [text for text in texts if text.lower() != NOT_KNOWN]
        if len(known) > 1:
            message = f"nothing tells the values {listed(known)} of {quoted(variable.name)} apart"
            yield Diagnostic(
                Code.TUM342, message, variable.span, "one of them will do, or mention them where they matter"
            )
        elif len(texts) == 1 and len(variable.values) > 2 and number not in environment:
            message = f"nothing mentions the value {quoted(texts[0])} of {quoted(variable.name)}"
            yield Diagnostic(Code.TUM343, message, variable.span, "remove it, or mention it where it matters")


def _mentioned_values(spec: Spec) -> set[tuple[int, int]]:
    found = {pair for action in spec.actions for effect in action.effects for pair in effect}
    different = {id(rule.formula): rule.formula for rule in _rules(spec)}  # cases share their preconditions
    for formula in different.values():
        found.update((atom.variable, atom.value) for atom in atoms(formula) if isinstance(atom, Is))
    return found


def _rules(spec: Spec) -> Iterator[Rule]:
    for action in spec.actions:
        yield from action.conditions
    yield from (*spec.reaction_rules, *spec.state_rules, *spec.assumptions, *spec.starts, *spec.bodies)
    yield from _conditions(spec)


def _conditions(spec: Spec) -> Iterator[Rule]:
    return (goal.condition for goal in subgoals(spec.goals) if isinstance(goal, ConditionalGoal))


def _environment(spec: Spec, used_variables: Set[int]) -> Iterator[Diagnostic]:
    """What is the environment's, said once."""
    numbers = sorted(spec.environment & used_variables)
    if numbers:
        names = [spec.variables[number].name for number in numbers]
        they, them = ("it is", "its value") if len(names) == 1 else ("they are", "their values")
        message = f"no action changes {listed(names)}: {they} the environment's"
        way_out = f"the policy decides for all of {them}, and no plan waits for another"
        if spec.starts:
            way_out = f"no plan waits for another of {them}; with START, `synth` warns where not all are decided"
        yield Diagnostic(Code.TUM344, message, spec.variables[numbers[0]].span, way_out)


def _kept_for_ever(spec: Spec) -> Iterator[Diagnostic]:
    """Values that some action brings about and none leaves, unless goals speak of the variable."""
    aims = frozenset[int]().union(*(variables_of(rule.formula) for rule in spec.bodies))
    leaving = _Leaving(spec)
    for number, variable in enumerate(spec.variables):
        written = {value for action in spec.actions for effect in action.effects for v, value in effect if v == number}
        if number in aims or len(variable.values) < 2:
            continue
        kept = [
            text
            for value, text in enumerate(variable.values)
            if value in written and not leaving.possible(number, value)
        ]
        if kept:
            message = f"no action takes {quoted(variable.name)} away from {listed(kept, 'or')}"
            yield Diagnostic(Code.TUM345, message, variable.span, "add an action that does, if one should")


class _Leaving:
    """Which values actions can leave, within one budget."""

    def __init__(self, spec: Spec) -> None:
        self._sizes = {number: len(each.values) for number, each in enumerate(spec.variables)}
        self._budget = Budget(MAX_WORK)
        self._left: dict[int, set[int]] = {}
        for action in spec.actions:
            for variable, values in _values_written(action).items():
                self._note(action, variable, values)

    def possible(self, variable: int, value: int) -> bool:
        """Whether some action can take a variable away from a value."""
        return value in self._left.get(variable, ())

    def _note(self, action: Action, variable: int, values: set[int]) -> None:
        found = self._left.setdefault(variable, set())
        conditions = (rule.formula for rule in action.conditions)
        pinned = {each.value for each in conditions if isinstance(each, Is) and each.variable == variable}
        for value in pinned or range(self._sizes[variable]):
            if value not in found and values - {value} and self._may_start(action, variable, value):
                found.add(value)

    def _may_start(self, action: Action, variable: int, value: int) -> bool:
        formulas = [rule.formula for rule in action.conditions]
        if any(isinstance(each, Is) and each.variable == variable and each.value != value for each in formulas):
            return False
        if self._budget.is_spent:
            return True
        about = [each for each in formulas if variable in variables_of(each)]
        if not about:
            return True
        formula = And((Is(variable, value), *about))
        if prod(self._sizes[number] for kind, number in unknowns(formula) if kind == "variable") > MAX_DECIDED:
            return True
        try:
            return next(models(formula, self._sizes, self._budget), None) is not None
        except OutOfBudgetError:
            return True


def _values_written(action: Action) -> dict[int, set[int]]:
    found: dict[int, set[int]] = {}
    for effect in action.effects:
        for variable, value in effect:
            found.setdefault(variable, set()).add(value)
    return found


def _commanded(spec: Spec) -> Iterator[Diagnostic]:
    """Variables that all else only observes, and that actions of their own set, free of charge."""
    if not any(action.resources for action in spec.actions):
        return
    observed = _observed(spec)
    for number in sorted(observed):
        writing = [action for action in spec.actions if number in _values_written(action)]
        if not writing or not all(_only_sets(action, number) for action in writing):
            continue
        commanding = list(dict.fromkeys(action.name for action in writing))
        names, verb = listed(commanding), "commands" if len(commanding) == 1 else "command"
        message = f"{names} {verb} {quoted(spec.variables[number].name)}, which everything else only observes"
        way_out = "what the environment does needs no action: without one, the policy decides for every value"
        notes = (Note("it is declared here", spec.variables[number].span),)
        yield Diagnostic(Code.TUM346, message, writing[0].span, way_out, notes)


def _only_sets(action: Action, variable: int) -> bool:
    """Whether an action sets a variable and nothing else, and needs nothing else for it."""
    needed = (variables_of(rule.formula) for rule in action.conditions)
    return (
        not action.resources
        and set(_values_written(action)) == {variable}
        and all(each <= {variable} for each in needed)
    )


def _observed(spec: Spec) -> set[int]:
    """The variables that rules name in their conditions, and nothing asks for."""
    conditions, wanted = set[int](), set[int]()
    for rule in (*spec.state_rules, *spec.reaction_rules):
        match rule.formula:
            case Or((Not(condition), *consequences)):
                conditions |= variables_of(condition)
                wanted |= _variables(consequences)
            case _:
                wanted |= variables_of(rule.formula)
    wanted |= _variables(rule.formula for rule in spec.bodies)
    return conditions - wanted


def _variables(formulas: Iterable[Formula]) -> frozenset[int]:
    return frozenset[int]().union(*map(variables_of, formulas))


def joined_rules(spec: Spec) -> Iterator[Diagnostic]:
    """State rules of several parts that the text joins by AND, where safety may take several steps to restore."""
    for rule in spec.state_rules if spec.restores_stepwise else ():
        formula = rule.formula
        if isinstance(formula, Or) and len(formula.operands) == 2:
            formula = formula.operands[1]
        if isinstance(formula, And) and re.search(r"\bAND\b", rule.text.rpartition("THEN")[2]):
            parts = count(len(formula.operands), "part")
            message = f"this rule has {parts}: while one is broken, the others need not be kept"
            yield Diagnostic(Code.TUM347, message, rule.span, "write a rule for each, so that what holds is kept")
