"""Realizability where safety may take several steps to restore: explicit fixpoints, and a SAT encoding of policies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property

import z3
from msgspec import Struct

from tests.oracle import Option, World
from tumato_symbolic.semantics import ActionSet, Residual, State, restored
from tumato_symbolic.semantics.step import next_states
from tumato_symbolic.spec import Ordering, Spec


class Truth(Struct, frozen=True):
    """The failing states by kind; without any, a sound and complete policy, or None where the goals conflict."""

    failing: Mapping[str, frozenset[State]]
    policy: Mapping[State, ActionSet] | None


class Stepwise(World):
    """All that is to be known about a specification that restores safety stepwise, state by state."""

    def waiting(self, state: State, option: Option) -> frozenset[State]:
        """Where an option of an unsafe state may lead that is not restored; under `fair`, by nominal effects."""
        if self.spec.restoration == "fair":
            after = {option.after}
        else:
            after = next_states(self.spec, state, option.chosen, self.ordering)
        return frozenset(each for each in after if not restored(self.spec, state, each))

    @cached_property
    def restorable(self) -> set[State]:
        """`R`, by the definition of section 9."""
        found = set(self.safe)
        while more := {
            state
            for state in self.unsafe
            if state not in found and any(self.waiting(state, option) <= found for option in self.options[state])
        }:
            found |= more
        return found

    @cached_property
    def passable(self) -> dict[State, list[Option]]:
        """The options that a run to a goal may take."""
        return {
            state: [option for option in self.options[state] if state not in self.unsafe or self._fits(state, option)]
            for state in self.valid
        }

    def _fits(self, state: State, option: Option) -> bool:
        if self.spec.restoration != "bounded":
            return True
        waiting = self.waiting(state, option)
        return waiting <= self.restorable and state not in waiting

    @cached_property
    def _predecessors(self) -> dict[State, set[State]]:
        found: dict[State, set[State]] = {state: set() for state in self.valid}
        for state, options in self.passable.items():
            for option in options:
                found[option.after].add(state)
        return found


def decide_stepwise(spec: Spec, ordering: Ordering) -> Truth:
    """The truth about a specification."""
    world = Stepwise(spec, ordering)
    several = spec.restoration != "one_step"
    no_set = {state for state in (world.safe if several else world.valid) if not world.options[state]}
    lost = {state for state in world.unsafe if several and state not in world.restorable}
    no_plan = {
        state
        for state in world.valid
        if state not in no_set | lost and not any(map(world.has_plan, world.passable[state]))
    }
    failing = {"no-allowed-set": no_set, "no-restoration": lost, "no-plan": no_plan}
    found = {kind: frozenset(states) for kind, states in failing.items() if states}
    return Truth(found, None if found else Together(world).serve(world.valid))


class Together:
    """Whether one policy can serve given states at once, by passable options: a SAT encoding, complete.

    One truth value per state and option that differs in what follows. A bit vector falls along the runs that have to
    hit a goal, and another along what is not restored.
    """

    def __init__(self, world: Stepwise) -> None:
        self._world = world
        self._solver = z3.SolverFor("QF_FD")
        self._width = max(2, (max(world.bound, len(world.valid)) + 1).bit_length())
        self._options = {state: self._different(state) for state in world.valid}
        self._picks = {
            state: [z3.Bool(f"x{number}.{n}") for n in range(len(options))]
            for number, (state, options) in enumerate(self._options.items())
        }
        self._effort = {state: z3.BitVec(f"w{number}", self._width) for number, state in enumerate(world.unsafe)}
        self._back = {state: z3.Bool(f"back{number}") for number, state in enumerate(world.unsafe)}
        self._serve = {state: z3.Bool(f"serve{number}") for number, state in enumerate(world.valid)}
        self._runs: dict[tuple[Residual, State], tuple[z3.BoolRef, z3.BitVecRef]] = {}
        for picks in self._picks.values():
            self._solver.add(z3.Or(*picks))
            self._solver.add(z3.AtMost(*picks, 1) if picks else False)
        for state in world.valid:
            self._serving(state)
        for state in world.unsafe:
            self._restoring(state)

    def _different(self, state: State) -> list[Option]:
        found: dict[object, Option] = {}
        for option in self._world.passable[state]:
            found.setdefault((option.after, option.goal, self._world.waiting(state, option)), option)
        return list(found.values())

    def serve(self, states: Iterable[State]) -> dict[State, ActionSet] | None:
        """A policy that serves `states`, or None where there is none."""
        if self._solver.check(*(self._serve[state] for state in states)) == z3.unsat:
            return None
        model = self._solver.model()
        return {
            state: next(o.chosen for o, p in zip(self._options[state], picks, strict=True) if z3.is_true(model.eval(p)))
            for state, picks in self._picks.items()
        }

    def _serving(self, state: State) -> None:
        serve = self._serve[state]
        if state in self._back:
            self._solver.add(z3.Implies(serve, self._back[state]))
        for option, pick in zip(self._options[state], self._picks[state], strict=True):
            served = self._run(option.goal, option.after)[0] if self._world.has_plan(option) else False
            self._solver.add(z3.Implies(z3.And(serve, pick), served))

    def _restoring(self, state: State) -> None:
        for option, pick in zip(self._options[state], self._picks[state], strict=True):
            for other in self._world.waiting(state, option):
                back = z3.And(self._back[other], z3.ULT(self._effort[other], self._effort[state]))
                self._solver.add(z3.Implies(z3.And(self._back[state], pick), back))

    def _run(self, goal: Residual, start: State) -> tuple[z3.BoolRef, z3.BitVecRef]:
        waiting, distances = [(goal, start)], self._world.distances(goal)
        while waiting:
            key = waiting.pop()
            if key in self._runs:
                continue
            number = len(self._runs)
            need, rank = self._runs[key] = z3.Bool(f"n{number}"), z3.BitVec(f"r{number}", self._width)
            self._solver.add(z3.Implies(need, z3.ULE(rank, self._world.bound - 1)))
            waiting += [(goal, after) for after in self._after(key[1]) if distances[key[1]] and after in distances]
            self._pending.append((key, need, rank))
        self._define(goal, distances)
        return self._runs[goal, start]

    @cached_property
    def _pending(self) -> list[tuple[tuple[Residual, State], z3.BoolRef, z3.BitVecRef]]:
        return []

    def _after(self, state: State) -> set[State]:
        return {option.after for option in self._options[state]}

    def _define(self, goal: Residual, distances: Mapping[State, int]) -> None:
        while self._pending:
            (_, state), need, rank = self._pending.pop()
            for option, pick in zip(self._options[state], self._picks[state], strict=True):
                if distances[state] == 0:
                    break
                after: object = False
                if option.after in distances:
                    next_need, next_rank = self._runs[goal, option.after]
                    after = z3.And(next_need, z3.ULT(next_rank, rank))
                self._solver.add(z3.Implies(z3.And(need, pick), after))
