"""Groups of many actions: passes over bits and next values agree with the meaning, action by action."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tumato_symbolic import parse
from tumato_symbolic.semantics import ActionSet, all_states, successor
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import Backend, available_backend, build_steps, choose, encode, lay_out, preferred
from tumato_symbolic.symbolic.present import FEW_MOVES

BACKENDS: list[Backend] = sorted({"autoref", available_backend()})
POSES = 40


def arms(seed: int) -> Spec:
    """Two arms with many poses, whose actions are declared in stretches of different lengths."""
    random, entries, values = Random(seed), list[str](), f"0..{POSES - 1}"
    sides = [
        [f"action {arm}{n} controlled resources: {arm} nominal effects: {arm}_at is {n}" for n in range(POSES)]
        for arm in ("L", "R")
    ]
    while any(sides):
        side, stretch = random.choice(sides), random.choice([1, 3, 12])
        entries += side[:stretch]
        del side[:stretch]
    return parse(
        f"BEGIN STATE VECTOR state L_at can be {values} state R_at can be {values} END STATE VECTOR\n"
        f"BEGIN RESOURCES resource L resource R END RESOURCES\nBEGIN ACTIONS {' '.join(entries)} END ACTIONS\n"
        "BEGIN GOALS goal type: priority goal: true END GOALS"
    )


def some_sets(spec: Spec, random: Random) -> list[ActionSet]:
    """Nothing, a few actions alone, and pairs of one for each arm, in the order of preference."""
    arms = [[n for n, action in enumerate(spec.actions) if action.name[0] == arm] for arm in "LR"]
    several = [random.sample(arm, 5) for arm in arms]
    sets = [frozenset[int](), *(frozenset((n,)) for arm in several for n in arm), *map(frozenset, product(*several))]
    return sorted(sets, key=lambda one: (len(one), sorted(one)))


@pytest.fixture(params=[0, 10_000])
def many(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Single actions are found by passes over bits, then each by itself."""
    monkeypatch.setattr(choose, "MANY_ACTIONS", request.param)


@pytest.mark.usefixtures("many")
@pytest.mark.parametrize("backend", BACKENDS)
def test_the_first_set_is_preferred(backend: Backend) -> None:
    """The smallest set, then the first as declared, in each state of its own sets."""
    spec = arms(1)
    encoding, random = encode(spec, backend), Random(2)
    manager, states = encoding.manager, random.sample(list(all_states(spec)), 12)
    pairs, best = manager.false, manager.false
    for number, state in enumerate(states):
        sets = [each for each in some_sets(spec, random) if len(each) >= number % 3]
        where = encoding.state_cube(state)
        pairs = manager.union([pairs, *(where & encoding.choices_cube(each) for each in sets)])
        best = best | (where & encoding.choices_cube(sets[0]))
    assert preferred(encoding, pairs) == best


@pytest.mark.parametrize("backend", BACKENDS)
def test_next_values_are_those_of_the_moves(backend: Backend) -> None:
    """`before`, `successors`, `next_state` and `states_executing` of groups with many moves agree with `δ`."""
    spec = arms(3)
    steps, random = build_steps(lay_out(spec, backend), spec, "any"), Random(4)
    encoding = steps.encoding
    manager, states = encoding.manager, random.sample(list(all_states(spec)), 12)
    assert all(len(moves) > FEW_MOVES for moves in encoding.nominal_moves)
    decided = {state: random.choice(some_sets(spec, random)) for state in states}
    policy = manager.union(encoding.state_cube(s) & encoding.choices_cube(each) for s, each in decided.items())
    following = encoding.next_state(policy)
    for state, each in decided.items():
        pair, end = encoding.state_cube(state) & encoding.choices_cube(each), successor(spec, state, each)
        assert (pair & encoding.before(encoding.state_cube(end))) == pair
        assert (pair & encoding.before(~encoding.state_cube(end))) == manager.false
        after = encoding.assignment_bits(tuple(enumerate(end)))
        assert {bit: encoding.contains(where, state) for bit, where in following.items()} == after
        assert steps.successors(pair) == encoding.state_cube(end)
    ends = {successor(spec, state, each) for state, each in decided.items()}
    assert set(encoding.states_in(steps.successors(policy))) == ends
    for action, where in enumerate(encoding.states_executing(policy)):
        assert set(encoding.states_in(where)) == {state for state, each in decided.items() if action in each}
