"""The judgement of a policy, one state at a time (`docs/semantics.md`, sections 5, 9 and 10)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from msgspec import Struct

from tumato_symbolic.semantics.restoration import Restorations
from tumato_symbolic.semantics.runs import Run, follow
from tumato_symbolic.semantics.states import ActionSet, State, all_states, duration, is_safe, is_start, is_valid
from tumato_symbolic.semantics.step import Objection, allowed_sets, nominal_agrees, objections
from tumato_symbolic.spec import FALSE, TRUE, And, Formula, Is, Or, Ordering, Spec


class Judgement(Struct, frozen=True):
    """Where a policy falls short. It is sound, complete and minimal when all of these are empty.

    `not_restored` are unsafe states from where the way back to safety may never end: where safety may take several
    steps to restore. With starts, `missing` are starts, `invalid` are decided states that are not valid, and only the
    decided states count: an outcome that is none of them is as one that is not valid (section 12).
    """

    missing: tuple[State, ...]
    not_allowed: tuple[tuple[State, Objection], ...]
    goal_missed: tuple[tuple[State, Run], ...]
    not_minimal: tuple[tuple[State, ActionSet], ...]
    longest_run: int
    not_restored: tuple[State, ...] = ()
    invalid: tuple[State, ...] = ()

    @property
    def sound_and_complete(self) -> bool:
        """Total, safe, restoring, and every run reaches its goal."""
        return not (self.missing or self.invalid or self.not_allowed or self.not_restored or self.goal_missed)

    @property
    def minimal(self) -> bool:
        """No unsafe state has a cheaper allowed set that serves as well."""
        return not self.not_minimal


def judge(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> Judgement:
    """Judge `policy`, which need not be defined everywhere.

    Without starts, what it says of states that are not valid is ignored.
    """
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    missing = tuple(state for state in valid if state not in policy and is_start(spec, state))
    decided = {state: policy[state] for state in valid if state in policy}
    invalid: tuple[State, ...] = ()
    if spec.starts:
        invalid = tuple(sorted(policy.keys() - decided.keys()))
        spec = spec.within(one_of(decided))
    bad = ((state, next(objections(spec, state, chosen, ordering), None)) for state, chosen in decided.items())
    not_allowed = tuple((state, objection) for state, objection in bad if objection is not None)
    forbidden = {state for state, _ in not_allowed}
    runs = [
        (state, follow(spec, decided, state, chosen)) for state, chosen in decided.items() if state not in forbidden
    ]
    ways_back = Restorations(spec, decided, ordering) if spec.restores_stepwise else None
    unsafe = [state for state in decided if not is_safe(spec, state)]
    cheaper = ((state, better_sets(spec, decided, state, ordering, ways_back)) for state in unsafe)
    return Judgement(
        missing,
        not_allowed,
        tuple((state, run) for state, run in runs if run.end != "goal"),
        tuple((state, best) for state, sets in cheaper if (best := next(sets, None)) is not None),
        max((run.steps for _, run in runs if run.end == "goal"), default=0),
        tuple(state for state in unsafe if ways_back is not None and _is_trapped(spec, decided, state, ways_back)),
        invalid,
    )


def one_of(states: Iterable[State]) -> Formula:
    """Where a state is one of these."""
    each = tuple(And((TRUE, *(Is(variable, value) for variable, value in enumerate(state)))) for state in states)
    return Or((FALSE, *each))


def _is_trapped(spec: Spec, policy: Mapping[State, ActionSet], state: State, ways_back: Restorations) -> bool:
    """Whether the policy does not restore an unsafe state as it has to."""
    return nominal_agrees(spec, policy[state]) and ways_back.quality(state, policy[state]) is None


def better_sets(
    spec: Spec,
    policy: Mapping[State, ActionSet],
    state: State,
    ordering: Ordering,
    ways_back: Restorations | None = None,
) -> Iterator[ActionSet]:
    """The allowed sets that restore an unsafe state better than `policy[state]`, and serve as well.

    In one step: those of smaller duration whose run, continued by `policy`, meets the goal. In several: those of better
    quality with which its own run meets the goal, and so do the runs of all other states that meet theirs by `policy`.
    `ways_back` are those of the policy, where they are known.
    """
    if spec.restores_stepwise:
        yield from _better_stepwise(spec, policy, state, ordering, ways_back or Restorations(spec, policy, ordering))
        return
    cost = duration(spec, policy[state])
    for chosen in allowed_sets(spec, state, ordering):
        if duration(spec, chosen) < cost and follow(spec, policy, state, chosen).end == "goal":
            yield chosen


def _better_stepwise(
    spec: Spec, policy: Mapping[State, ActionSet], state: State, ordering: Ordering, ways_back: Restorations
) -> Iterator[ActionSet]:
    today = policy[state]
    now = ways_back.quality(state, today) if nominal_agrees(spec, today) else None
    for chosen in allowed_sets(spec, state, ordering):
        found = ways_back.quality(state, chosen)
        if found is not None and (now is None or found < now) and _serves(spec, policy, state, chosen):
            yield chosen


def _serves(spec: Spec, policy: Mapping[State, ActionSet], state: State, chosen: ActionSet) -> bool:
    """Whether, with `chosen` in `state`, its run meets the goal, and all other runs still do that do now."""
    changed = {**policy, state: chosen}
    others = (
        other
        for other, first in policy.items()
        if other != state and nominal_agrees(spec, first) and follow(spec, policy, other, first).end == "goal"
    )
    return follow(spec, changed, state, chosen).end == "goal" and all(
        follow(spec, changed, other, policy[other]).end == "goal" for other in others
    )
