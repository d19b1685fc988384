"""Steps taken in turns lead where they lead when all groups act at once."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.symbolic import (
    Backend,
    Bdd,
    Rounds,
    Steps,
    available_backend,
    build_steps,
    encode,
    in_turns,
    preferred,
    turns,
)

SEEDS = range(20)
BACKENDS: list[Backend] = sorted({"autoref", available_backend()})


def steps_of(profile: str, backend: Backend) -> Iterator[Steps]:
    """The steps of some generated specifications."""
    for seed in SEEDS:
        spec = random_spec(seed, ALL_PROFILES[profile])
        yield build_steps(encode(spec, backend), spec, "any")


def declared(text: str) -> Steps:
    """The steps of a specification."""
    spec = parse(text)
    return build_steps(encode(spec, available_backend()), spec, "any")


def relations(steps: Steps, random: Random) -> list[Bdd]:
    """All allowed pairs, those in some states, and a policy."""
    some = steps.allowed & some_states(steps, random)
    return [steps.allowed, some, preferred(steps.encoding, some)]


def some_states(steps: Steps, random: Random) -> Bdd:
    """About half of the valid states."""
    states = [state for state in steps.encoding.states_in(steps.valid) if random.random() < 0.5]
    return steps.encoding.manager.union(map(steps.encoding.state_cube, states))


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_what_leads_into_a_set(profile: str, backend: Backend) -> None:
    """Found in turns, if that is possible, it is what is found for all groups at once."""
    for steps in steps_of(profile, backend):
        random = Random(1)
        for relation in relations(steps, random):
            turn = in_turns(steps.encoding, relation)
            if turn is not None:
                target = some_states(steps, random)
                assert turn.states == steps.states_of(relation)
                assert turn.into(target) == steps.predecessor(relation, target)


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_rounds_of_a_search(profile: str) -> None:
    """States belong to the first set that they lead into, and their pairs are those that lead there."""
    for steps in steps_of(profile, available_backend()):
        random = Random(2)
        for relation in relations(steps, random):
            turn, manager = in_turns(steps.encoding, relation), steps.encoding.manager
            if turn is None:
                continue
            rounds, seen, pairs, left = Rounds(turn), manager.false, manager.false, steps.valid
            for _ in range(random.randrange(1, 6)):
                target = left & some_states(steps, random)
                left = left & ~target
                found = relation & steps.before(target) & ~seen
                assert rounds.into(target) == steps.states_of(found)
                seen, pairs = seen | steps.states_of(found), pairs | found
            assert relation & rounds.pairs() == pairs


def test_most_relations_are_taken_in_turns() -> None:
    """Also those with several groups, and those where what one may do depends on what another does."""
    taken = [
        in_turns(steps.encoding, steps.allowed)
        for profile in sorted(ALL_PROFILES)
        for steps in steps_of(profile, available_backend())
        if len(steps.encoding.groups) > 1
    ]
    assert sum(turn is not None for turn in taken) > len(taken) / 2
    assert any(turn is not None and len(turn.branches) > 1 for turn in taken)


CROSSING = """
BEGIN STATE VECTOR
  state S_Left can be a, b
  state S_Right can be a, b
END STATE VECTOR
BEGIN ACTIONS
  action left  nominal effects: S_Left is b
  action right  nominal effects: S_Right is b
END ACTIONS
"""


def test_what_has_to_happen_at_once_is_not_taken_in_turns() -> None:
    """Where what each does depends on what was before the other acted, neither may act first."""
    steps = declared(CROSSING)
    encoding, same = steps.encoding, steps.encoding.connectives.equivalence
    left_acts = same(encoding.executing(0), encoding.value(1, 0))
    right_acts = same(encoding.executing(1), encoding.value(0, 0))
    assert in_turns(encoding, steps.allowed & left_acts) is not None
    assert in_turns(encoding, steps.allowed & left_acts & right_acts) is None


def test_many_moves_are_not_taken_in_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    """The work is bounded."""
    steps = declared(CROSSING)
    assert in_turns(steps.encoding, steps.allowed) is not None
    monkeypatch.setattr(turns, "MOST_TURN_MOVES", 3)
    assert in_turns(steps.encoding, steps.allowed) is None
