"""Which case of an action is meant in a state (`docs/semantics.md`, section 2)."""

from __future__ import annotations

from collections.abc import Iterable

from msgspec.structs import replace

from tumato_symbolic.semantics.states import ActionSet, State, holds
from tumato_symbolic.spec import FORMULAS, Executing, Formula, Is, Rule, Spec, executing_actions, fold


def case_in(spec: Spec, action: int, state: State) -> int:
    """The case of an action, by its number in the order of declaration, that is meant in a state.

    The first one where none is: there, the preconditions of the action do not hold.
    """
    cases = spec.cases[action]
    return next((case for case in cases if _is_meant(spec, case, state)), cases[0])


def cases_in(spec: Spec, actions: Iterable[int], state: State) -> ActionSet:
    """The cases of several actions that are meant in a state."""
    if not spec.has_cases:
        return frozenset(actions)
    return frozenset(case_in(spec, action, state) for action in actions)


def actions_of(spec: Spec, chosen: Iterable[int]) -> ActionSet:
    """The actions of which a set has a case, by their numbers in the order of declaration."""
    return frozenset(map(spec.action_of, chosen)) if spec.has_cases else frozenset(chosen)


def without_cases(spec: Spec, state: State) -> Spec:
    """What a specification says of one state: each action has one case, the one that is meant there."""
    if not spec.has_cases:
        return spec

    def atom(atom: Is | Executing) -> Formula:
        return atom if isinstance(atom, Is) else Executing(spec.action_of(atom.action))

    def rules(given: tuple[Rule, ...]) -> tuple[Rule, ...]:
        found = ((rule, executing_actions(spec, rule.formula)) for rule in given)
        return tuple(replace(rule, formula=fold(formula, atom, FORMULAS)) for rule, formula in found)

    actions = tuple(spec.actions[case_in(spec, action, state)] for action in range(len(spec.cases)))
    return replace(spec, actions=actions, reaction_rules=rules(spec.reaction_rules), bodies=rules(spec.bodies))


def _is_meant(spec: Spec, case: int, state: State) -> bool:
    guard = spec.actions[case].guard
    return guard is None or holds(guard.formula, state)
