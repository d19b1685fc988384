"""Whether a certificate of unrealizability is a proof: every line of `docs/certificate.md`, state by state."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from tests.oracle import World
from tumato_symbolic.policy.unrealizability import Conflict, Cut, Layers, NoPlan
from tumato_symbolic.semantics import Residual, State, reached
from tumato_symbolic.spec import Spec, canonical_text

Pick = tuple[int, int]


def named(spec: Spec, bodies: Sequence[str], executed: Sequence[str]) -> Residual:
    """The residual goal of these names."""
    numbers = {canonical_text(spec, rule.formula): number for number, rule in enumerate(spec.bodies)}
    actions = [action.name for action in spec.actions]
    return Residual(frozenset(numbers[text] for text in bodies), frozenset(map(actions.index, executed)))


def layers_are_proof(world: World, reason: NoPlan) -> bool:
    """The four obligations on layers."""
    goals = {named(world.spec, goal.bodies, goal.executed): goal for goal in reason.goals}
    return (
        reason.state in world.options
        and all(option.goal in goals for option in world.options[reason.state])
        and all(_hold_all_runs(world, reason, goal, layers) for goal, layers in goals.items())
    )


def _hold_all_runs(world: World, reason: NoPlan, goal: Residual, layers: Layers) -> bool:
    bound = world.spec.max_plan_length
    sets = [{t for t in world.safe if reason.diagram.evaluate(root, t)} for root in layers.roots]
    if not sets or any(o.after not in sets[0] for o in world.options[reason.state] if o.goal == goal):
        return False
    for number, layer in enumerate(sets, 1):
        if any(reached(world.spec, goal, state) for state in layer):
            return False
        follows = set[State]().union(*sets[: number + 1])
        is_free = number == len(sets) and bound is not None and number >= bound
        if not is_free and any(option.after not in follows for state in layer for option in world.options[state]):
            return False
    return True


class ConflictTruth:
    """The six checks of a conflict."""

    def __init__(self, world: World, reason: Conflict) -> None:
        self.world, self.reason = world, reason
        self.bound = math.inf if world.spec.max_plan_length is None else world.spec.max_plan_length
        self.goals = [(named(world.spec, goal.bodies, goal.executed), goal.root) for goal in reason.goals]

    def is_proof(self) -> bool:
        """All of them."""
        reason = self.reason
        if any(choice.state not in self.world.options for choice in reason.choices):
            return False
        if not all(map(self._is_lower_bound, {root for _, root in self.goals})) or not self._options_are_complete():
            return False
        clauses = [self._clause(cut) for cut in reason.cuts]
        return None not in clauses and not self._some_choice([clause for clause in clauses if clause is not None], {})

    def far(self, root: int, state: State) -> float:
        """`D`: null is infinite, and with a bound everything from there on is the bound."""
        found = self.reason.distances.evaluate(root, state)
        return min(self.bound, math.inf if found is None else found)

    def near(self, root: int, state: State, steps: int) -> bool:
        """The goal is near enough after so many steps."""
        far = self.far(root, state)
        return far < math.inf and steps + far <= self.bound

    def _is_lower_bound(self, root: int) -> bool:
        goals = [goal for goal, mine in self.goals if mine == root]
        at_goal = [s for s in self.world.safe if any(reached(self.world.spec, goal, s) for goal in goals)]
        steps = [(s, option.after) for s in self.world.safe for option in self.world.options[s]]
        return all(self.far(root, s) == 0 for s in at_goal) and all(
            self.far(root, before) <= self.far(root, after) + 1 for before, after in steps
        )

    def _options_are_complete(self) -> bool:
        roots: dict[Residual, set[int]] = {}
        for goal, root in self.goals:
            roots.setdefault(goal, set()).add(root)
        for choice in self.reason.choices:
            listed = {(after, self.reason.goals[goal].root) for after, goal in choice.options}
            for option in self.world.options[choice.state]:
                if not any((option.after, root) in listed for root in roots.get(option.goal, ())):
                    return False
        return True

    def _clause(self, cut: Cut) -> set[Pick] | None:
        """The picks of which every policy makes one; None where the cut is none."""
        reason, root = self.reason, self.reason.goals[cut.goal].root
        if cut.states[0] not in reason.starts:
            return None
        states = [reason.choices[place].state for place in cut.states]
        first = enumerate(reason.choices[cut.states[0]].options)
        picks = {(cut.states[0], number) for number, (_, goal) in first if reason.goals[goal].root != root}
        if cut.kind == "path":
            assert cut.end is not None
            if any(self.far(root, state) == 0 for state in states[1:]) or self.near(root, cut.end, len(states)):
                return None
            following = [*states[1:], cut.end]
            return picks | {
                (place, number)
                for steps, place in enumerate(cut.states, 1)
                for number, (after, _) in enumerate(reason.choices[place].options)
                if after != following[steps - 1] and self.near(root, after, steps)
            }
        return picks | {
            (place, number)
            for place in cut.states
            for number, (after, _) in enumerate(reason.choices[place].options)
            if self.far(root, after) == 0 or (after not in states and self.near(root, after, 1))
        }

    def _some_choice(self, clauses: list[set[Pick]], made: dict[int, int]) -> bool:
        """Whether one option everywhere meets all clauses: by trying the picks of a clause that is not met yet."""
        if not all(choice.options for choice in self.reason.choices):
            return False
        open_clause = next((c for c in clauses if not any(made.get(place) == n for place, n in c)), None)
        if open_clause is None:
            return True
        return any(
            self._some_choice(clauses, {**made, place: number})
            for place, number in sorted(open_clause)
            if place not in made
        )


def is_proof(world: World, reason: Conflict | NoPlan) -> bool:
    """Whether a reason proves what it claims."""
    return ConflictTruth(world, reason).is_proof() if isinstance(reason, Conflict) else layers_are_proof(world, reason)


def first_layers(world: World, reason: NoPlan, layers: Layers) -> Iterator[tuple[State, int]]:
    """Every safe state that is in a layer, with the number of the first one, from 0 on."""
    for state in world.safe:
        for number, root in enumerate(layers.roots):
            if reason.diagram.evaluate(root, state):
                yield state, number
                break
