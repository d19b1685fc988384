"""What may be executed together, and where it leads (`docs/semantics.md`, section 3)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics.states import ActionSet, State, apply, holds, required_rules
from tumato_symbolic.spec import Assignment, Ordering, Rule, Spec


class EffectStep(Struct, frozen=True):
    """One action taking one of its effects, and the state after it."""

    action: int
    effect: Assignment
    after: State


EffectSequence: TypeAlias = tuple[EffectStep, ...]
"""How a state was reached: effects in the order in which they happened. Empty where no action has effects."""


def outcomes(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> dict[State, EffectSequence]:
    """`Out(s, A)`: every state that the step can lead to, each with one shortest way of getting there.

    Under `any`: after every non-empty sequence of distinct actions of `chosen`, each with any one of its effects.
    Under `first`: after one action with any one of its effects. A set whose actions have no effects, as the empty
    one, leads to `state` itself.
    """
    return dict(outcomes_in_turn(spec, state, chosen, ordering))


def outcomes_in_turn(
    spec: Spec, state: State, chosen: ActionSet, ordering: Ordering
) -> Iterator[tuple[State, EffectSequence]]:
    """`outcomes` one by one, the shortest ways first: there may be too many to wait for."""
    if not takes_effect(spec, chosen):
        yield state, ()
        return
    reached: set[State] = set()
    for there, _, way in _in_turn(spec, state, chosen, ordering):
        if there not in reached:
            reached.add(there)
            yield there, way


def _in_turn(
    spec: Spec, state: State, chosen: ActionSet, ordering: Ordering
) -> Iterator[tuple[State, ActionSet, EffectSequence]]:
    """The states that effects lead to, each with the actions that have not taken effect then, shortest ways first."""
    seen: set[tuple[State, ActionSet]] = set()
    frontier: list[tuple[State, ActionSet, EffectSequence]] = [(state, chosen, ())]
    while frontier:
        following: list[tuple[State, ActionSet, EffectSequence]] = []
        for here, waiting, past in frontier:
            for action in sorted(waiting):
                rest = waiting - {action}
                for effect in spec.actions[action].effects:
                    there = apply(effect, here)
                    if (there, rest) not in seen:
                        seen.add((there, rest))
                        way = (*past, EffectStep(action, effect, there))
                        following.append((there, rest, way))
                        yield there, rest, way
        frontier = following if ordering == "any" else []


def takes_effect(spec: Spec, chosen: ActionSet) -> bool:
    """Whether some action of `chosen` has effects; the others never take effect and add no outcome."""
    return any(spec.actions[action].effects for action in chosen)


def nominal_agrees(spec: Spec, chosen: ActionSet) -> bool:
    """Whether no variable is given two different values by the nominal effects of `chosen`."""
    written: dict[int, int] = {}
    for action in chosen:
        for variable, value in spec.actions[action].nominal:
            if written.setdefault(variable, value) != value:
                return False
    return True


def successor(spec: Spec, state: State, chosen: ActionSet) -> State:
    """`δ(s, A)`: all nominal effects of `chosen` at once; they must agree."""
    for action in chosen:
        state = apply(spec.actions[action].nominal, state)
    return state


def replay(state: State, steps: Iterable[tuple[int, Assignment]]) -> EffectSequence:
    """The states met when effects, each of an action, happen in this order."""
    way = list[EffectStep]()
    for action, effect in steps:
        state = apply(effect, state)
        way.append(EffectStep(action, effect, state))
    return tuple(way)


class Objection(Struct, frozen=True):
    """Why a set is not allowed: the first condition of section 3 that fails, with what it fails on.

    `actions` are those to blame, `rule` the user's precondition or rule that is broken, and `outcome` the way into
    the unsafe state (kinds `unsafe` and `nominal-unsafe`; empty when it is the state itself that is unsafe). There, the
    rule is None where all rules hold, and the state is outside of the part that a policy decides. Kind
    `falsified`: the precondition `rule` of an action, which has not taken effect yet, does not hold after `outcome`.
    """

    kind: Literal[
        "precondition", "resource", "nominal-conflict", "reaction-rule", "unsafe", "falsified", "nominal-unsafe"
    ]
    actions: tuple[int, ...]
    rule: Rule | None = None
    outcome: EffectSequence = ()
    state: State | None = None


def objections(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> Iterator[Objection]:
    """Every reason why `chosen` is not allowed in `state`, in the order of section 3; none when it is."""
    for number in sorted(chosen):
        broken = [rule for rule in spec.actions[number].preconditions if not holds(rule.formula, state)]
        yield from (Objection("precondition", (number,), rule) for rule in broken)
        guard = spec.actions[number].guard
        if guard is not None and not broken and not holds(guard.formula, state):
            yield Objection("precondition", (number,), guard)
    for first, second in combinations(sorted(chosen), 2):
        if spec.actions[first].resources & spec.actions[second].resources:
            yield Objection("resource", (first, second))
        if not nominal_agrees(spec, frozenset((first, second))):
            yield Objection("nominal-conflict", (first, second))
    for rule in spec.reaction_rules:
        if not holds(rule.formula, state, chosen):
            yield Objection("reaction-rule", tuple(sorted(chosen)), rule)
    required = required_rules(spec, state)
    for reached, way in outcomes_in_turn(spec, state, chosen, ordering):
        fault = first_broken(required, reached)
        if fault is not None:
            yield Objection("unsafe", tuple(sorted(chosen)), _written(spec, fault), way, reached)
    if spec.preconditions == "throughout":
        yield from falsified(spec, state, chosen, ordering)
    if nominal_agrees(spec, chosen):
        end = successor(spec, state, chosen)
        fault = first_broken(required, end)
        if fault is not None:
            yield Objection("nominal-unsafe", tuple(sorted(chosen)), _written(spec, fault), (), end)


def _written(spec: Spec, broken: Rule) -> Rule | None:
    """A broken rule, if it is one that the user wrote."""
    return None if broken is spec.part else broken


def falsified(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> Iterator[Objection]:
    """Preconditions of actions that have not taken effect, where others falsify them; each once, by a shortest way."""
    told: set[tuple[int, Rule]] = set()
    for there, waiting, way in _in_turn(spec, state, chosen, ordering):
        for number in sorted(waiting):
            for rule in spec.actions[number].preconditions:
                if (number, rule) not in told and not holds(rule.formula, there):
                    told.add((number, rule))
                    yield Objection("falsified", (number,), rule, way, there)


def fault_after(spec: Spec, state: State, chosen: ActionSet, way: EffectSequence) -> Objection | None:
    """What is wrong when `chosen` is executed in `state` and effects have happened in this way, if anything is."""
    end = way[-1].after
    broken = first_broken(required_rules(spec, state), end)
    if broken is not None:
        return Objection("unsafe", tuple(sorted(chosen)), _written(spec, broken), way, end)
    waiting = chosen - {step.action for step in way} if spec.preconditions == "throughout" else frozenset[int]()
    for number in sorted(waiting):
        broken = first_broken(spec.actions[number].preconditions, end)
        if broken is not None:
            return Objection("falsified", (number,), broken, way, end)
    return None


def pending(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> Iterator[tuple[State, ActionSet]]:
    """The states that effects lead to, each with the actions that have not taken effect then."""
    return ((there, waiting) for there, waiting, _ in _in_turn(spec, state, chosen, ordering))


def next_states(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> set[State]:
    """`Next(s, A)`: every state in which the next decision may be taken; nominal effects must agree."""
    return {*outcomes(spec, state, chosen, ordering), successor(spec, state, chosen)}


def broken_rule(spec: Spec, state: State) -> Rule | None:
    """The first assumption or state rule that `state` breaks; None in a safe state."""
    return first_broken((*spec.assumptions, *spec.state_rules, *spec.in_part), state)


def first_broken(rules: Iterable[Rule], state: State) -> Rule | None:
    """The first of some rules that `state` breaks, if there is one."""
    return next((rule for rule in rules if not holds(rule.formula, state)), None)


def allowed(spec: Spec, state: State, chosen: ActionSet, ordering: Ordering) -> bool:
    """`Ok(s, A)`; where safety may be restored in several steps, `Keep(s, A)`."""
    return next(objections(spec, state, chosen, ordering), None) is None


def allowed_sets(spec: Spec, state: State, ordering: Ordering) -> Iterator[ActionSet]:
    """Every allowed set of actions in `state`: smaller sets first, then as declared. Exponential, by definition."""
    applicable = [
        number
        for number, action in enumerate(spec.actions)
        if all(holds(rule.formula, state) for rule in action.conditions)
    ]
    for size in range(len(applicable) + 1):
        for chosen in combinations(applicable, size):
            if allowed(spec, state, frozenset(chosen), ordering):
                yield frozenset(chosen)
