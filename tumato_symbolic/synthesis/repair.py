"""Exact decisions where goals interact: lazy repair, or the proof that no policy exists.

One choice per touched state, among its options (where a set leads, and its target). Options are complete, so a
clause about them holds for every policy: *where this start has this target, some state of the failing run must decide
otherwise*. Z3 picks the options; today's decisions are assumptions, relaxed by unsatisfiable cores. Only states of
failing runs are ever touched.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tumato_symbolic.game import Evaluation, Evaluator, Layers
from tumato_symbolic.limits import need_z3
from tumato_symbolic.semantics import ActionSet, State, successor
from tumato_symbolic.symbolic import Bdd, one_by_one, preferred
from tumato_symbolic.synthesis.conflict import FailingRun, Option, RepairConflict
from tumato_symbolic.synthesis.picks import Pick

NARROW_ROUNDS = 24
"""So many rounds explain one failing run only: a conflict, which often recurs all over the states, then shows soon.
Later rounds also cut off, once for each target, the states that lead to no target: there may be more loops than can be
cut one by one."""

RUNS_PER_ROUND = 64
"""How many failing runs are explained in every later round."""


ROUNDS = 5_000
"""After so many rounds the answer is `Undecided`."""


class RoundsExhaustedError(Exception):
    """The solver was asked `ROUNDS` times without an answer."""


class Repair:
    """Repairs a policy that is defined in every safe state. `distances` are the layers of all allowed runs."""

    def __init__(self, evaluator: Evaluator, policy: Bdd, distances: tuple[Layers, ...]) -> None:
        need_z3("repair decisions where goals interact")
        from tumato_symbolic.synthesis.solver import Choices

        self._evaluator = evaluator
        self._problem = problem = evaluator.problem
        self._policy = policy
        self._distances = distances
        self._aims = [
            (target, layers) for target, layers in zip(problem.targets, distances, strict=True) if not target.meaning
        ]
        self._choices = Choices(problem.encoding.manager)
        self._numbers: dict[State, int] = {}
        self._options: list[tuple[Option, ...]] = []
        self._states: list[State] = []
        self._picked: list[int] = []
        self._cuts: list[tuple[int, FailingRun]] = []
        self._cubes: dict[State, Bdd] = {}
        self._touched = problem.false
        self._rounds, self._most = 0, ROUNDS
        self._cut_off_in: dict[int, int] = {}
        self._distance: dict[tuple[int, State], int | None] = {}

    def run(self, required: Bdd | None = None, most: int | None = None) -> Bdd | RepairConflict:
        """A policy that serves the required states (None: all valid ones), or the conflict that proves there is none.

        Raises `RoundsExhaustedError`. `most` bounds the rounds until the states are served, or proved not to be;
        another call goes on from there.
        """
        self._most = ROUNDS if most is None else min(most, ROUNDS)
        result = self._serve(self._problem.steps.valid if required is None else required, None)
        self._most = ROUNDS
        if isinstance(result, frozenset):
            return self._impossible(self._minimal(result))
        return result

    def _serve(self, required: Bdd, guards: list[int] | None) -> Bdd | frozenset[int]:
        """A policy that serves the required states, or starts (by number) that cannot be served together."""
        while self._rounds < self._most:
            self._rounds += 1
            picked = self._choices.solve(guards)
            if isinstance(picked, frozenset):
                return picked
            self._picked = picked
            candidate = self._current()
            failing = self._evaluate(candidate).failing & required
            if failing == self._problem.false:
                return candidate
            self._explain_some(failing)
        raise RoundsExhaustedError

    def _evaluate(self, candidate: Bdd) -> Evaluation:
        return self._evaluator.evaluate(candidate)

    def _impossible(self, starts: list[int]) -> RepairConflict:
        """The proof that these starts cannot be served together, without the cuts that it does not need."""
        owned = [number for number, (start, _) in enumerate(self._cuts) if start in starts]
        cuts = [self._cuts[number][1] for number in self._choices.refutation(owned)]
        mentioned = {state for cut in cuts for state in cut.states} | {self._states[number] for number in starts}
        options = {state: self._options[self._numbers[state]] for state in sorted(mentioned)}
        blamed = tuple(sorted(self._states[number] for number in starts))
        return RepairConflict(blamed, options, tuple(cuts), tuple(self._aims))

    def _minimal(self, core: frozenset[int]) -> list[int]:
        """An inclusion-minimal part of a core: each state in turn is left out, and what remains is tried."""
        needed: list[int] = []
        open_ = sorted(core, key=lambda number: self._states[number])
        while open_:
            rest = [*needed, *open_[1:]]
            required = self._problem.encoding.manager.union(self._cube(self._states[number]) for number in rest)
            result = self._serve(required, rest)
            if isinstance(result, frozenset):
                open_ = [number for number in open_[1:] if number in result]
            else:
                needed.append(open_.pop(0))
        return needed

    def _current(self) -> Bdd:
        """The policy with the picked options in the touched states."""
        manager, encoding = self._problem.encoding.manager, self._problem.encoding
        changed = [(number, option) for number, option in enumerate(self._picked) if option]
        cubes = [(self._cube(self._states[n]), self._options[n][option].chosen) for n, option in changed]
        kept = self._policy & ~manager.union(cube for cube, _ in cubes)
        added = manager.union(cube & encoding.choices_cube(chosen) for cube, chosen in cubes)
        return kept | (added & self._problem.steps.safe)

    def _cube(self, state: State) -> Bdd:
        if state not in self._cubes:
            self._cubes[state] = self._problem.encoding.state_cube(state)
        return self._cubes[state]

    def _explain_some(self, failing: Bdd) -> None:
        """Clauses for some failing starts that have no state of an explained run in common."""
        for _ in range(RUNS_PER_ROUND if self._rounds > NARROW_ROUNDS else 1):
            if failing == self._problem.false:
                return
            met = failing & self._touched
            start = self._problem.encoding.first_state(met if met != self._problem.false else failing)
            failing = failing & ~self._problem.encoding.manager.union(map(self._cube, self._explain(start)))

    def _explain(self, start: State) -> set[State]:
        """Clauses for one failing start; the states of its runs. An unsafe start fails with every option."""
        number = self._touch(start)
        unsafe = not self._problem.encoding.contains(self._problem.steps.safe, start)
        tried = range(len(self._options[number])) if unsafe else [self._picked[number]]
        seen: set[State] = {start}
        for option in tried:
            seen |= self._explain_option(number, self._options[number][option])
        return seen

    def _explain_option(self, start: int, first: Option) -> set[State]:
        """The clause that the run of `first`, continued by the current policy, violates, if it fails; its states.

        The run either closes a loop, or meets a state from which no continuation is short enough. In a loop, some state
        has to leave the loop's states or hit the target; before the point of no return, some state has to turn off.
        What holds of a loop holds of any set of states that the start is in.
        """
        goal, bound = first.target, self._problem.spec.max_plan_length
        path = [start]
        decision, steps = first, 1
        while True:
            here = decision.successor
            distance = self._distance_to(goal, here)
            if distance is None or (bound is not None and steps + distance > bound):
                self._cut(start, goal, path, self._turning_off(path, here, goal), here)
                break
            if distance == 0:
                break
            number = self._touch(here)
            if number in path[1:]:
                self._cut(start, goal, path, self._leaving(path, goal))
                if self._rounds > NARROW_ROUNDS and self._cut_off_in.get(goal, 0) < self._rounds:
                    self._cut_off_in[goal] = self._rounds
                    cut_off = [start, *(number for number in self._leading_nowhere(goal) if number != start)]
                    self._cut(start, goal, cut_off, self._leaving(cut_off, goal))
                break
            path.append(number)
            decision, steps = self._options[number][self._picked[number]], steps + 1
        return {self._states[number] for number in path}

    def _cut(self, start: int, goal: int, states: list[int], picks: Iterable[Pick], end: State | None = None) -> None:
        """A clause, with what proves it: where the start has the target, one of the picks is made."""
        self._choices.require(start, list(dict.fromkeys([*self._other_targets(start, goal), *picks])))
        self._cuts.append((start, FailingRun(goal, tuple(self._states[number] for number in states), end)))

    def _leading_nowhere(self, goal: int) -> Iterator[int]:
        """The touched states from where the current options lead neither to the target nor to an untouched state."""
        leads: dict[int, bool] = {}
        for number in range(len(self._states)):
            way: list[int] = []
            here: int | None = number
            while here is not None and here not in leads:
                leads[here] = False
                way.append(here)
                following = self._options[here][self._picked[here]].successor
                leads[here] = self._distance_to(goal, following) == 0 or following not in self._numbers
                here = None if leads[here] else self._numbers[following]
            arrives = here is None or leads[here]
            leads.update(dict.fromkeys(way, arrives))
            if not arrives:
                yield number

    def _other_targets(self, start: int, goal: int) -> Iterator[Pick]:
        """The options of the start that have another target."""
        return (Pick(start, n) for n, option in enumerate(self._options[start]) if option.target != goal)

    def _turning_off(self, path: list[int], end: State, goal: int) -> Iterator[Pick]:
        """Options on a path that leave it for a state from where the target is still near enough."""
        following = [*(self._states[number] for number in path[1:]), end]
        for steps, (number, after) in enumerate(zip(path, following, strict=True), start=1):
            for n, option in enumerate(self._options[number]):
                if option.successor != after and self._near(goal, option.successor, steps):
                    yield Pick(number, n)

    def _leaving(self, path: list[int], goal: int) -> Iterator[Pick]:
        """Options that lead out of the states of a path, or to the target."""
        inside = {self._states[number] for number in path}
        for number in path:
            for n, option in enumerate(self._options[number]):
                distance = self._distance_to(goal, option.successor)
                if distance == 0 or (option.successor not in inside and self._near(goal, option.successor, 1)):
                    yield Pick(number, n)

    def _near(self, goal: int, state: State, steps: int) -> bool:
        """Whether the target can be reached from a state that is met after so many steps."""
        distance, bound = self._distance_to(goal, state), self._problem.spec.max_plan_length
        return distance is not None and (bound is None or steps + distance <= bound)

    def _distance_to(self, goal: int, state: State) -> int | None:
        """The fewest steps from a safe state to a target by any allowed steps; None where there is no way."""
        key = (goal, state)
        if key not in self._distance:
            layers = self._aims[goal][1]
            contains = self._problem.encoding.contains
            self._distance[key] = next((n for n, layer in enumerate(layers) if contains(layer, state)), None)
        return self._distance[key]

    def _touch(self, state: State) -> int:
        """The number of a state's choice, made when it is first met."""
        if state not in self._numbers:
            options = tuple(self._options_of(state))
            number = self._choices.add_choice(len(options))
            self._numbers[state] = number
            self._options.append(options)
            self._states.append(state)
            self._touched = self._touched | self._cube(state)
            self._picked.append(0)
        return self._numbers[state]

    def _today(self, state: State) -> Bdd:
        """What was decided in a state before."""
        return self._problem.encoding.at(self._policy, state)

    def _options_of(self, state: State) -> Iterator[Option]:
        """Every option of a state: today's decision first, then the preferred sets, in their order."""
        problem, encoding = self._problem, self._problem.encoding
        today = self._today(state)
        left = encoding.at(problem.steps.allowed, state)
        while left != problem.false:
            pool = today if today != problem.false else left
            chosen = encoding.first_set(preferred(encoding, pool))
            today = problem.false
            option = self._option(state, chosen)
            yield option
            here = self._cube(state)
            alike = self._aims[option.target][0].pending & here & problem.steps.before(self._cube(option.successor))
            left = left & ~encoding.at(alike, state)

    def _option(self, state: State, chosen: ActionSet) -> Option:
        encoding = self._problem.encoding
        pair = self._cube(state) & encoding.choices_cube(chosen)
        return Option(successor(self._problem.spec, state, chosen), self._aim_of(pair), chosen)

    def _aim_of(self, pair: Bdd) -> int:
        """The number of the target of one pair: where one stands for many residual goals, given when that is met."""
        for number, (target, _) in enumerate(self._aims):
            if (pair & target.pending) != self._problem.false:
                return number
        encoding = self._problem.encoding
        target, bits = next(one_by_one(encoding, self._problem.targets[0], pair))
        self._aims.append((target, [encoding.manager.cofactor(layer, bits) for layer in self._distances[0]]))
        return len(self._aims) - 1
