"""Witnesses about restoring safety in several steps, by the explicit meaning (`docs/semantics.md`, section 9)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import count

from tumato_symbolic.policy import Deviation
from tumato_symbolic.semantics import (
    ActionSet,
    Quality,
    Residual,
    Restorations,
    Run,
    State,
    allowed,
    follow,
    is_safe,
    nominal_agrees,
    outcomes_in_turn,
    reached,
    residual_goal,
    restored,
    successor,
)
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.result import PropertyResult, Refutation

MOST_STATES = 2_000
"""How many unsafe states are looked at for a witness."""

MOST_OUTCOMES = 20_000
"""How many outcomes of one decision are looked at for a witness."""


class TooFarError(Exception):
    """There is more to look at for a witness than is looked at."""


class WaysBack:
    """Where the decisions of a policy lead from an unsafe state, until safety is restored."""

    def __init__(self, spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> None:
        self._spec, self._policy, self._ordering = spec, policy, ordering

    def lost(self, state: State) -> Run | None:
        """How the policy never restores an unsafe state: steps into a loop, or to where nothing can be done.

        Under `fair` the steps are those of the nominal run; otherwise they may lead to any outcome. None where it does
        restore it. Raises `TooFarError`.
        """
        if self._spec.restoration == "fair":
            return self._lost_nominally(state)
        return self._lost_somehow(state)

    def quality(self, state: State, chosen: ActionSet) -> Quality | None:
        """How well a set restores an unsafe state that then follows the policy. Raises `TooFarError`."""
        reached = dict[State, ActionSet]()
        waiting = [*self._following(state, chosen)]
        while waiting:
            here = waiting.pop()
            decision = self._decision(here)
            if here in reached or decision is None or is_safe(self._spec, here):
                continue
            if len(reached) >= MOST_STATES:
                raise TooFarError
            reached[here] = decision
            waiting += self._following(here, decision)
        return Restorations(self._spec, reached, self._ordering).quality(state, chosen)

    def _lost_nominally(self, state: State) -> Run | None:
        states, decisions = [state], list[ActionSet]()
        while (chosen := self._decision(states[-1])) is not None:
            after = successor(self._spec, states[-1], chosen)
            if restored(self._spec, state, after):
                return None
            met = after in states
            states.append(after)
            decisions.append(chosen)
            if met:
                return Run(tuple(states), tuple(decisions), "loop")
            if len(states) > MOST_STATES:
                raise TooFarError
        return Run(tuple(states), tuple(decisions), "undefined")

    def _lost_somehow(self, state: State) -> Run | None:
        """Depth first: `path` leads to where the search is, `pending` are the states left to look at after each."""
        path, decisions, pending = [state], list[ActionSet](), list[list[State]]()
        done = set[State]()
        while True:
            chosen = self._decision(path[-1])
            if chosen is None:
                return Run(tuple(path), tuple(decisions), "undefined")
            pending.append(self._unrestored(path[-1], chosen))
            decisions.append(chosen)
            while not (left := [each for each in pending[-1] if each not in done]):
                done.add(path.pop())
                pending.pop()
                decisions.pop()
                if not path:
                    return None
            pending[-1] = left[1:]
            if left[0] in path:
                return Run((*path, left[0]), tuple(decisions), "loop")
            path.append(left[0])
            if len(path) + len(done) > MOST_STATES:
                raise TooFarError

    def _decision(self, state: State) -> ActionSet | None:
        """What the policy does in a state, where that is anything with a nominal outcome."""
        chosen = self._policy.get(state)
        return chosen if chosen is not None and nominal_agrees(self._spec, chosen) else None

    def _unrestored(self, state: State, chosen: ActionSet) -> list[State]:
        return [each for each in self._following(state, chosen) if not restored(self._spec, state, each)]

    def _following(self, state: State, chosen: ActionSet) -> list[State]:
        """`Next(s, A)`, the nearest first."""
        found = [successor(self._spec, state, chosen)]
        for after, _ in outcomes_in_turn(self._spec, state, chosen, self._ordering):
            if after != found[0]:
                found.append(after)
            if len(found) > MOST_OUTCOMES:
                raise TooFarError
        return found


class RestoringWitnesses:
    """Refutations of *restoring* and *minimal*, replayed with the explicit meaning as far as that is affordable.

    Raises `RuntimeError` where that finds nothing wrong: a bug of ours.
    """

    def __init__(self, spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> None:
        self._spec, self._policy, self._ordering = spec, policy, ordering
        self._ways = WaysBack(spec, policy, ordering)

    def not_restored(self, state: State) -> PropertyResult:
        """An unsafe state that the policy does not restore."""
        run = None
        with suppress(TooFarError):
            run = self._ways.lost(state)
            if run is None:
                raise RuntimeError(f"{state} is restored, against the prover")
        refutation = Refutation("not-restored", state, self._policy[state], run=run)
        return PropertyResult("restoring", "refuted", refutation=refutation)

    def not_minimal(self, state: State, better: ActionSet) -> PropertyResult:
        """A set that restores an unsafe state better, and keeps no run from its goal."""
        decision, qualities = self._policy[state], None
        with suppress(TooFarError):
            now = self._ways.quality(state, decision) if nominal_agrees(self._spec, decision) else None
            then = self._ways.quality(state, better)
            if then is None or (now is not None and now <= then):
                raise RuntimeError(f"{sorted(better)} is not better in {state}, against the prover")
            qualities = now, then
        run = follow(self._spec, Changed(self._policy, state, better), state, better)
        if run.end != "goal" or not allowed(self._spec, state, better, self._ordering):
            raise RuntimeError(f"{sorted(better)} does not serve in {state}, against the prover")
        refutation = Refutation("not-minimal", state, decision, run=run, cheaper=better, qualities=qualities)
        return PropertyResult("minimal", "refuted", refutation=refutation)


def spoils(spec: Spec, policy: Mapping[State, ActionSet], deviation: Deviation) -> bool:
    """Whether what a deviation says is true.

    The run of `missed` reaches its goal by the policy and misses it with the better set; or it is the run of the better
    set itself that does.
    """
    state, better, missed = deviation.state, deviation.better, deviation.missed
    if state not in policy or is_safe(spec, state) or not nominal_agrees(spec, better):
        return False
    changed = Changed(policy, state, better)
    if missed == state:
        return arrival(spec, changed, state, better) is None
    first = policy.get(missed)
    if first is None or not nominal_agrees(spec, first) or arrival(spec, policy, missed, first) is None:
        return False
    return arrival(spec, changed, missed, first) is None


def arrival(
    spec: Spec, policy: Mapping[State, ActionSet], start: State, first: ActionSet, goal: Residual | None = None
) -> int | None:
    """After how many steps the run that begins with `first` meets a goal, its own if none is given; None: never.

    Nominal effects of `first` must agree.
    """
    wanted = residual_goal(spec, start, first) if goal is None else goal
    here, chosen, met = start, first, set[State]()
    for steps in count(1):
        here = successor(spec, here, chosen)
        if reached(spec, wanted, here):
            return steps
        decision = policy.get(here)
        if steps == spec.max_plan_length or here in met or decision is None or not nominal_agrees(spec, decision):
            return None
        met.add(here)
        chosen = decision
    return None


class Changed(Mapping[State, ActionSet]):
    """A policy with another decision in one state."""

    def __init__(self, policy: Mapping[State, ActionSet], state: State, chosen: ActionSet) -> None:
        self._policy, self._state, self._chosen = policy, state, chosen

    def __getitem__(self, state: State) -> ActionSet:
        return self._chosen if state == self._state else self._policy[state]

    def __iter__(self) -> Iterator[State]:
        return iter({*self._policy, self._state})

    def __len__(self) -> int:
        return len({*self._policy, self._state})
