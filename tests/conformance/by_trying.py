"""The preferred policy where safety may take several steps to restore, by looking at all policies."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations
from typing import Any

from msgspec.structs import replace

from tests.conformance.roles import Answer, Rows
from tests.restoration.truth import World as Truth
from tests.starts.truth import greatest, starts, within
from tumato_symbolic.semantics import Restorations, State, follow, is_safe, judge
from tumato_symbolic.semantics.judge import one_of
from tumato_symbolic.spec import Ordering, Spec


def best_answer(spec: Spec, ordering: Ordering) -> Answer:
    """The policy of sections 9.6 and 9.7, failing states by kind, or states that no policy serves together."""
    truth = Truth(spec, ordering)
    kinds = {state: kind for state in truth.valid if (kind := truth.kind(state)) is not None}
    if kinds:
        return Answer(None, {kind: frozenset(s for s in kinds if kinds[s] == kind) for kind in kinds.values()})
    policies = list(truth.serving())
    if policies:
        best = min(policies, key=lambda rows: _preference(spec, ordering, rows))
        return Answer(best, {}, judge(spec, best, ordering).longest_run)
    return Answer(None, {"conflict": frozenset(_in_conflict(truth))})


def from_starts(spec: Spec, ordering: Ordering) -> Answer:
    """The policy of section 12, starts that fail, or starts that no policy serves together."""
    truth = Truth(spec, ordering)
    part, _, failing = greatest(truth)
    if failing:
        return Answer(None, {kind: frozenset(s for s in failing if failing[s] == kind) for kind in failing.values()})
    every = [frozenset(some) for size in range(len(part) + 1) for some in combinations(sorted(part), size)]
    served = [each for each in every if each and within(truth, each).has_policy()]
    largest = max((each for each in served if starts(truth) <= each), key=len, default=None)
    if largest is not None:
        return best_answer(replace(spec, starts=()).within(one_of(largest)), ordering)
    members = starts(truth)
    for state in sorted(members):
        if not any(members - {state} <= each for each in served):
            members -= {state}
    return Answer(None, {"conflict": members})


def _preference(spec: Spec, ordering: Ordering, rows: Rows) -> list[Any]:
    """How good a policy is, the smaller the better; exact where one policy is as good as any other in every state."""
    restorations = Restorations(spec, rows, ordering)
    return [
        (
            None if is_safe(spec, state) else restorations.quality(state, chosen),
            follow(spec, rows, state, chosen).steps,
            len(chosen),
            sorted(chosen),
        )
        for state, chosen in rows.items()
    ]


def _in_conflict(truth: Truth) -> Iterable[State]:
    """A minimal set of states that no policy that restores safety serves together."""
    policies = [policy for policy in truth.policies_with_options() if truth.restores(policy)]
    served = [{state for state in policy if truth.meets(policy, state)} for policy in policies]
    members = set(truth.valid)
    for state in truth.valid:
        if not any(members - {state} <= each for each in served):
            members.remove(state)
    return members
