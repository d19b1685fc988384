"""Why a policy decides as it does in one state (`why`): goals, the run, and what else could be done.

No solver takes part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.explain.guaranteed import Guaranteed, guaranteed
from tumato_symbolic.explain.near_misses import candidates
from tumato_symbolic.explain.way_to_safety import RestoringFrom, WayToSafety
from tumato_symbolic.policy import Policy, UndecidedState
from tumato_symbolic.semantics import (
    ActionSet,
    Objection,
    Quality,
    Run,
    State,
    active_goals,
    cases_in,
    duration,
    follow,
    holds,
    is_safe,
    named,
    nominal_agrees,
    objections,
)
from tumato_symbolic.spec import ConditionalGoal, Goal, GoalList, Ordering, Rule, SimpleGoal, Spec

Verdict: TypeAlias = Literal[
    "forbidden", "misses", "endless", "costlier", "leaving", "longer", "larger", "later", "as-good", "chosen"
]


class GoalNote(Struct, frozen=True):
    """What the walk through the goals came to: a goal that is active, or a condition that does not hold.

    `conditions` are those on the way to the goal, outermost first; the last one is false where it is not `active`.
    """

    active: bool
    conditions: tuple[Rule, ...]
    body: Rule | None


class Other(Struct, frozen=True):
    """What another set of actions would mean.

    `forbidden`: the objection says why. `misses`: its run, continued by the policy, does not meet the goal. The others
    say by what it is less preferred (`docs/semantics.md`, section 6), `leaving` that its run passes states where other
    goals are active, and that of the decision does not; `as-good`: by nothing in this state alone.
    Where safety may take several steps to restore, `quality` is how well the set does that; `endless`: that may never
    end.
    """

    chosen: ActionSet
    verdict: Verdict
    duration: int
    objection: Objection | None = None
    run: Run | None = None
    quality: Quality | None = None


class Decision(Struct, frozen=True):
    """A decision with all that explains it. `broken` are the state rules that the state breaks.

    `way` leads from an unsafe state back to safety, where that may take several steps, and `quality` is how well the
    decision does that; None where it may never end. `guaranteed` is None where too much can follow to tell.
    """

    state: State
    chosen: ActionSet
    duration: int
    broken: tuple[Rule, ...]
    goals: tuple[GoalNote, ...]
    run: Run
    others: tuple[Other, ...]
    way: WayToSafety | None = None
    quality: Quality | None = None
    guaranteed: Guaranteed | None = None


class Decisions(Mapping[State, ActionSet]):
    """A policy that is bound to a specification, by state; only looked up, never listed."""

    def __init__(self, spec: Spec, policy: Policy) -> None:
        self._spec = spec
        self._policy = policy
        self._numbers = {name: number for number, name in enumerate(spec.action_names)}

    def __getitem__(self, state: State) -> ActionSet:
        try:
            names = self._policy.decide(named(self._spec, state))
        except UndecidedState:
            raise KeyError(state) from None
        return cases_in(self._spec, (self._numbers[name] for name in names), state)

    def __iter__(self) -> Iterator[State]:
        raise TypeError("a policy is looked up, not listed")

    def __len__(self) -> int:
        raise TypeError("a policy is looked up, not listed")


def why(spec: Spec, policy: Mapping[State, ActionSet], state: State, ordering: Ordering) -> Decision:
    """Why `policy` decides as it does in a valid state. Raises `KeyError` where it does not decide."""
    chosen, restoring = policy[state], RestoringFrom(spec, policy, ordering)
    others = (
        alternative(spec, policy, state, other, ordering, restoring=restoring)
        for other in candidates(spec, state)
        if other != chosen
    )
    stepwise = spec.restores_stepwise and not is_safe(spec, state)
    return Decision(
        state,
        chosen,
        duration(spec, chosen),
        tuple(rule for rule in spec.state_rules if not holds(rule.formula, state)),
        tuple(goal_notes(spec, state)),
        follow(spec, policy, state, chosen),
        tuple(others),
        restoring.way(state) if stepwise else None,
        restoring.quality(state, chosen) if stepwise and nominal_agrees(spec, chosen) else None,
        guaranteed(spec, policy, state, ordering),
    )


def alternative(
    spec: Spec,
    policy: Mapping[State, ActionSet],
    state: State,
    other: ActionSet,
    ordering: Ordering,
    *,
    restoring: RestoringFrom | None = None,
) -> Other:
    """What another set would mean in a state that the policy decides; `restoring` is what is known from other sets."""
    chosen, cost = policy[state], duration(spec, other)
    objection = next(objections(spec, state, other, ordering), None)
    if objection is not None:
        return Other(other, "forbidden", cost, objection)
    run = follow(spec, policy, state, other)
    restoring = restoring or RestoringFrom(spec, policy, ordering)
    ours, theirs = (_quality(spec, restoring, state, each) for each in (chosen, other))
    found = Other(other, "as-good", cost, run=run, quality=theirs if spec.restores_stepwise else None)
    if other == chosen:
        return replace(found, verdict="chosen")
    if theirs is None:
        return replace(found, verdict="endless")
    if run.end != "goal":
        return replace(found, verdict="misses")
    verdicts: tuple[Verdict, ...] = ("costlier", "leaving", "longer", "larger", "later")
    own = follow(spec, policy, state, chosen)
    mine = ours or _WORST, _leaves(spec, own), own.steps, len(chosen), sorted(chosen)
    its = theirs, _leaves(spec, run), run.steps, len(other), sorted(other)
    differs = next(n for n, (one, another) in enumerate(zip(mine, its, strict=True)) if one != another)
    return replace(found, verdict=verdicts[differs]) if mine < its else found


_WORST: Quality = (3, (0, 0))
"""After all that restores anything."""


def _quality(spec: Spec, restoring: RestoringFrom, state: State, chosen: ActionSet) -> Quality | None:
    """How well a set restores a state: by its duration in one step, and all alike in a safe state."""
    if is_safe(spec, state):
        return 0, (0, 0)
    if spec.restores_stepwise:
        return restoring.quality(state, chosen)
    return 0, (duration(spec, chosen), 1)


def _leaves(spec: Spec, run: Run) -> bool:
    """Whether a run from a safe state passes states where other goals are active than at its start."""
    start, *passed = run.states[:-1]
    goals = active_goals(spec, start)
    return is_safe(spec, start) and any(active_goals(spec, state) != goals for state in passed)


def goal_notes(spec: Spec, state: State) -> Iterator[GoalNote]:
    """The walk through the goals (`docs/semantics.md`, section 4), as far as it goes."""
    if spec.goals is not None:
        yield from _walk(spec, spec.goals, state, ())


def _walk(spec: Spec, goal: Goal, state: State, conditions: tuple[Rule, ...]) -> Iterator[GoalNote]:
    match goal:
        case SimpleGoal():
            yield GoalNote(True, conditions, spec.as_written(goal))
        case ConditionalGoal(condition, inner):
            if holds(condition.formula, state):
                yield from _walk(spec, inner, state, (*conditions, condition))
            else:
                yield GoalNote(False, (*conditions, condition), None)
        case GoalList(kind, members):
            for member in members:
                yield from _walk(spec, member, state, conditions)
                entered = not isinstance(member, ConditionalGoal) or holds(member.condition.formula, state)
                if kind == "priority" and entered:
                    return
