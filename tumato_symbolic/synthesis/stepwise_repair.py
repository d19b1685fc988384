"""Repair where safety may take several steps to restore: decisions in unsafe states serve each other's runs.

Unsafe states have choices as safe ones have; those that no failing run has met are restored as well as can be, whatever
the others do. Under `bounded` an option also has outcomes that are not restored yet. A loop of them never ends, so some
state on the way into it, or in it, has to decide otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.game import Alone, Evaluation, Evaluator, Layers
from tumato_symbolic.semantics import ActionSet, State, duration, next_states, restored
from tumato_symbolic.symbolic import Bdd
from tumato_symbolic.synthesis.conflict import FailingRun, Option
from tumato_symbolic.synthesis.picks import Pick
from tumato_symbolic.synthesis.repair import Repair, RoundsExhaustedError

MOST_SETS = 20_000
"""With more sets of actions that are allowed in a state, its options are not listed."""


class StepwiseRepair(Repair):
    """Repairs decisions in safe and in unsafe states; `alone` has the steps that runs may take."""

    def __init__(self, evaluator: Evaluator, policy: Bdd, distances: tuple[Layers, ...], alone: Alone) -> None:
        super().__init__(evaluator, policy, distances)
        self._alone = alone
        self._evaluation: Evaluation | None = None
        self._required = evaluator.problem.steps.valid

    @property
    def forced(self) -> Bdd:
        """The decisions of the unsafe states that failing runs met."""
        manager, encoding = self._problem.encoding.manager, self._problem.encoding
        return manager.union(
            self._cube(state) & encoding.choices_cube(self._options[number][self._picked[number]].chosen)
            for number, state in enumerate(self._states)
            if not self._is_safe(state)
        )

    def _is_safe(self, state: State) -> bool:
        return self._problem.encoding.contains(self._problem.steps.safe, state)

    def _serve(self, required: Bdd, guards: list[int] | None) -> Bdd | frozenset[int]:
        self._required = required
        return super()._serve(required, guards)

    def _evaluate(self, candidate: Bdd) -> Evaluation:
        self._evaluation = self._evaluator.where(self.forced, self._required).evaluate(candidate)
        return self._evaluation

    def _explain(self, start: State) -> set[State]:
        """Clauses for one failing start; the states that they are about."""
        touched = len(self._states)
        number = self._touch(start)
        clauses = len(self._cuts)
        seen = self._explain_option(number, self._options[number][self._picked[number]])
        if len(self._cuts) == clauses and not self._is_safe(start):
            seen |= self._explain_outcomes(number, seen)
        assert len(self._cuts) > clauses or len(self._states) > touched, "a failing state was not explained"
        return seen

    def _explain_outcomes(self, start: int, run: set[State]) -> set[State]:
        """The clause against a loop of outcomes that a start gets into; else, those of the states that it leads to."""
        way: list[int] = []
        done: set[int] = set()
        loop = self._loop_from(start, way, done) if self._problem.spec.restoration == "bounded" else None
        if loop is not None:
            self._choices.require(start, list(dict.fromkeys(self._avoiding(way, loop))))
            states = tuple(self._states[number] for number in way)
            self._cuts.append((start, FailingRun(self._options[start][self._picked[start]].target, states, None, loop)))
            return set(states)
        done |= {self._numbers[state] for state in run}
        contains, seen = self._problem.encoding.contains, set[State]()
        for number in sorted(done - {start}):
            if contains(self._required, self._states[number]):
                seen |= self._explain_option(number, self._options[number][self._picked[number]])
        return seen

    def _loop_from(self, start: int, way: list[int], done: set[int]) -> int | None:
        """Where a loop of outcomes begins on `way`, which leads into it and round it; None where there is no loop.

        `done` is filled with the states from where outcomes lead into no loop.
        """
        pending: list[Iterator[State]] = []

        def enter(number: int) -> None:
            way.append(number)
            option = self._options[number][self._picked[number]]
            pending.append(iter(sorted(option.following)))

        enter(start)
        while way:
            state = next(pending[-1], None)
            if state is None:
                done.add(way.pop())
                pending.pop()
                continue
            number = self._touch(state)
            if number in way:
                return way.index(number)
            if number not in done:
                enter(number)
        return None

    def _avoiding(self, way: list[int], loop: int) -> Iterator[Pick]:
        """Options on a way by which the next state on it is no outcome; the last one leads back to where it loops."""
        following = [*way[1:], way[loop]]
        for number, after in zip(way, following, strict=True):
            for n, option in enumerate(self._options[number]):
                if self._states[after] not in option.following:
                    yield Pick(number, n)

    def _today(self, state: State) -> Bdd:
        """What is decided in a state now."""
        if self._is_safe(state) or self._evaluation is None or self._evaluation.restoration is None:
            return super()._today(state)
        return self._problem.encoding.at(self._evaluation.restoration.policy, state)

    def _options_of(self, state: State) -> Iterator[Option]:
        """Every option of a state; of an unsafe one, today's decision first, then the shortest sets."""
        if self._is_safe(state):
            yield from super()._options_of(state)
            return
        encoding, spec = self._problem.encoding, self._problem.spec
        today, left = self._today(state), encoding.at(self._alone.pairs, state)
        sets: list[ActionSet] = []
        while left != self._problem.false:
            if len(sets) > MOST_SETS:
                raise RoundsExhaustedError
            sets.append(encoding.first_set(left))
            left = left & ~encoding.choices_cube(sets[-1])
        sets.sort(key=lambda chosen: (duration(spec, chosen), len(chosen), sorted(chosen)))
        if today != self._problem.false:
            sets.insert(0, encoding.first_set(today))
        seen: set[tuple[State, int, frozenset[State]]] = set()
        for chosen in sets:
            option = self._option(state, chosen)
            if spec.restoration == "bounded":
                after = next_states(spec, state, chosen, self._problem.steps.ordering)
                option = replace(option, following=frozenset(each for each in after if not restored(spec, state, each)))
            capability = (option.successor, option.target, option.following)
            if capability not in seen:
                seen.add(capability)
                yield option
