"""Better decisions in unsafe states after a repair, one at a time, and the deviations that remain (section 9.6)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tumato_symbolic.game import Evaluation, Judge, attractor, closed_loop, in_time
from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import (
    AT_ONCE,
    ActionSet,
    Effort,
    Quality,
    State,
    duration,
    next_states,
    restored,
    successor,
)
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Bdd

TRIES = 2_000
"""So many changed policies are judged."""


class Improving:
    """A repaired policy: `policy` in safe states, `forced` what the repair decided in unsafe ones."""

    def __init__(self, judge: Judge, policy: Bdd, forced: Bdd) -> None:
        self._problem = judge.problem
        self._judge = judge
        self._policy = policy
        self._forced = forced
        self._tries = 0
        self._found = judge.where(forced).evaluate(policy)

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
        found = self._judge.where(forced).evaluate(self._policy)
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
        now = self._quality(state, encoding.first_set(encoding.at(self._whole, state)))
        found: list[tuple[Quality, int, list[int]]] = []
        while left != self._problem.false:
            self._problem.context.check()
            chosen = encoding.first_set(left)
            left = left & ~encoding.choices_cube(chosen)
            quality = self._quality(state, chosen)
            if quality is not None and (now is None or quality < now):
                found.append((quality, len(chosen), sorted(chosen)))
        return [frozenset(actions) for _, _, actions in sorted(found)]

    def _quality(self, state: State, chosen: ActionSet) -> Quality | None:
        """How well a set restores a state, by the efforts of the present policy."""
        spec = self._problem.spec
        after = next_states(spec, state, chosen, self._problem.steps.ordering)
        left = [each for each in after if not restored(spec, state, each)]
        efforts = [self._effort(each) for each in left]
        if all(kind == 1 for kind, _ in efforts):
            return (1 if left else 0), _later(max((effort for _, effort in efforts), default=AT_ONCE), spec, chosen)
        if spec.restoration == "fair":
            nominal = self._nominal(state, successor(spec, state, chosen))
            return None if nominal is None else (2, _later(nominal, spec, chosen))
        return None

    def _effort(self, state: State) -> tuple[int, Effort]:
        """The worst effort of an unsafe state (kind 1); where it is infinite, kind 2."""
        restoration, contains = self._found.restoration, self._problem.encoding.contains
        worst = restoration.worst.items() if restoration is not None else ()
        return next(((1, effort) for effort, states in worst if contains(states, state)), (2, AT_ONCE))

    def _nominal(self, start: State, state: State) -> Effort | None:
        """The effort along the nominal run from a state until it is restored; None where it comes back to `start`."""
        spec, effort = self._problem.spec, AT_ONCE
        while not restored(spec, start, state):
            if state == start:
                return None
            chosen = self._problem.encoding.first_set(self._problem.encoding.at(self._whole, state))
            effort = _later(effort, spec, chosen)
            state = successor(spec, state, chosen)
        return effort

    def _misses(self, policy: Bdd) -> Bdd:
        """The states whose run misses its goal under a policy for all valid states."""
        problem, valid = self._problem, self._problem.steps.valid
        found = closed_loop(problem, policy)
        ranks = [attractor(problem, each.states, found.predecessor, valid, None) for each in problem.targets]
        union = problem.encoding.manager.union
        near = [union(layers) for layers in in_time(problem, ranks)]
        return valid & ~union(found.predecessor(*pair) for pair in zip(found.owing, near, strict=True))


def _later(effort: Effort, spec: Spec, chosen: ActionSet) -> Effort:
    return effort[0] + duration(spec, chosen), effort[1] + 1
