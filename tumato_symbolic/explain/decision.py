"""Why a policy decides as it does in one state: goals, the run, and what else could be done. No solver takes part."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tumato_symbolic.explain.near_misses import candidates
from tumato_symbolic.policy import Policy, UndecidedState
from tumato_symbolic.semantics import (
    ActionSet,
    Objection,
    Run,
    State,
    duration,
    follow,
    holds,
    is_safe,
    named,
    objections,
)
from tumato_symbolic.spec import ConditionalGoal, Goal, GoalList, Ordering, Rule, SimpleGoal, Spec
from tumato_symbolic.spec.support import require_one_step

Verdict: TypeAlias = Literal["forbidden", "misses", "costlier", "longer", "larger", "later", "as-good", "chosen"]


@dataclass(frozen=True, slots=True)
class GoalNote:
    """What the walk through the goals came to: a goal that is active, or a condition that does not hold.

    `conditions` are those on the way to the goal, outermost first; the last one is false where it is not `active`.
    """

    active: bool
    conditions: tuple[Rule, ...]
    body: Rule | None


@dataclass(frozen=True, slots=True)
class Other:
    """What another set of actions would mean.

    `forbidden`: the objection says why. `misses`: its run, continued by the policy, does not meet the goal. The others
    say by what it is less preferred (`docs/semantics.md`, section 6); `as-good`: by nothing in this state alone.
    """

    chosen: ActionSet
    verdict: Verdict
    duration: int
    objection: Objection | None = None
    run: Run | None = None


@dataclass(frozen=True, slots=True)
class Decision:
    """A decision with all that explains it. `broken` are the state rules that the state breaks."""

    state: State
    chosen: ActionSet
    duration: int
    broken: tuple[Rule, ...]
    goals: tuple[GoalNote, ...]
    run: Run
    others: tuple[Other, ...]


class Decisions(Mapping[State, ActionSet]):
    """A policy that is bound to a specification, by state; only looked up, never listed."""

    def __init__(self, spec: Spec, policy: Policy) -> None:
        self._spec = spec
        self._policy = policy
        self._numbers = {action.name: number for number, action in enumerate(spec.actions)}

    def __getitem__(self, state: State) -> ActionSet:
        try:
            return frozenset(self._numbers[name] for name in self._policy.decide(named(self._spec, state)))
        except UndecidedState:
            raise KeyError(state) from None

    def __iter__(self) -> Iterator[State]:
        raise TypeError("a policy is looked up, not listed")

    def __len__(self) -> int:
        raise TypeError("a policy is looked up, not listed")


def why(spec: Spec, policy: Mapping[State, ActionSet], state: State, ordering: Ordering) -> Decision:
    """Why `policy` decides as it does in a valid state. Raises `KeyError` where it does not decide."""
    require_one_step(spec, "why")
    chosen = policy[state]
    others = (judged(spec, policy, state, other, ordering) for other in candidates(spec, state) if other != chosen)
    return Decision(
        state,
        chosen,
        duration(spec, chosen),
        tuple(rule for rule in spec.state_rules if not holds(rule.formula, state)),
        tuple(goal_notes(spec, state)),
        follow(spec, policy, state, chosen),
        tuple(others),
    )


def judged(spec: Spec, policy: Mapping[State, ActionSet], state: State, other: ActionSet, ordering: Ordering) -> Other:
    """What another set would mean in a state that the policy decides."""
    chosen, cost = policy[state], duration(spec, other)
    objection = next(objections(spec, state, other, ordering), None)
    if objection is not None:
        return Other(other, "forbidden", cost, objection)
    run = follow(spec, policy, state, other)
    if other == chosen:
        return Other(other, "chosen", cost, run=run)
    if run.end != "goal":
        return Other(other, "misses", cost, run=run)
    ours = follow(spec, policy, state, chosen)
    reasons: list[tuple[Verdict, int, int]] = [
        ("longer", ours.steps, run.steps),
        ("larger", len(chosen), len(other)),
    ]
    if not is_safe(spec, state):
        reasons.insert(0, ("costlier", duration(spec, chosen), cost))
    for verdict, mine, theirs in reasons:
        if mine != theirs:
            return Other(other, verdict if mine < theirs else "as-good", cost, run=run)
    return Other(other, "later" if sorted(chosen) < sorted(other) else "as-good", cost, run=run)


def goal_notes(spec: Spec, state: State) -> Iterator[GoalNote]:
    """The walk through the goals (`docs/semantics.md`, section 4), as far as it goes."""
    if spec.goals is not None:
        yield from _walk(spec, spec.goals, state, ())


def _walk(spec: Spec, goal: Goal, state: State, conditions: tuple[Rule, ...]) -> Iterator[GoalNote]:
    match goal:
        case SimpleGoal(body):
            yield GoalNote(True, conditions, spec.bodies[body])
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
