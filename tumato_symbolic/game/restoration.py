"""Decisions in unsafe states where safety may take several steps to restore (`docs/semantics.md`, sections 9 and 10).

Backward from the safe states, by increasing effort: a state is decided when some set of actions leads, by every
outcome, to what is restored or decided already. There is one fixpoint step for every distinct worst effort.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from heapq import heappop, heappush

from msgspec import Struct

from tumato_symbolic.game.fixpoints import Layers, preimage
from tumato_symbolic.game.problem import Problem
from tumato_symbolic.game.routing import shortest_decisions
from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import AT_ONCE, Effort, longer
from tumato_symbolic.symbolic import Bdd, by_duration, compatible_sets, preferred, staying_in

Efforts = dict[Effort, Bdd]
"""Disjoint sets of states, each with its effort."""


class Restoration(Struct, frozen=True):
    """What is decided in unsafe states, and what that comes to.

    `worst` has the states by their worst effort, `nominal` those where it is infinite by the effort along the nominal
    run (under `fair`). `ranks[k]` are the layers of target `k`, of safe and of decided unsafe states. `failing` are the
    unsafe states where nothing serves; `deviations` the better sets that are not taken because another run would miss
    its goal.
    """

    policy: Bdd
    worst: Efforts
    nominal: Efforts
    ranks: tuple[Layers, ...]
    failing: Bdd
    deviations: tuple[Deviation, ...] = ()


class Restorer:
    """Restores safety as well as can be, given decisions in safe states."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    def restore(self, ranks: Sequence[Layers], forced: Bdd, required: Bdd) -> Restoration:
        """Decide unsafe states by quality (section 9.6), where that serves; `ranks` are those of the safe states.

        In states of `forced`, a relation, only its pairs are taken. States outside `required` need not reach a goal.
        """
        problem, steps = self.problem, self.problem.steps
        pairs = steps.allowed & steps.unsafe
        if forced != problem.false:
            pairs = (pairs & ~steps.states_of(forced)) | (forced & steps.unsafe)
        work = _Work(problem, self.durations, self._compatible, ranks, free=steps.unsafe & ~required)
        for here, upper in reversed(steps.levels):
            if here != problem.false:
                work.restore_level(pairs & here, here, upper)
        failing = steps.unsafe & required & ~steps.states_of(work.policy)
        return Restoration(work.policy, work.worst, work.nominal, tuple(work.ranks), failing)

    @cached_property
    def _compatible(self) -> Bdd:
        return compatible_sets(self.problem.encoding)

    @cached_property
    def durations(self) -> dict[int, Bdd]:
        """The sets that are allowed in some unsafe state, by duration."""
        encoding, steps = self.problem.encoding, self.problem.steps
        return by_duration(encoding, encoding.manager.exists(encoding.all_state_bits, steps.allowed & steps.unsafe))


class _Work:
    """One restoration under way: decisions, efforts and ranks so far."""

    def __init__(
        self, problem: Problem, durations: dict[int, Bdd], compatible: Bdd, ranks: Sequence[Layers], *, free: Bdd
    ) -> None:
        self.problem = problem
        self._free = free
        self.durations = durations
        self.ranks: list[Layers] = [list(layers) for layers in ranks]
        self.policy = problem.false
        self.worst: Efforts = {}
        self.nominal: Efforts = {}
        self._compatible = compatible

    def restore_level(self, pairs: Bdd, here: Bdd, upper: Bdd) -> None:
        """Decide states of one level; `pairs` are what they may do, `upper` is where they are restored."""
        problem = self.problem
        at_once = self._into(upper, pairs)
        undecided, waiting = here, _Queue(problem.false)
        for duration, choices in self.durations.items():
            decided = self._decide(at_once & choices & undecided)
            undecided = undecided & ~decided
            waiting.add((duration, 1), decided, problem.false)
        if problem.spec.restoration == "one_step":
            self._note(self.worst, waiting.settled())
            return
        covered, reached = at_once, upper
        for effort, restored, candidates in waiting:
            decided = self._decide(candidates & undecided)
            undecided, settled = undecided & ~decided, restored | decided
            if settled == problem.false:
                continue
            self._note(self.worst, [(effort, settled)])
            reached = reached | settled
            if undecided == problem.false:
                self._note(self.worst, waiting.settled())
                break
            left = pairs & undecided & ~covered
            found = self._into(reached, left)
            covered = covered | found
            for duration, part in self._by_duration(found):
                waiting.add(longer(effort, duration), problem.false, part)
        if problem.spec.restoration == "fair" and undecided != problem.false:
            self._restore_fairly(pairs & undecided, self.policy & here, upper)

    def _restore_fairly(self, pairs: Bdd, decided: Bdd, upper: Bdd) -> None:
        """Decide states along nominal effects, the smallest effort first; `decided` are the decisions so far."""
        problem, steps = self.problem, self.problem.steps
        undecided, waiting = steps.states_of(pairs), _Queue(problem.false)
        waiting.add(AT_ONCE, upper, problem.false)
        follow, lead = preimage(problem, decided), preimage(problem, pairs)
        for effort, settled, candidates in waiting:
            found = self._decide(candidates & undecided)
            undecided = undecided & ~found
            if found != problem.false:
                self._note(self.nominal, [(effort, found)])
            front = settled | found
            if front == problem.false:
                continue
            for duration, part in self._by_duration(follow(front)):
                waiting.add(longer(effort, duration), steps.states_of(part), problem.false)
            for duration, part in self._by_duration(lead(front) & undecided):
                waiting.add(longer(effort, duration), problem.false, part)

    def _into(self, target: Bdd, pairs: Bdd) -> Bdd:
        """Those of some pairs after which every state, and that after all nominal effects, is in `target`."""
        if pairs == self.problem.false:
            return pairs
        encoding, ordering = self.problem.encoding, self.problem.steps.ordering
        return pairs & staying_in(encoding, ordering, target, self._compatible, pairs)

    def _by_duration(self, pairs: Bdd) -> Iterator[tuple[int, Bdd]]:
        for duration, choices in self.durations.items():
            if pairs == self.problem.false:
                return
            part = pairs & choices
            if part != self.problem.false:
                pairs = pairs & ~part
                yield duration, part

    def _decide(self, candidates: Bdd) -> Bdd:
        """Decide all states where some candidate serves, by the fewest steps; those states."""
        problem, steps = self.problem, self.problem.steps
        if candidates == problem.false:
            return candidates
        after = steps.successors(candidates)
        near = [[layer & after for layer in layers[: problem.spec.max_plan_length]] for layers in self.ranks]
        policy = shortest_decisions(problem, near, steps.states_of(candidates), candidates)
        if self._free != problem.false:
            policy = policy | preferred(problem.encoding, candidates & self._free & ~steps.states_of(policy))
        decided = steps.states_of(policy)
        if decided == problem.false:
            return decided
        self.policy = self.policy | policy
        before, after = preimage(problem, policy), steps.successors(policy)
        for layers in self.ranks:
            further = [
                steps.states_of(before(layer)) if layer & after != problem.false else problem.false for layer in layers
            ]
            for rank, states in enumerate(further, 1):
                if states == problem.false:
                    continue
                if rank == len(layers):
                    layers.append(problem.false)
                layers[rank] = layers[rank] | states
        return decided

    def _note(self, efforts: Efforts, found: Sequence[tuple[Effort, Bdd]]) -> None:
        for effort, states in found:
            if states != self.problem.false:
                efforts[effort] = efforts.get(effort, self.problem.false) | states


class _Queue:
    """Sets by effort, to be taken in order: states that have it, and pairs that would come to it."""

    def __init__(self, false: Bdd) -> None:
        self._false = false
        self._parts: dict[Effort, tuple[Bdd, Bdd]] = {}
        self._heap: list[Effort] = []

    def add(self, effort: Effort, settled: Bdd, candidates: Bdd) -> None:
        """Put in states and pairs."""
        if settled == self._false and candidates == self._false:
            return
        if effort not in self._parts:
            heappush(self._heap, effort)
        before = self._parts.get(effort, (self._false, self._false))
        self._parts[effort] = before[0] | settled, before[1] | candidates

    def __iter__(self) -> Iterator[tuple[Effort, Bdd, Bdd]]:
        """Everything, the smallest effort first; what is put in meanwhile must have a larger one."""
        while self._heap:
            effort = heappop(self._heap)
            yield (effort, *self._parts.pop(effort))

    def settled(self) -> list[tuple[Effort, Bdd]]:
        """What is left of the states."""
        return [(effort, settled) for effort, (settled, _) in sorted(self._parts.items())]
