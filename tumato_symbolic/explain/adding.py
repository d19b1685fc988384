"""Which additions are tried, alone and together: settings, actions that are missing, goals that give way."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations, islice
from typing import TypeAlias

from tumato_symbolic.explain.additions import (
    Addition,
    NewAction,
    Setting,
    with_additions,
)
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.giving_way import goals_that_give_way, values_that_take_goals
from tumato_symbolic.explain.new_actions import (
    environment_of,
    missing_actions,
    new_action,
    others_than,
    robots_own,
    unhelpful_actions,
    values_in,
)
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable
from tumato_symbolic.explain.trouble import Trouble
from tumato_symbolic.spec import Assignment, Restoration, Spec

MOST_ACTIONS = 8
"""So many actions are tried one by one at most."""

MOST_ADDED = 5
"""A repair that adds more is of no practical use."""

PAIR = 2
"""Additions that need no more than so many are taken as they are found."""

MOST_PAIRED = 5
"""Where additions that are found one by one are none, or more than two, every two of so many actions are tried."""

Among: TypeAlias = Callable[[Spec, Iterable[NewAction]], Iterator[NewAction]]
"""Those of some actions that may be added to a specification."""

_SETTINGS: dict[Restoration, tuple[Setting, ...]] = {
    "one_step": (Setting("bounded"), Setting("fair")),
    "bounded": (Setting("fair"),),
    "fair": (),
}
"""By the setting of a specification, the other ones that are tried in its place, the stronger first."""


def settings(spec: Spec) -> tuple[Setting, ...]:
    """What else CONFIG could say of how safety is restored, the stronger first."""
    return _SETTINGS[spec.restoration]


def single_additions(trouble: Trouble, joint: Iterable[Assignment]) -> Iterator[tuple[Addition, ...]]:
    """Of each kind the first thing that serves when it alone is added. `joint` are effects that were found to help.

    An action with the effects of one that is there is none of them: to change that one says the same. Nor is an action
    for a variable of the environment.
    """
    spec, states = trouble.spec, trouble.states
    yield from _serving(trouble, map(_alone, settings(spec)))
    actions = (new_action(trouble, each, states) for each in joint)
    tried = [*actions, *robots_own(spec, (*missing_actions(trouble, states), *unhelpful_actions(trouble, states)))]
    tried = [*others_than(spec, tried)][:MOST_ACTIONS]
    for additions in _serving(trouble, map(_alone, tried)):
        yield narrowed(trouble, additions)
    free = goals_that_give_way(trouble)
    if free is not None and _serve(trouble, (free,)):
        yield (free,)


def controlling_the_environment(trouble: Trouble) -> Iterator[tuple[Addition, ...]]:
    """An action for a variable that no action controls, where it alone serves."""
    missing = missing_actions(trouble, trouble.states)
    actions = [action for action in missing if environment_of(trouble.spec, action)][:MOST_ACTIONS]
    for additions in _serving(trouble, map(_alone, actions)):
        yield narrowed(trouble, additions)


def composed(trouble: Trouble, among: Among) -> tuple[Addition, ...] | None:
    """Several additions that serve together, of which none can be left out; None where none are found.

    `among` are the actions that may be added.
    """
    found = _needed_together(trouble, among)
    if found is None or len(found) > PAIR:
        found = _pair(trouble, among) or found
    return None if found is None else narrowed(trouble, found)


def _needed_together(trouble: Trouble, among: Among) -> tuple[Addition, ...] | None:
    """Additions that were found one after the other, without those that are not needed."""
    for start in ((), *map(_alone, settings(trouble.spec))):
        additions = _composed(trouble, start, among)
        if additions is None:
            continue
        for each in reversed(additions):
            fewer = tuple(other for other in additions if other is not each)
            if _serve(trouble, map(_anywhere, fewer)):
                additions = fewer
        return additions
    return None


def _pair(trouble: Trouble, among: Among) -> tuple[Addition, ...] | None:
    """The first two of a few actions, and goals that give way, that serve together; None where none do."""
    actions = islice(among(trouble.spec, missing_actions(trouble, trouble.states)), MOST_PAIRED)
    candidates: list[Addition] = [*values_that_take_goals(trouble), *actions]
    pairs = combinations(candidates, PAIR)
    return next((each for each in pairs if _serve(trouble, map(_anywhere, each))), None)


def _composed(trouble: Trouble, additions: tuple[Addition, ...], among: Among) -> tuple[Addition, ...] | None:
    """Some additions and more that serve with them: first what restores safety, then what reaches the goals."""
    original = trouble.requirements
    while True:
        spec = with_additions(original.spec, map(_anywhere, additions))
        if is_realizable(original, spec):
            return additions
        if len(additions) >= MOST_ADDED:
            return None
        here = Trouble.of(FailingStates(derived(original, spec)))
        unrestored = here.unrestored != here.requirements.false
        more: Addition | None = None if unrestored else goals_that_give_way(here)
        if more is None:
            missing = missing_actions(here, here.unrestored if unrestored else here.states)
            more = next(among(spec, missing), None)
        if more is None:
            return None
        additions = (*additions, more)


def derived(requirements: Requirements, spec: Spec) -> Requirements:
    """The requirements of another specification, within the same limits."""
    return Requirements(spec, requirements.ordering, requirements.manager.backend, requirements.manager.context)


def narrowed(trouble: Trouble, additions: tuple[Addition, ...]) -> tuple[Addition, ...]:
    """The same with the strictest conditions on where new actions start that were tried and serve."""
    if _serve(trouble, additions):
        return additions
    wider = tuple(
        NewAction(values_in(trouble, each.effects, trouble.states), each.effects)
        if isinstance(each, NewAction)
        else each
        for each in additions
    )
    return wider if _serve(trouble, wider) else tuple(map(_anywhere, additions))


def _anywhere(addition: Addition) -> Addition:
    """A new action without a condition; anything else as it is."""
    return NewAction(None, addition.effects) if isinstance(addition, NewAction) else addition


def _serve(trouble: Trouble, additions: Iterable[Addition]) -> bool:
    """Whether there is a policy with some additions."""
    return is_realizable(trouble.requirements, with_additions(trouble.spec, additions))


def _serving(trouble: Trouble, tried: Iterable[tuple[Addition, ...]]) -> Iterator[tuple[Addition, ...]]:
    """The first of some additions that serve when new actions may start anywhere, if any do."""
    return islice((each for each in tried if _serve(trouble, map(_anywhere, each))), 1)


def _alone(addition: Addition) -> tuple[Addition, ...]:
    return (addition,)
