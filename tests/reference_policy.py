"""The preferred policy (`docs/semantics.md`, section 6), explicit, where the preferences alone determine it."""

from __future__ import annotations

from collections.abc import Mapping

from tests.oracle import Option, World, steps_under
from tumato_symbolic.semantics import ActionSet, ActiveGoals, State, duration, reached


def reference_policy(world: World) -> dict[State, ActionSet] | None:
    """The preferred policy, or None where the preferences do not determine it state by state.

    That is where runs inside the regions of the own goals do not serve every safe state, where the decisions of the
    safe states leave an unsafe one unserved, and where the allowed sets of one region have different targets (goals
    with `executing`): there one state's best decision may lengthen or break the run of another.
    """
    if not _one_target_per_region(world):
        return None
    decided = _safe_decisions(world)
    if decided is None:
        return None
    restoring = {state: _cheapest(world, decided, state) for state in world.unsafe}
    policy = {state: option.chosen for state, option in decided.items()}
    for state, option in restoring.items():
        if option is None:
            return None
        policy[state] = option.chosen
    return policy


def _one_target_per_region(world: World) -> bool:
    """Whether the allowed sets of the safe states with the same goals all have the same set of safe states."""
    found: dict[ActiveGoals, set[frozenset[State]]] = {}
    for state in world.safe:
        targets = found.setdefault(world.gamma[state], set())
        for goal in {option.goal for option in world.options[state]}:
            targets.add(frozenset(safe for safe in world.safe if reached(world.spec, goal, safe)))
    return all(len(targets) == 1 for targets in found.values())


def _safe_decisions(world: World) -> dict[State, Option] | None:
    """In each safe state the first option (fewest actions, declared first) of fewest steps inside the region."""
    steps: dict[State, int] = {}
    decided: dict[State, Option] = {}
    for count in range(1, world.bound + 1):
        undecided = [state for state in world.safe if state not in decided]
        layer = {state: option for state in undecided for option in _ends(world, state, steps, count)}
        decided.update(layer)
        steps.update(dict.fromkeys(layer, count))
    return decided if len(decided) == len(world.safe) else None


def _ends(world: World, state: State, steps: Mapping[State, int], count: int) -> list[Option]:
    """The first option of `state` that reaches its goal in `count` steps, if there is one."""
    for option in world.options[state]:
        if reached(world.spec, option.goal, option.after):
            needed = 1
        elif world.gamma[option.after] == world.gamma[state] and option.after in steps:
            needed = 1 + steps[option.after]
        else:
            continue
        if needed == count:
            return [option]
    return []


def _cheapest(world: World, decided: Mapping[State, Option], state: State) -> Option | None:
    """The serving option of smallest duration, then fewest steps, then fewest actions, then declared first."""
    serving = [(option, steps) for option in world.options[state] if (steps := steps_under(world, decided, option))]
    return min(serving, key=lambda pair: (duration(world.spec, pair[0].chosen), pair[1]), default=(None, 0))[0]
