"""Questions turned into policies, for engines that say no more than which properties a policy has."""

from __future__ import annotations

from msgspec.structs import replace

from tests.generate import NOWHERE
from tests.semantics.build import rules
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import (
    Action,
    Alternative,
    Assignment,
    Executing,
    GoalList,
    Is,
    Not,
    Or,
    SimpleGoal,
    Spec,
    Variable,
)


def as_rival(spec: Spec, state: State, chosen: ActionSet) -> tuple[Spec, State, ActionSet]:
    """A specification, an unsafe state and a decision there that is *not minimal* just where `Ok(state, chosen)`.

    A fault is added that every effect of `chosen` repairs, and a long action that repairs it alone. While there is a
    fault, no other set may be executed than `chosen`, which therefore is the only one that can be better. Some action
    of `chosen` has effects: without, no fault is repaired.
    """
    fault, helper = len(spec.variables), len(spec.actions)
    fixed = Is(fault, 0)
    actions = [_repairing(a, fault) if number in chosen and a.effects else a for number, a in enumerate(spec.actions)]
    longer = 1 + sum(action.duration for action in spec.actions)
    only = [Executing(n) if n in chosen else Not(Executing(n)) for n in range(helper + 1)]
    turned = replace(
        spec,
        variables=(*spec.variables, Variable("fault", ("no", "yes"), NOWHERE)),
        actions=(*actions, Action("helper", longer, frozenset(), (), ((fault, 0),), (), NOWHERE)),
        state_rules=(*spec.state_rules, *rules(fixed)),
        reaction_rules=(*spec.reaction_rules, *rules(*(Or((fixed, each)) for each in only))),
        goals=None,
        bodies=(),
        max_plan_length=None,
    )
    return turned, (*state, 1), frozenset((helper,))


def _repairing(action: Action, fault: int) -> Action:
    def also(effect: Assignment) -> Assignment:
        return (*effect, (fault, 0))

    entries = [Alternative(tuple(map(also, each.outcomes)), each.text, each.span) for each in action.alternatives]
    return replace(action, nominal=also(action.nominal), alternatives=tuple(entries))


def arriving(spec: Spec, variable: int, value: int) -> Spec:
    """The specification whose only goal is one value after one step, and in which every state is safe."""
    bodies = rules(Is(variable, value))
    goal = GoalList("constraint", (SimpleGoal(0, bodies[0].text, NOWHERE),), NOWHERE)
    return replace(_lawless(spec), goals=goal, bodies=bodies, max_plan_length=1)


def jumping(spec: Spec, chosen: ActionSet, there: State) -> tuple[Spec, ActionSet]:
    """A specification and a set that leads to `there` in one step, with the residual goal that `chosen` leaves.

    A goal is to be met at once, the actions of `chosen` change nothing, and one more action jumps.
    """
    still = [
        replace(a, nominal=(), alternatives=(), preconditions=(), resources=frozenset()) if n in chosen else a
        for n, a in enumerate(spec.actions)
    ]
    jump = Action("jump", 0, frozenset(), (), tuple(enumerate(there)), (), NOWHERE)
    turned = replace(_lawless(spec), actions=(*still, jump), max_plan_length=1)
    return turned, chosen | {len(still)}


def _lawless(spec: Spec) -> Spec:
    return replace(spec, state_rules=(), reaction_rules=(), assumptions=())
