"""An explicit, exact decision of realizability, from `tumato_symbolic.semantics` and a SAT encoding alone."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property, lru_cache
from typing import Literal, TypeAlias

import z3
from msgspec import Struct

from tumato_symbolic.semantics import (
    ActionSet,
    ActiveGoals,
    Residual,
    State,
    active_goals,
    all_states,
    allowed_sets,
    is_safe,
    is_valid,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec


class Option(Struct, frozen=True):
    """One allowed set of a state: the nominal successor, and the residual goal that it leaves."""

    chosen: ActionSet
    after: State
    goal: Residual


Kind: TypeAlias = Literal["realizable", "failing", "conflict"]


class OracleVerdict(Struct, frozen=True):
    """The truth about a specification.

    `no_allowed_set` and `no_plan` are the failing states by kind (`docs/semantics.md`, section 7); `conflict` means
    that none fails and there is no policy all the same. `own_region` tells whether runs that stay where the state's
    own goals are active, found layer by layer, serve every safe state, and with them every unsafe one. `policy` is
    sound and complete.
    """

    kind: Kind
    no_allowed_set: frozenset[State]
    no_plan: frozenset[State]
    own_region: bool
    policy: Mapping[State, ActionSet] | None


class World:
    """All that is to be known about a specification under one ordering, state by state."""

    def __init__(self, spec: Spec, ordering: Ordering) -> None:
        self.spec = spec
        self.ordering = ordering
        self.valid = [state for state in all_states(spec) if is_valid(spec, state)]
        self.safe = [state for state in self.valid if is_safe(spec, state)]
        self.unsafe = [state for state in self.valid if not is_safe(spec, state)]
        self.gamma: dict[State, ActiveGoals] = {state: active_goals(spec, state) for state in self.valid}
        self.options: dict[State, list[Option]] = {state: self._options(state) for state in self.valid}
        self._distances: dict[Residual, dict[State, int]] = {}

    def _options(self, state: State) -> list[Option]:
        """The allowed sets, fewest actions first, then as declared."""
        return [
            Option(chosen, successor(self.spec, state, chosen), residual_goal(self.spec, state, chosen))
            for chosen in allowed_sets(self.spec, state, self.ordering)
        ]

    @cached_property
    def bound(self) -> int:
        """`L`, or a number of steps that no shortest run exceeds."""
        return self.spec.max_plan_length or len(self.valid) + 1

    @cached_property
    def _predecessors(self) -> dict[State, set[State]]:
        found: dict[State, set[State]] = {state: set() for state in self.valid}
        for state in self.valid:
            for option in self.options[state]:
                found[option.after].add(state)
        return found

    def distances(self, goal: Residual) -> dict[State, int]:
        """The least number `k ≥ 0` of allowed steps from each state to one where `goal` holds, where there is any."""
        if goal not in self._distances:
            found = {state: 0 for state in self.valid if reached(self.spec, goal, state)}
            queue = deque(found)
            while queue:
                here = queue.popleft()
                for before in self._predecessors[here]:
                    if before not in found:
                        found[before] = found[here] + 1
                        queue.append(before)
            self._distances[goal] = found
        return self._distances[goal]

    def has_plan(self, option: Option) -> bool:
        """Whether allowed steps, the first being `option`, lead to its residual goal within the bound."""
        return self.distances(option.goal).get(option.after, self.bound) < self.bound


@lru_cache(maxsize=64)
def world_of(spec: Spec, ordering: Ordering) -> World:
    """The same world for all who ask about a specification, and change nothing in it."""
    return World(spec, ordering)


def decide(spec: Spec, ordering: Ordering) -> OracleVerdict:
    """The verdict on `spec`: its failing states, else a policy, else the certainty that the goals conflict."""
    return decide_world(world_of(spec, ordering))


def decide_world(world: World) -> OracleVerdict:
    """`decide`, where the world is already known."""
    no_set = frozenset(state for state in world.valid if not world.options[state])
    no_plan = frozenset(
        state for state in world.valid if world.options[state] and not any(map(world.has_plan, world.options[state]))
    )
    if no_set or no_plan:
        return OracleVerdict("failing", no_set, no_plan, False, None)
    policy = own_region_policy(world)
    if policy is not None:
        return OracleVerdict("realizable", no_set, no_plan, True, policy)
    policy = Together(world).serve(world.valid)
    return OracleVerdict("conflict" if policy is None else "realizable", no_set, no_plan, False, policy)


def own_region_policy(world: World) -> dict[State, ActionSet] | None:
    """A policy whose runs from safe states stay where `Γ` is the same until the goal, layer by layer; None without one.

    A layer holds the states that first find an option whose run, continued by the decisions of lower layers, reaches
    its residual goal. Where the sets of one region leave several residual goals this is a heuristic, else exact.
    Among its options a safe state takes the one of fewest steps, fewest actions, declared first; an unsafe one the
    first that serves.
    """
    decided: dict[State, Option] = {}
    while found := {
        state: min(options, key=lambda pair: pair[0])[1]
        for state in world.safe
        if state not in decided and (options := _own_options(world, decided, state))
    }:
        decided.update(found)
    if len(decided) < len(world.safe):
        return None
    served = {state: next(_serving_options(world, decided, state), None) for state in world.unsafe}
    decided.update((state, option) for state, option in served.items() if option is not None)
    return {state: option.chosen for state, option in decided.items()} if len(decided) == len(world.valid) else None


def _serving_options(world: World, decided: Mapping[State, Option], state: State) -> Iterator[Option]:
    return (option for option in world.options[state] if steps_under(world, decided, option) is not None)


def _own_options(world: World, decided: Mapping[State, Option], state: State) -> list[tuple[int, Option]]:
    """The options of `state` that serve it inside its own region, with their numbers of steps."""
    home = {here: option for here, option in decided.items() if world.gamma[here] == world.gamma[state]}
    return [(steps, o) for o in world.options[state] if (steps := steps_under(world, home, o)) is not None]


def steps_under(world: World, decided: Mapping[State, Option], option: Option) -> int | None:
    """The steps that `option`, continued by `decided`, takes to its residual goal; None where it misses it."""
    steps, here = 1, option.after
    while not reached(world.spec, option.goal, here):
        if here not in decided or steps == world.bound:
            return None
        steps, here = steps + 1, decided[here].after
    return steps


class Together:
    """Whether one policy, with `Ok` everywhere, can serve given states at once: a SAT encoding, complete.

    One truth value per state and distinct (successor, residual goal), exactly one of them true. For a residual goal
    `c` and a state `t`, `need` says that the run from `t` has to hit `c`; a bit vector `rank` falls along it, from `L
    - 1` at most, so that the run has to arrive.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._solver = z3.SolverFor("QF_FD")
        self._width = max(1, (world.bound).bit_length())
        self._pick: dict[State, dict[tuple[State, Residual], z3.BoolRef]] = {}
        self._option: dict[State, dict[tuple[State, Residual], Option]] = {}
        self._needs: dict[tuple[Residual, State], tuple[z3.BoolRef, z3.BitVecRef]] = {}
        self._serve = {state: z3.Bool(f"serve{number}") for number, state in enumerate(world.valid)}
        for state in world.valid:
            self._choose_one(state)
        for state in world.valid:
            self._serving(state)

    def serve(self, states: Iterable[State]) -> dict[State, ActionSet] | None:
        """A policy with `Ok` everywhere that serves `states`, or None where there is none."""
        answer = self._solver.check(*(self._serve[state] for state in states))
        if answer == z3.unsat:
            return None
        if answer != z3.sat:
            raise RuntimeError(f"z3 gave no answer: {self._solver.reason_unknown()}")
        model = self._solver.model()
        return {
            state: self._option[state][key].chosen
            for state, picks in self._pick.items()
            for key, pick in picks.items()
            if z3.is_true(model.eval(pick, model_completion=True))
        }

    def _choose_one(self, state: State) -> None:
        distinct: dict[tuple[State, Residual], Option] = {}
        for option in self._world.options[state]:
            distinct.setdefault((option.after, option.goal), option)
        name = "_".join(map(str, state))
        picks = {key: z3.Bool(f"pick_{name}_{number}") for number, key in enumerate(distinct)}
        self._pick[state], self._option[state] = picks, distinct
        self._solver.add(z3.Or(*picks.values()))
        if len(picks) > 1:
            self._solver.add(z3.AtMost(*picks.values(), 1))

    def _serving(self, state: State) -> None:
        for (after, goal), pick in self._pick[state].items():
            if self._world.has_plan(self._option[state][after, goal]):
                self._solver.add(z3.Implies(z3.And(self._serve[state], pick), self._need(goal, after)[0]))
            else:
                self._solver.add(z3.Not(z3.And(self._serve[state], pick)))

    def _need(self, goal: Residual, start: State) -> tuple[z3.BoolRef, z3.BitVecRef]:
        """The need to hit `goal` from `start`, with the clauses of every state that its run may come through."""
        if (goal, start) not in self._needs:
            waiting = [self._declare(goal, start)]
            while waiting:
                here = waiting.pop()
                waiting.extend(self._define(goal, here))
        return self._needs[goal, start]

    def _declare(self, goal: Residual, state: State) -> State:
        number = len(self._needs)
        self._needs[goal, state] = z3.Bool(f"need{number}"), z3.BitVec(f"rank{number}", self._width)
        return state

    def _define(self, goal: Residual, state: State) -> list[State]:
        need, rank = self._needs[goal, state]
        distances = self._world.distances(goal)
        if distances[state] == 0:
            return []
        fresh: list[State] = []
        self._solver.add(z3.Implies(need, z3.ULE(rank, self._world.bound - 1)))
        for after in {after for after, _ in self._pick[state]}:
            picked = z3.Or(*(pick for (there, _), pick in self._pick[state].items() if there == after))
            if after not in distances:
                self._solver.add(z3.Not(z3.And(need, picked)))
                continue
            if (goal, after) not in self._needs:
                fresh.append(self._declare(goal, after))
            next_need, next_rank = self._needs[goal, after]
            self._solver.add(z3.Implies(z3.And(need, picked), z3.And(next_need, z3.ULT(next_rank, rank))))
        return fresh


def conflict_is_minimal(spec: Spec, ordering: Ordering, states: Iterable[State]) -> bool:
    """Whether no policy with `Ok` everywhere serves `states`, while one serves each subset with one state less."""
    together, wanted = Together(World(spec, ordering)), set(states)
    return together.serve(wanted) is None and all(together.serve(wanted - {state}) is not None for state in wanted)
