"""What could be added so that there is a policy: settings, actions that are missing, goals that give way."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, islice
from typing import TypeAlias

from tumato_symbolic.explain.additions import (
    Addition,
    NewAction,
    NoGoalWhile,
    Setting,
    every_state,
    with_additions,
    within,
)
from tumato_symbolic.explain.cores import Failing, failing_states
from tumato_symbolic.explain.cubes import StateCube
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable
from tumato_symbolic.spec import Assignment, Restoration, Spec
from tumato_symbolic.symbolic import Bdd

MOST_ACTIONS = 8
"""So many actions are tried one by one at most."""

MOST_ADDED = 5
"""A repair that adds more is of no practical use."""

PAIR = 2
MOST_PAIRED = 5
"""Where additions that are found one by one are none, or more than two, every two of so many actions are tried."""

Among: TypeAlias = Callable[[Spec, Iterable[NewAction]], Iterator[NewAction]]
"""Those of some actions that may be added to a specification."""

_SETTINGS: dict[Restoration, tuple[Setting, ...]] = {
    "one_step": (Setting("bounded"), Setting("fair")),
    "bounded": (Setting("fair"),),
    "fair": (),
}


@dataclass(frozen=True)
class Trouble:
    """A specification and the states that fail in it."""

    requirements: Requirements
    failing: Failing

    @classmethod
    def of(cls, oracle: FailingStates) -> Trouble:
        """What fails in the specification of an oracle; with starts, where these may lead."""
        requirements, found = oracle.requirements, failing_states(oracle)
        return cls(requirements, found.among(_following(requirements)) if requirements.spec.starts else found)

    @property
    def spec(self) -> Spec:
        """The specification."""
        return self.requirements.spec

    @property
    def unrestored(self) -> Bdd:
        """The states that fail already because nothing is allowed, or leads back to safety."""
        return self.failing.no_allowed_set | self.failing.no_restoration

    @property
    def states(self) -> Bdd:
        """All states that fail."""
        return self.unrestored | self.failing.no_plan


def _following(requirements: Requirements) -> Bdd:
    """The starts, and states to which single effects of what is allowed lead from there on."""
    encoding, manager = requirements.encoding, requirements.manager
    steps = requirements.steps(requirements.everything)
    acting = [
        (encoding.assignment_bits(effect), steps.states_of(steps.allowed & encoding.executing(number)))
        for number, action in enumerate(requirements.spec.actions)
        for effect in action.effects
    ]
    found = new = requirements.starts
    while new != requirements.false:
        manager.context.check()
        led = (manager.exists([*bits], new & states) & manager.cube(bits) for bits, states in acting)
        new = manager.union(led) & steps.valid & ~found
        found = found | new
    return found


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
    actions = (_new_action(trouble, each, states) for each in joint)
    tried = [*actions, *robots_own(spec, (*missing_actions(trouble, states), *unhelpful_actions(trouble, states)))]
    tried = [*_others_than(spec, tried)][:MOST_ACTIONS]
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
        yield _new_action(trouble, (effect,), states)


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


def _new_action(trouble: Trouble, effects: Assignment, states: Bdd) -> NewAction:
    """An action with these effects that starts where they help some states."""
    return NewAction(_condition(trouble, effects, _helped(trouble, effects, states)), effects)


def _condition(trouble: Trouble, effects: Assignment, states: Bdd) -> StateCube | None:
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


def _others_than(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """The actions with other effects than all that are there: to change one of these would say the same."""
    known = {action.nominal for action in spec.actions}
    return (action for action in actions if action.effects not in known)


def robots_new(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """Those of its own with other effects than all actions that it has."""
    return _others_than(spec, robots_own(spec, actions))


def any_action(_: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """All of them, those for variables that no action controls too."""
    return iter(actions)


def robots_own(spec: Spec, actions: Iterable[NewAction]) -> Iterator[NewAction]:
    """Those that set no variable that no action controls."""
    return (action for action in actions if not environment_of(spec, action))


def environment_of(spec: Spec, action: NewAction) -> frozenset[int]:
    """The variables that a new action changes, and no action of the specification does."""
    return spec.environment & {variable for variable, _ in action.effects}


def goals_that_give_way(trouble: Trouble) -> NoGoalWhile | None:
    """Values of the environment while which no goal need be met, so that no state is without a plan.

    As few as can be found, and those first of whose states most have none. None where they do not cover all of these,
    or where some goal would never be active.
    """
    requirements, spec = trouble.requirements, trouble.spec
    encoding, false, left = requirements.encoding, requirements.false, trouble.failing.no_plan
    if left == false or spec.goals is None:
        return None
    literals = {
        (variable, value): encoding.value(variable, value) & requirements.valid
        for variable in sorted(spec.environment)
        for value in range(len(spec.variables[variable].values))
    }

    def share(some: Bdd, states: Bdd) -> float:
        return encoding.count_states(some) / encoding.count_states(states)

    chosen: list[tuple[int, int]] = []
    while left != false:
        shares = {
            literal: (share(states & left, states), share(states & trouble.failing.no_plan, states))
            for literal, states in literals.items()
            if states & left != false
        }
        if not shares:
            return None
        chosen.append(max(shares, key=lambda literal: (shares[literal], (-literal[0], -literal[1]))))
        left = left & ~literals[chosen[-1]]
    chosen = _needed(chosen, {literal: literals[literal] & trouble.failing.no_plan for literal in chosen}, requirements)
    if _silences_a_goal(requirements, requirements.manager.union(literals[literal] for literal in chosen)):
        return None
    variables = sorted({variable for variable, _ in chosen})
    return NoGoalWhile(tuple((each, tuple(sorted(value for v, value in chosen if v == each))) for each in variables))


def values_that_take_goals(trouble: Trouble) -> Iterator[NoGoalWhile]:
    """For each variable of the environment, the value of whose states most have no plan: no goal need be met then.

    Not where some goal would never be active. Those that cover only some of the states without a plan are told too.
    """
    requirements, count = trouble.requirements, trouble.requirements.encoding.count_states
    for variable in sorted(trouble.spec.environment):
        shares = {}
        for value in range(len(trouble.spec.variables[variable].values)):
            states = requirements.encoding.value(variable, value) & requirements.valid
            if states & trouble.failing.no_plan != requirements.false and not _silences_a_goal(requirements, states):
                shares[value] = count(states & trouble.failing.no_plan) / count(states)
        if shares:
            yield NoGoalWhile(((variable, (max(shares, key=lambda value: (shares[value], -value)),)),))


def _silences_a_goal(requirements: Requirements, states: Bdd) -> bool:
    """Whether some goal is active in these states alone."""
    active = [(body, region) for bodies, region in requirements.regions.items() for body in bodies]
    lasting = {body for body, region in active if region & ~states != requirements.false}
    return not lasting.issuperset(body for body, _ in active)


def _needed(
    chosen: Sequence[tuple[int, int]], covered: dict[tuple[int, int], Bdd], requirements: Requirements
) -> list[tuple[int, int]]:
    """Those of some literals without which something is not covered."""
    kept = list(chosen)
    for literal in chosen:
        others = requirements.manager.union(covered[other] for other in kept if other != literal)
        if covered[literal] & ~others == requirements.false:
            kept.remove(literal)
    return kept


def narrowed(trouble: Trouble, additions: tuple[Addition, ...]) -> tuple[Addition, ...]:
    """The same with the strictest conditions on where new actions start that were tried and serve."""
    if _serve(trouble, additions):
        return additions
    wider = tuple(
        NewAction(_condition(trouble, each.effects, trouble.states), each.effects)
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
