"""Right and wrong policies of generated specifications, and the explicit meaning's answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from random import Random

from tests.differential import changed_policies
from tests.export.compiler import Case
from tests.generate import random_spec
from tests.oracle import World, decide_world
from tests.profiles import PROFILES
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import ActionSet, State, judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.synthesis import Realizable, synthesize


def rows_of(spec: Spec, ordering: Ordering) -> dict[State, ActionSet]:
    """The synthesized decisions."""
    outcome = synthesize(spec, ordering)
    assert isinstance(outcome, Realizable)
    assert isinstance(outcome.policy.decisions, Table)
    return dict(outcome.policy.decisions.rows)


def generated(profile: str, seed: int, mutants: int) -> list[Case]:
    """Policies of one specification, none where it is not realizable.

    The synthesized one and the oracle's (which need not be minimal), `mutants` changed ones, and the synthesized one
    for a changed specification: the other ordering, no rules, no bound.
    """
    spec, ordering = random_spec(seed, PROFILES[profile]), _ORDERINGS[seed % 2]
    world = World(spec, ordering)
    found = decide_world(world).policy
    if found is None:
        return []
    right = rows_of(spec, ordering)
    mutated = [rows for _, rows in changed_policies(world, right, Random(seed), mutants) if rows != right]
    policies = [rows for rows in (right, found, *mutated) if rows.keys() == right.keys()]
    cases = [Case(spec, rows, ordering) for rows in policies]
    return [
        *cases,
        *(Case(other, right, ordering) for other in _near(spec)),
        Case(spec, right, _ORDERINGS[1 - seed % 2]),
    ]


_ORDERINGS: tuple[Ordering, Ordering] = ("any", "first")


def _near(spec: Spec) -> Iterator[Spec]:
    yield replace(spec, state_rules=spec.state_rules[1:], max_plan_length=None)
    yield replace(spec, reaction_rules=(), max_plan_length=2)
    yield replace(spec, actions=tuple(replace(action, duration=2 * n + 1) for n, action in enumerate(spec.actions)))


def is_right(case: Case) -> bool:
    """The explicit meaning."""
    judgement = judge(case.spec, case.rows, case.ordering)
    return judgement.sound_and_complete and judgement.minimal
