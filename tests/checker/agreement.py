"""Generated specifications with right and wrong policies: the stand-alone checker against `semantics.judge`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random

from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.generate import random_spec, random_text
from tests.oracle import World, decide_world
from tests.profiles import ALL_PROFILES
from tumato_symbolic.policy import as_diagram, dumps, policy_from_rows
from tumato_symbolic.semantics import ActionSet, Judgement, State, judge

Decisions = Mapping[State, ActionSet]


def disagreements(folder: Path, profile: str, seed: int, mutants: int = 3) -> tuple[int, list[str]]:
    """How many policies were judged for the specification of a seed, and where the two judges differ.

    Each is judged as a table, every second one also as a diagram.
    """
    spec, text = random_spec(seed, ALL_PROFILES[profile]), random_text(seed, ALL_PROFILES[profile])
    judged, found = 0, []
    for ordering in ("any", "first"):
        world = World(spec, ordering)
        for policy in policies(world, Random(seed), mutants):
            judgement = judge(spec, policy, ordering)
            table = policy_from_rows(spec, policy, ordering)
            wanted = 0 if judgement.sound_and_complete and judgement.minimal else 1, failing(judgement), sizes(world)
            for form in (table, replace(table, decisions=as_diagram(table)))[: 1 + judged % 2]:
                answer = ask(folder, dumps(form), text, "--effect-ordering", ordering)
                given = (answer.code, answer.failing, answer.states) if answer.out else (answer.code, answer.err)
                if given != wanted:
                    found.append(f"{profile} {seed} {ordering}: {given}, not {wanted}\n{answer.out}")
            judged += 1
    return judged, found


def failing(judgement: Judgement) -> dict[str, int]:
    """In how many states each property fails that does."""
    counts = {
        "total": len(judgement.missing),
        "safe": len(judgement.not_allowed),
        "restoring": len(judgement.not_restored),
        "goals": len(judgement.goal_missed),
        "minimal": len(judgement.not_minimal),
    }
    return {name: count for name, count in counts.items() if count}


def sizes(world: World) -> tuple[int, int]:
    """The numbers of valid and of safe states."""
    return len(world.valid), len(world.safe)


def policies(world: World, random: Random, mutants: int) -> Iterator[Decisions]:
    """A policy that serves where there is one, otherwise one of allowed sets; and some made from it."""
    policy = decide_world(world).policy or {state: _any_allowed(world, random, state) for state in world.valid}
    yield policy
    for _ in range(mutants):
        yield _mutant(world, random, dict(policy))


def _any_allowed(world: World, random: Random, state: State) -> ActionSet:
    return random.choice(world.options[state]).chosen if world.options[state] else frozenset()


def _mutant(world: World, random: Random, policy: dict[State, ActionSet]) -> Decisions:
    actions = range(len(world.spec.actions))
    one, other = random.choice(world.valid), random.choice(world.valid)
    match random.randrange(6):
        case 0:
            del policy[one]
        case 1:
            policy[one] = frozenset(random.sample(actions, random.randint(0, min(3, len(actions)))))
        case 2:
            policy[one] = _any_allowed(world, random, one)
        case 3:
            policy[one], policy[other] = policy[other], policy[one]
        case 4:
            for state in random.sample(world.unsafe, min(2, len(world.unsafe))):
                policy[state] = _any_allowed(world, random, state)
        case _:
            for state in random.sample(world.valid, len(world.valid) // 3):
                policy[state] = _any_allowed(world, random, state)
    return policy
