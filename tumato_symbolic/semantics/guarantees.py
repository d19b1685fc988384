"""What a policy guarantees beyond its nominal runs (`docs/semantics.md`, section 11)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from math import inf
from typing import Literal, TypeAlias

from msgspec import Struct

from tumato_symbolic.semantics.goals import Residual, reached, residual_goal
from tumato_symbolic.semantics.states import ActionSet, State, is_valid
from tumato_symbolic.semantics.step import nominal_agrees, outcomes_in_turn, successor
from tumato_symbolic.spec import Ordering, Spec

GuaranteeKind: TypeAlias = Literal["guaranteed", "fair", "survives", "nominal"]


class Guarantee(Struct, frozen=True):
    """The strongest that holds of a state: its goal is met

    - `guaranteed`: whatever happens, within `steps` steps, and no fewer at worst;
    - `fair`: once deviations stop, however many there were;
    - `survives`: with up to `deviations` deviations in all, and not with one more;
    - `nominal`: if nothing deviates.
    """

    kind: GuaranteeKind
    steps: int | None = None
    deviations: int | None = None


class Step(Struct, frozen=True):
    """What the policy does in a state: `δ(s, π(s))`, and all of `Next(s, π(s))`."""

    nominal: State
    following: frozenset[State]

    @property
    def deviations(self) -> frozenset[State]:
        """`D(s)`."""
        return self.following - {self.nominal}


Steps: TypeAlias = Mapping[State, Step]
"""By the states where the policy acts."""


def steps_from(
    spec: Spec, policy: Mapping[State, ActionSet], starts: Iterable[State], ordering: Ordering, most: int | None = None
) -> Steps | None:
    """The steps in all states that the policy can come to from `starts`; None where they have over `most` outcomes."""
    found: dict[State, Step] = {}
    waiting = list(dict.fromkeys(starts))
    met, looked_at = set(waiting), 0
    while waiting:
        state = waiting.pop()
        chosen = policy.get(state)
        if chosen is None or not nominal_agrees(spec, chosen):
            continue
        nominal = successor(spec, state, chosen)
        following = {nominal}
        for after, _ in outcomes_in_turn(spec, state, chosen, ordering):
            following.add(after)
            looked_at += 1
            if most is not None and looked_at > most:
                return None
        found[state] = Step(nominal, frozenset(following))
        waiting += sorted(following - met)
        met |= following
    return found


class Prospects:
    """What becomes of a residual goal `c` under a policy.

    `surviving` are `W_0, W_1, …` up to the first that equals the one before it, which is `W_ω`. `forced` has the layer
    of every state of `G`: 0 where the goal holds.
    """

    def __init__(self, spec: Spec, goal: Residual, steps: Steps) -> None:
        self._steps = steps
        places = {*steps, *(state for step in steps.values() for state in step.following)}
        self._met = frozenset(state for state in places if reached(spec, goal, state))
        self._places = frozenset(places)

    @cached_property
    def surviving(self) -> list[frozenset[State]]:
        """`W_0, W_1, …`, the last two being the same."""
        found = [self._nominally(self._places)]
        while len(found) < 2 or found[-1] != found[-2]:
            found.append(self._nominally(found[-1]))
        return found

    def _nominally(self, deviating: frozenset[State]) -> frozenset[State]:
        """`μX. c ∪ {t : δ ∈ X, D(t) ⊆ deviating}`."""
        found = set(self._met)
        while more := {
            state
            for state, step in self._steps.items()
            if state not in found and step.nominal in found and step.deviations <= deviating
        }:
            found |= more
        return frozenset(found)

    @cached_property
    def forced(self) -> dict[State, int]:
        """`μX. c ∪ {t : Next ⊆ X}`, layer by layer."""
        found = dict.fromkeys(self._met, 0)
        while more := {
            state: 1 + max(found[after] for after in step.following)
            for state, step in self._steps.items()
            if state not in found and step.following <= found.keys()
        }:
            found |= more
        return found

    def of(self, step: Step) -> Guarantee | None:
        """What a first step guarantees; None where not even its nominal run meets the goal."""
        if step.following <= self.forced.keys():
            return Guarantee("guaranteed", steps=1 + max(self.forced[after] for after in step.following))
        if step.following <= self.surviving[-1]:
            return Guarantee("fair")
        if step.nominal not in self.surviving[0]:
            return None
        deviations = 0
        while step.nominal in self.surviving[deviations + 1] and step.deviations <= self.surviving[deviations]:
            deviations += 1
        return Guarantee("survives", deviations=deviations) if deviations else Guarantee("nominal")

    def endures(self, state: State) -> float:
        """With how many deviations at most the goal, still pending in `state`, is met: `inf`; -1 where with none."""
        if state in self.surviving[-1]:
            return inf
        return sum(state in each for each in self.surviving) - 1


def guarantees(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> dict[State, Guarantee | None]:
    """What `policy` guarantees in every valid state where it acts; None where not even its nominal run."""
    decided = {state: chosen for state, chosen in policy.items() if is_valid(spec, state)}
    steps = steps_from(spec, decided, decided, ordering) or {}
    known: dict[Residual, Prospects] = {}
    found: dict[State, Guarantee | None] = {}
    for state, step in steps.items():
        goal = residual_goal(spec, state, policy[state])
        if goal not in known:
            known[goal] = Prospects(spec, goal, steps)
        found[state] = known[goal].of(step)
    return found
