"""A policy executed from a state: outcomes by chance or nominal, disturbances by chance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics import (
    ActionSet,
    Disturbance,
    EffectSequence,
    Event,
    Move,
    State,
    Trace,
    apply,
    is_valid,
    nominal_agrees,
    reached,
    replay,
    residual_goal,
    successor,
)
from tumato_symbolic.simulation.dice import Dice
from tumato_symbolic.spec import Ordering, Spec

Faults: TypeAlias = Literal["none", "random"]


class Simulation(Struct, frozen=True):
    """What is executed, and how: `disturb` is the probability of a disturbance after each step."""

    spec: Spec
    policy: Mapping[State, ActionSet]
    ordering: Ordering
    faults: Faults = "none"
    disturb: float = 0.0
    steps: int = 1_000


def executed(simulation: Simulation, start: State, dice: Dice) -> Trace:
    """From `start` until the goals that are active there are met, or nothing more can come.

    After a disturbance, the goals are those of the state that it led to.
    """
    spec, here, goal = simulation.spec, start, None
    events, met = list[Event](), {start: 0}
    repeats = simulation.faults == "none" and not simulation.disturb
    for _ in range(simulation.steps):
        chosen = simulation.policy.get(here)
        if chosen is None or not nominal_agrees(spec, chosen):
            return Trace(start, tuple(events), "undefined")
        goal = goal or residual_goal(spec, here, chosen)
        events.append(_move(simulation, here, chosen, dice))
        here = events[-1].after
        if reached(spec, goal, here):
            return Trace(start, tuple(events), "goal")
        if repeats and met.setdefault(here, len(events)) < len(events):
            return Trace(start, tuple(events), "loop", met[here])
        after = _disturbed(spec, here, dice) if simulation.disturb and dice.happens(simulation.disturb) else None
        if after is not None:
            events.append(Disturbance(after))
            here, goal = after, None
    return Trace(start, tuple(events), "bound")


def _move(simulation: Simulation, state: State, chosen: ActionSet, dice: Dice) -> Move:
    if simulation.faults == "none":
        return Move(chosen, successor(simulation.spec, state, chosen))
    return random_move(simulation.spec, state, chosen, simulation.ordering, dice)


def random_move(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering, dice: Dice) -> Move:
    """One of the outcomes of a set whose nominal effects agree; all of them are possible.

    Under `any` chance decides how many actions take effect before the next decision, which ones, in which order, and
    by which of their effects; under `first`, whether one alone takes effect, which and how, or all nominally.
    """
    acting = dice.shuffled([action for action in sorted(chosen) if spec.actions[action].effects])
    nominal = successor(spec, state, chosen)
    if ordering == "any":
        acting = acting[: 1 + dice.below(len(acting))] if acting else []
    else:
        acting = acting[:1] if len(acting) < 2 or dice.happens(0.5) else []
    after, way = _effects_of(spec, state, acting, dice)
    return Move(chosen, nominal) if not way or after == nominal else Move(chosen, after, way)


def _effects_of(spec: Spec, state: State, acting: list[int], dice: Dice) -> tuple[State, EffectSequence]:
    """The effects of some actions, one after the other, and the state after them."""
    way = replay(state, ((action, dice.one_of(spec.actions[action].effects)) for action in acting))
    return way[-1].after if way else state, way


def _disturbed(spec: Spec, state: State, dice: Dice) -> State | None:
    """With one variable changed to another value; None where no such state is valid."""
    changes = [
        (number, value)
        for number, variable in enumerate(spec.variables)
        for value in range(len(variable.values))
        if value != state[number]
    ]
    changed = (apply((change,), state) for change in dice.shuffled(changes))
    return next((each for each in changed if is_valid(spec, each)), None)
