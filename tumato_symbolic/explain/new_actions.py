"""Actions that a specification lacks: those that lead most of its failing states to where none fail."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.explain.additions import NewAction, every_state, within
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.trouble import Trouble
from tumato_symbolic.spec import Assignment, Spec
from tumato_symbolic.symbolic import Bdd


def missing_actions(trouble: Trouble, states: Bdd) -> Iterator[NewAction]:
    """For each variable an action that sets it to the value that leads most of some states to where these do not lead.

    Those of the environment come last; then the other values. Of values that do as much, one that leads to safe states
    comes first, then one that some action sets alone.
    """
    spec, encoding = trouble.spec, trouble.requirements.encoding
    alone = {action.nominal for action in spec.actions}
    ranked = []
    for variable, declared in enumerate(spec.variables):
        for value in range(len(declared.values)):
            effects = ((variable, value),)
            count = encoding.count_states(_helped(trouble, effects, states))
            if count:
                safely = encoding.count_states(_helped(trouble, effects, states, safely=True))
                ranked.append((variable in spec.environment, -count, -safely, effects not in alone, variable, value))
    first, others = dict[int, int](), list[tuple[int, int]]()
    for *_, variable, value in sorted(ranked):
        if variable in first:
            others.append((variable, value))
        else:
            first[variable] = value
    for effect in (*first.items(), *others):
        yield new_action(trouble, (effect,), states)


def unhelpful_actions(trouble: Trouble, states: Bdd) -> Iterator[NewAction]:
    """The actions that set one variable and help none of some states at once: perhaps later, on the way to a goal."""
    for variable, declared in enumerate(trouble.spec.variables):
        for value in range(len(declared.values)):
            effects = ((variable, value),)
            if _helped(trouble, effects, states) == trouble.requirements.false:
                yield NewAction(None, effects)


def _helped(trouble: Trouble, effects: Assignment, states: Bdd, *, safely: bool = False) -> Bdd:
    """Those of some states that effects lead to a state that none of them is, and that is safe where it has to be.

    `safely`: to a safe one, be that needed or not.
    """
    requirements = trouble.requirements
    steps = requirements.steps(requirements.everything)
    good = (steps.valid if trouble.spec.restores_stepwise and not safely else steps.safe) & ~states
    return states & requirements.manager.cofactor(good, requirements.encoding.assignment_bits(effects))


def new_action(trouble: Trouble, effects: Assignment, states: Bdd) -> NewAction:
    """An action with these effects that starts where they help some states."""
    return NewAction(values_in(trouble, effects, _helped(trouble, effects, states)), effects)


def values_in(trouble: Trouble, effects: Assignment, states: Bdd) -> StateCube | None:
    """The values that occur in some states; of variables of the environment only where the effects write them."""
    spec, encoding, false = trouble.spec, trouble.requirements.encoding, trouble.requirements.false
    if states == false:
        return None
    condition = every_state(spec)
    for variable, values in enumerate(condition):
        if variable not in spec.environment or variable in dict(effects):
            kept = tuple(value for value in values if states & encoding.value(variable, value) != false)
            condition = within(condition, variable, kept)
    return None if condition == every_state(spec) else condition


def others_than(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """The actions with other effects than all that are there: to change one of these would say the same."""
    known = {action.nominal for action in spec.actions}
    return (action for action in actions if action.effects not in known)


def robots_new(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """Those of its own with other effects than all actions that it has."""
    return others_than(spec, robots_own(spec, actions))


def any_action(_: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """All of them, those for variables that no action controls too."""
    return iter(actions)


def robots_own(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """Those that set no variable that no action controls."""
    return (action for action in actions if not environment_of(spec, action))


def environment_of(spec: Spec, action: NewAction) -> frozenset[int]:
    """The variables that a new action changes, and no action of the specification does."""
    return spec.environment & {variable for variable, _ in action.effects}
