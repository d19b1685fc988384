"""Right and wrong policies of generated specifications, and the explicit meaning's answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from random import Random
from typing import Any

from msgspec.structs import replace

from tests.checker.stepwise import policies, stepwise_spec, ways
from tests.differential import changed_policies
from tests.export.compiler import Case, Library
from tests.generate import random_spec
from tests.oracle import World, decide_world
from tests.profiles import ALL_PROFILES
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import ActionSet, State, all_states, is_valid, judge
from tumato_symbolic.spec import Ordering, Restoration, Spec
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
    for a changed specification: the other ordering, no rules, no bound, preconditions at other times.
    """
    spec, ordering = random_spec(seed, ALL_PROFILES[profile]), _ORDERINGS[seed % 2]
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


def stepwise(seed: int, restoration: Restoration, tiers: int, mutants: int = 3, samples: int = 8) -> list[Case]:
    """Policies that restore safety in several steps or by severity, right and wrong, for one specification.

    Some of them, too, for a specification that asks for more or for less.
    """
    drawn = stepwise_spec if seed % 3 == 0 else ways
    spec, ordering = drawn(seed, restoration, tiers), _ORDERINGS[seed // 3 % 2]
    valid = {state for state in all_states(spec) if is_valid(spec, state)}
    found = [rows for rows in policies(spec, ordering, Random(seed), mutants, samples) if rows.keys() >= valid]
    cases = [Case(spec, rows, ordering) for rows in found]
    others = [replace(spec, restoration=other) for other in _RESTORATIONS if other != restoration]
    flat = replace(spec, state_rules=tuple(replace(rule, severity=1) for rule in spec.state_rules))
    lasting = replace(spec, preconditions="throughout")
    return [*cases, *(Case(other, found[0], ordering) for other in (*others, flat, lasting) if found)]


_RESTORATIONS: tuple[Restoration, ...] = ("one_step", "bounded", "fair")
_ORDERINGS: tuple[Ordering, Ordering] = ("any", "first")


def _near(spec: Spec) -> Iterator[Spec]:
    yield replace(spec, state_rules=spec.state_rules[1:], max_plan_length=None)
    yield replace(spec, reaction_rules=(), max_plan_length=2)
    yield replace(spec, preconditions="at_start" if spec.preconditions == "throughout" else "throughout")
    yield replace(spec, actions=tuple(replace(action, duration=2 * n + 1) for n, action in enumerate(spec.actions)))


def agrees(cases: Mapping[Any, Sequence[Case]], library: Library) -> None:
    """Coq and the explicit meaning say the same of each case; of every kind some are right, and some are not.

    It is asked once, about all of them: to start it takes as long as a hundred answers.
    """
    expected = {kind: [is_right(case) for case in some] for kind, some in cases.items()}
    assert all(any(each) and not all(each) for each in expected.values())
    answers = iter(library.checks([case for some in cases.values() for case in some]))
    assert {kind: [next(answers) for _ in some] for kind, some in cases.items()} == expected


def is_right(case: Case) -> bool:
    """The explicit meaning."""
    judgement = judge(case.spec, case.rows, case.ordering)
    return judgement.sound_and_complete and judgement.minimal
