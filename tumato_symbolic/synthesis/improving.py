"""Better decisions in unsafe states after a repair, one at a time, and the deviations that remain (section 9.6)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from msgspec.structs import replace

from tumato_symbolic.game import Evaluation, Evaluator, attractor, closed_loop, in_time
from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import ActionSet, Quality, Restorations, State
from tumato_symbolic.symbolic import Bdd, Encoding

Value = TypeVar("Value")

TRIES = 2_000
"""So many changed policies are evaluated to restore safety better after a repair."""


class Improving:
    """A repaired policy: `policy` in safe states, `forced` what the repair decided in unsafe ones."""

    def __init__(self, evaluator: Evaluator, policy: Bdd, forced: Bdd) -> None:
        self._problem = evaluator.problem
        self._evaluator = evaluator
        self._policy = policy
        self._forced = forced
        self._tries = 0
        self._found = evaluator.where(forced).evaluate(policy)

    def run(self) -> Evaluation:
        """The policy in which no single better set would serve, with the deviations."""
        while self._tries < TRIES and self._improved():
            pass
        restoration = self._found.restoration
        assert restoration is not None, "unsafe decisions are restorations"
        return replace(self._found, restoration=replace(restoration, deviations=tuple(self._deviations())))

    def _improved(self) -> bool:
        """Whether a better set was found for some state; the others are chosen anew, or stay as they are."""
        for state in self._states():
            cube = self._problem.encoding.state_cube(state)
            if self._accepted(self._forced & ~cube):
                return True
            for chosen in self._better(state):
                decision = cube & self._problem.encoding.choices_cube(chosen)
                if self._accepted((self._forced & ~cube) | decision):
                    return True
                changed = (self._whole & ~cube) | decision
                if self._misses(changed) == self._problem.false:
                    return self._accepted(changed & self._problem.steps.unsafe)
        return False

    def _accepted(self, forced: Bdd) -> bool:
        self._tries += 1
        found = self._evaluator.where(forced).evaluate(self._policy)
        if found.failing != self._problem.false:
            return False
        self._forced, self._found = forced, found
        return True

    @property
    def _whole(self) -> Bdd:
        """The decisions in all valid states."""
        restoration = self._found.restoration
        return self._policy if restoration is None else self._policy | restoration.policy

    def _states(self) -> Iterator[State]:
        return self._problem.encoding.states_in(self._problem.steps.states_of(self._forced))

    def _deviations(self) -> Iterator[Deviation]:
        encoding = self._problem.encoding
        for state in self._states():
            cube = encoding.state_cube(state)
            for chosen in self._better(state):
                missing = self._misses((self._whole & ~cube) | (cube & encoding.choices_cube(chosen)))
                if not encoding.contains(missing, state):
                    yield Deviation(state, chosen, encoding.first_state(missing))

    def _better(self, state: State) -> list[ActionSet]:
        """The sets that restore an unsafe state better than what is decided, the best first."""
        encoding = self._problem.encoding
        left = encoding.at(self._problem.steps.allowed, state)
        restorations = self._restorations()
        now = restorations.quality(state, encoding.first_set(encoding.at(self._whole, state)))
        found: list[tuple[Quality, int, list[int]]] = []
        while left != self._problem.false:
            self._problem.context.check()
            chosen = encoding.first_set(left)
            left = left & ~encoding.choices_cube(chosen)
            quality = restorations.quality(state, chosen)
            if quality is not None and (now is None or quality < now):
                found.append((quality, len(chosen), sorted(chosen)))
        return [frozenset(actions) for _, _, actions in sorted(found)]

    def _misses(self, policy: Bdd) -> Bdd:
        """The states whose run misses its goal under a policy for all valid states."""
        problem, valid = self._problem, self._problem.steps.valid
        found = closed_loop(problem, policy)
        ranks = [attractor(problem, each.states, found.predecessor, valid, None) for each in problem.targets]
        union = problem.encoding.manager.union
        near = [union(layers) for layers in in_time(problem, ranks)]
        return valid & ~union(found.first_steps(number, each) for number, each in enumerate(near))

    def _restorations(self) -> Restorations:
        """How the present policy restores safety; decisions and efforts are looked up."""
        encoding, restoration = self._problem.encoding, self._found.restoration
        worst = {} if restoration is None else restoration.worst
        policy = _LookedUp(lambda state: _decision(encoding, self._whole, state))
        efforts = _LookedUp(
            lambda state: next((e for e, states in worst.items() if encoding.contains(states, state)), None)
        )
        return Restorations(self._problem.spec, policy, self._problem.steps.ordering, efforts)


def _decision(encoding: Encoding, policy: Bdd, state: State) -> ActionSet | None:
    choices = encoding.at(policy, state)
    return None if choices == encoding.manager.false else encoding.first_set(choices)


class _LookedUp(Mapping[State, Value]):
    """What a function says of states, None standing for nothing; never listed."""

    def __init__(self, find: Callable[[State], Value | None]) -> None:
        self._find = find

    def __getitem__(self, state: State) -> Value:
        found = self._find(state)
        if found is None:
            raise KeyError(state)
        return found

    def __iter__(self) -> Iterator[State]:
        raise TypeError("it is looked up, not listed")

    def __len__(self) -> int:
        raise TypeError("it is looked up, not listed")
