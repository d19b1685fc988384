"""Synthesis against the explicit meaning: `python -m tests.restoration --count N --seed S`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from random import Random
from typing import get_args

from msgspec import Struct, field
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import INTERACTING, PROFILES
from tests.restoration.oracle import Stepwise, Together
from tests.restoration.truth import World
from tumato_symbolic import Realizable, Unrealizable, synthesize
from tumato_symbolic.policy import Policy, as_table
from tumato_symbolic.semantics import State, count_states, judge
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.symbolic import Backend
from tumato_symbolic.verify import verify_unrealizable

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


MOST_POLICIES = 100_000
"""Where there are more policies a campaign does not try them one by one."""


class Tally(Struct):
    """What was found, by restoration, number of tiers and answer; `tried` where all policies were tried as well."""

    answers: Counter[tuple[Restoration, int, str]] = field(default_factory=Counter)
    tried: Counter[tuple[Restoration, int, str]] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


def severe(spec: Spec, restoration: Restoration, random: Random) -> Spec:
    """The specification with a way to restore safety, and its state rules in up to three tiers.

    One step with one tier is the plain meaning, so that under `one_step` there are more where there are more rules.
    """
    tiers = random.choice((2, 3) if restoration == "one_step" else (1, 2, 3))
    numbers = [*range(1, tiers + 1), *(random.randint(1, tiers) for _ in spec.state_rules)][: len(spec.state_rules)]
    random.shuffle(numbers)
    rules = (replace(rule, severity=number) for rule, number in zip(spec.state_rules, numbers, strict=True))
    return replace(spec, restoration=restoration, state_rules=tuple(rules))


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


def examine(
    spec: Spec, ordering: Ordering, tally: Tally, backend: Backend | None = None, most_policies: int = 200
) -> Iterator[str]:
    """What is wrong with the answer for one specification; nothing where no valid state is unsafe.

    Where there are at most so many policies all of them are tried.
    """
    world = World(spec, ordering)
    if len(world.safe) == len(world.valid):
        return
    failing = Counter(kind for kind in map(world.kind, world.valid) if kind is not None)
    outcome = synthesize(spec, ordering, backend=backend, certify=False)
    answer = "undecided"
    if isinstance(outcome, Realizable):
        answer = "realizable"
        yield from _wrong_policy(world, outcome.policy)
        if failing:
            yield f"a policy, but {dict(failing)}"
    elif isinstance(outcome, Unrealizable):
        answer = outcome.failures[0].kind
        if answer == "conflict":
            yield from _wrong_conflict(world, outcome.failures[0].states, dict(failing))
            yield from _wrong_certificate(spec, ordering)
        elif {each.kind: each.count for each in outcome.failures} != failing:
            yield f"{[(each.kind, each.count) for each in outcome.failures]}, but {dict(failing)}"
    tally.answers[spec.restoration, len(spec.tiers), answer] += 1
    if world.policies <= most_policies:
        tally.tried[spec.restoration, len(spec.tiers), answer] += 1
        if world.has_policy() != (answer == "realizable"):
            yield f"{answer}, but trying all policies says otherwise"


def _wrong_conflict(world: World, states: tuple[State, ...], failing: dict[str, int]) -> Iterator[str]:
    """No policy serves the states together, and one does without any of them: by a SAT encoding of all policies."""
    together = Together(Stepwise(world.spec, world.ordering))
    if failing or together.serve(states) is not None:
        yield f"a conflict, but {failing or 'a policy serves the states together'}"
    for state in states:
        if together.serve(other for other in states if other != state) is None:
            yield f"a conflict that is not minimal: {state} is not needed"


def _wrong_certificate(spec: Spec, ordering: Ordering) -> Iterator[str]:
    """There is one for the conflict, and it is a proof."""
    outcome = synthesize(spec, ordering, diagnose=False)
    certificate = outcome.certificate if isinstance(outcome, Unrealizable) else None
    found = None if certificate is None else verify_unrealizable(certificate, spec, ordering=ordering)
    if found is None or found.verdict != "proved":
        yield f"of the certificate of a conflict, verify says {found}"


def _wrong_policy(world: World, policy: Policy) -> Iterator[str]:
    table = as_table(policy, count_states(world.spec))
    assert table is not None
    judgement = judge(world.spec, table.rows, world.ordering)
    if not judgement.sound_and_complete:
        yield f"a policy that is not sound and complete: {judgement}"
    if not judgement.minimal:
        yield f"a policy that is not minimal: {judgement.not_minimal}"
