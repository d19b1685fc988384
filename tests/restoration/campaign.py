"""Synthesis against the explicit meaning: `python -m tests.restoration --count N --seed S`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from random import Random
from typing import get_args

from tests.generate import random_spec
from tests.profiles import INTERACTING, PROFILES
from tests.restoration.oracle import Stepwise, Together
from tests.restoration.truth import World
from tumato_symbolic import Realizable, Unrealizable, synthesize
from tumato_symbolic.policy import Policy, as_table
from tumato_symbolic.semantics import State, count_states, judge
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.symbolic import Backend

STEPWISE = replace(
    INTERACTING,
    variables=(1, 2),
    values=(3, 5),
    states=(4, 16),
    actions=(4, 7),
    preconditions=(1, 1),
    state_rules=(1, 3),
    goals=(1, 2),
    durations=(0, 9),
    alternatives=0.25,
    wide=0.0,
    executing=0.1,
    bounded=0.1,
)
"""Few states, most of them unsafe, and goals that unsafe states have to reach through each other."""

LARGEST = 48
"""The most states of a specification that is taken."""

MOST_ACTIONS = 7
"""The most actions: the explicit meaning tries all sets."""


MOST_POLICIES = 20_000
"""Where there are more policies they are not tried one by one."""


@dataclass
class Tally:
    """What was found, by restoration and answer."""

    answers: Counter[tuple[Restoration, str]] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


def severe(spec: Spec, restoration: Restoration, random: Random) -> Spec:
    """The specification with a way to restore safety, and its state rules in up to three tiers."""
    tiers = random.choice((1, 1, 2, 3))
    rules = tuple(replace(rule, severity=random.randint(1, tiers)) for rule in spec.state_rules)
    return replace(spec, restoration=restoration, state_rules=rules)


def specifications(seed: int) -> Iterator[tuple[str, Spec]]:
    """The specifications of a seed that are small enough, and where safety may take several steps to restore."""
    for name, profile in {**PROFILES, "stepwise": STEPWISE}.items():
        base = random_spec(seed, profile)
        if count_states(base) > LARGEST or len(base.actions) > MOST_ACTIONS:
            continue
        for restoration in get_args(Restoration):
            spec = severe(base, restoration, Random(f"{name} {seed} {restoration}"))
            if spec.restores_stepwise:
                yield f"{name} {seed} {restoration}, {len(spec.tiers)} tiers", spec


def examine(spec: Spec, ordering: Ordering, tally: Tally, backend: Backend | None = None) -> Iterator[str]:
    """What is wrong with the answer for one specification; nothing where no valid state is unsafe."""
    world = World(spec, ordering)
    if len(world.safe) == len(world.valid):
        return
    failing = Counter(kind for kind in map(world.kind, world.valid) if kind is not None)
    outcome = synthesize(spec, ordering, backend=backend, certify=False)
    if isinstance(outcome, Realizable):
        tally.answers[spec.restoration, "realizable"] += 1
        yield from _wrong_policy(spec, outcome.policy, ordering)
        if failing:
            yield f"a policy, but {dict(failing)}"
    elif isinstance(outcome, Unrealizable):
        kind = outcome.failures[0].kind
        tally.answers[spec.restoration, kind] += 1
        if kind == "conflict":
            yield from _wrong_conflict(world, outcome.failures[0].states, dict(failing))
        elif {each.kind: each.count for each in outcome.failures} != failing:
            yield f"{[(each.kind, each.count) for each in outcome.failures]}, but {dict(failing)}"
    else:
        tally.answers[spec.restoration, "undecided"] += 1


def _wrong_conflict(world: World, states: tuple[State, ...], failing: dict[str, int]) -> Iterator[str]:
    """No policy serves the states together, and one does without any of them: by a SAT encoding of all policies.

    Where there are few policies, they are tried one by one as well.
    """
    together = Together(Stepwise(world.spec, world.ordering))
    if world.policies <= MOST_POLICIES and next(world.serving(), None) is not None:
        yield "a conflict, but there is a policy"
    if failing or together.serve(states) is not None:
        yield f"a conflict, but {failing or 'a policy serves the states together'}"
    for state in states:
        if together.serve(other for other in states if other != state) is None:
            yield f"a conflict that is not minimal: {state} is not needed"


def _wrong_policy(spec: Spec, policy: Policy, ordering: Ordering) -> Iterator[str]:
    table = as_table(policy, count_states(spec))
    assert table is not None
    judgement = judge(spec, table.rows, ordering)
    if not judgement.sound_and_complete:
        yield f"a policy that is not sound and complete: {judgement}"
    if not judgement.minimal:
        yield f"a policy that is not minimal: {judgement.not_minimal}"
