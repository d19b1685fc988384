"""The judgement of a policy, one state at a time (`docs/semantics.md`, section 5)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from tumato_symbolic.semantics.runs import Run, follow
from tumato_symbolic.semantics.states import ActionSet, State, all_states, duration, is_safe, is_valid
from tumato_symbolic.semantics.step import Objection, allowed_sets, objections
from tumato_symbolic.spec import Ordering, Spec


@dataclass(frozen=True, slots=True)
class Judgement:
    """Where a policy falls short. It is sound, complete and minimal when all of these are empty."""

    missing: tuple[State, ...]
    not_allowed: tuple[tuple[State, Objection], ...]
    goal_missed: tuple[tuple[State, Run], ...]
    not_minimal: tuple[tuple[State, ActionSet], ...]
    longest_run: int

    @property
    def sound_and_complete(self) -> bool:
        """Total, safe, and every run reaches its goal."""
        return not (self.missing or self.not_allowed or self.goal_missed)

    @property
    def minimal(self) -> bool:
        """No unsafe state has a cheaper allowed set that serves as well."""
        return not self.not_minimal


def judge(spec: Spec, policy: Mapping[State, ActionSet], ordering: Ordering) -> Judgement:
    """Judge `policy`, which need not be defined everywhere; what it says of states that are not valid is ignored."""
    valid = [state for state in all_states(spec) if is_valid(spec, state)]
    missing = tuple(state for state in valid if state not in policy)
    decided = {state: policy[state] for state in valid if state in policy}
    bad = ((state, next(objections(spec, state, chosen, ordering), None)) for state, chosen in decided.items())
    not_allowed = tuple((state, objection) for state, objection in bad if objection is not None)
    forbidden = {state for state, _ in not_allowed}
    runs = [
        (state, follow(spec, decided, state, chosen)) for state, chosen in decided.items() if state not in forbidden
    ]
    cheaper = ((state, better_sets(spec, decided, state, ordering)) for state in decided if not is_safe(spec, state))
    return Judgement(
        missing,
        not_allowed,
        tuple((state, run) for state, run in runs if run.end != "goal"),
        tuple((state, best) for state, sets in cheaper if (best := next(sets, None)) is not None),
        max((run.steps for _, run in runs if run.end == "goal"), default=0),
    )


def better_sets(spec: Spec, policy: Mapping[State, ActionSet], state: State, ordering: Ordering) -> Iterator[ActionSet]:
    """The allowed sets of smaller duration than `policy[state]`, whose run, continued by `policy`, meets the goal."""
    cost = duration(spec, policy[state])
    for chosen in allowed_sets(spec, state, ordering):
        if duration(spec, chosen) < cost and follow(spec, policy, state, chosen).end == "goal":
            yield chosen
