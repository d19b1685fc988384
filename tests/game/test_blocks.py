"""Actions of which a state has one at most, taken together."""

from __future__ import annotations

from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic import parse
from tumato_symbolic.game import blocks
from tumato_symbolic.game.blocks import blocks_of
from tumato_symbolic.game.problem import build_problem
from tumato_symbolic.game.routing import own_region_policy
from tumato_symbolic.symbolic import available_backend

SEEDS = range(12)

PLACES = """
BEGIN STATE VECTOR
  state S_First can be none, a, b
  state S_Second can be none, a, b
  state S_Lamp can be off, on
END STATE VECTOR
BEGIN RESOURCES
  resource HAND
END RESOURCES
BEGIN ACTIONS
{}
END ACTIONS
BEGIN STATE RULES
  {}
END STATE RULES
BEGIN GOALS
  goal type: priority
  goal: S_First is a AND S_Second is {}
END GOALS
"""


def text_of_places(random: Random) -> str:
    """Things are put in places and moved between them, in some order of declaration; some moves do two things."""
    actions = []
    for value in "ab":
        for place, other in (("S_First", "S_Second"), ("S_Second", "S_First")):
            actions.append(f"{place} is none, S_Lamp is off; {place} is {value}")
            actions.append(f"{place} is none, {other} is {value}; {place} is {value}, {other} is none")
            actions.append(f"{place} is {value}; {place} is none")
    actions += ["S_Lamp is on; S_Lamp is off", "S_Lamp is off; S_Lamp is on, S_First is none"]
    random.shuffle(actions)
    written = []
    for number, each in enumerate(actions[: random.randrange(6, len(actions) + 1)]):
        when, effects = each.split("; ")
        written.append(f"action a{number} duration: 1 controlled resources: HAND preconditions: {when}")
        written.append(f"nominal effects: {effects}")
    rule = random.choice(("S_Lamp is off OR S_First is none", "NOT (S_First is b AND S_Second is b)"))
    return PLACES.format("\n".join(written), f"rule: {rule}", random.choice(("a", "b", "none")))


def test_states_are_decided_block_by_block_as_by_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Actions of which a state has one at most are taken together, and those that are preferred come back."""
    by_blocks = decided = 0
    generated = [random_spec(seed, ALL_PROFILES[profile]) for profile in sorted(ALL_PROFILES) for seed in SEEDS]
    for spec in [*(parse(text_of_places(Random(seed))) for seed in range(40)), *generated]:
        problem = build_problem(spec, "any", available_backend())
        monkeypatch.setattr(blocks, "LEAST_ACTIONS", 10_000)
        one = own_region_policy(problem)
        monkeypatch.setattr(blocks, "LEAST_ACTIONS", 0)
        monkeypatch.setattr(blocks, "LEAST_TOGETHER", 1)
        assert own_region_policy(problem) == one
        by_blocks += blocks_of(problem, problem.steps.allowed & problem.steps.safe) is not None
        decided += one.policy != problem.false
    assert min(by_blocks, decided) > 30


def test_blocks_have_no_state_twice() -> None:
    """Together the blocks have all pairs, each once, and no state has two pairs in one."""
    seen = 0
    for seed in range(40):
        problem = build_problem(parse(text_of_places(Random(seed))), "any", available_backend())
        manager, relation = problem.encoding.manager, problem.steps.allowed
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(blocks, "LEAST_ACTIONS", 0)
            patched.setattr(blocks, "LEAST_TOGETHER", 1)
            found = blocks_of(problem, relation)
        if found is None:
            continue
        count = manager.count
        every = problem.encoding.all_state_bits
        assert manager.union(block.pairs for block in found) == relation
        for block in found:
            states = problem.steps.states_of(block.pairs)
            assert count(states, every) == count(block.pairs, [*every, *problem.encoding.all_choice_bits])
        seen += 1 < len(found) < len(problem.spec.actions)
    assert seen > 20
