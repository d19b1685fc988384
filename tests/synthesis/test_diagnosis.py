"""What would restore the states that cannot be restored in one step, against the explicit meaning and known answers."""

from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import random_spec
from tests.profiles import RESTORING
from tests.repo.documents import ROOT
from tests.restoration.campaign import severe
from tests.restoration.truth import World
from tests.semantics.test_restoration import RETRY, VALVES
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.semantics import State, count_states, restored
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.synthesis import Cured, Restorability

BRAKE = """
BEGIN STATE VECTOR state Person can be clear, near state Speed can be stopped, slow, fast END STATE VECTOR
BEGIN ACTIONS
action brake duration: 1 preconditions: Speed is fast nominal effects: Speed is slow
action stop duration: 1 preconditions: Speed is slow nominal effects: Speed is stopped
END ACTIONS
BEGIN STATE RULES
severity: 1 rule: IF Person is near THEN Speed is stopped
severity: 2 rule: IF Speed is fast THEN Person is clear
END STATE RULES
"""
TWO_SEVERE = """
BEGIN STATE VECTOR
state A can be open, closed state B can be open, closed state Horn can be silent, sounding
END STATE VECTOR
BEGIN ACTIONS
action close_a duration: 1 nominal effects: A is closed
action close_b duration: 1 nominal effects: B is closed
action sound preconditions: A is closed, B is closed nominal effects: Horn is sounding
END ACTIONS
BEGIN STATE RULES severity: 1 rule: A is closed rule: B is closed severity: 2 rule: Horn is sounding END STATE RULES
BEGIN ASSUMPTIONS assume: IF Horn is sounding THEN (A is closed AND B is closed) END ASSUMPTIONS
"""
"""No set closes both valves and sounds the horn."""


def found(spec: Spec) -> Restorability | None:
    """What synthesis says of a specification."""
    outcome = synthesize(spec, certify=False)
    return outcome.restorability if isinstance(outcome, Unrealizable) else None


def cured(spec: Spec) -> dict[str, Cured]:
    """The states that cannot be restored in one step, by what would do."""
    diagnosis = found(spec)
    assert diagnosis is not None
    return {each.cure: each for each in diagnosis.cured}


def test_two_faults_take_two_steps_or_one_joint_action() -> None:
    """Both valves open: one is closed after the other, or both by one action that has both effects."""
    spec = parse(VALVES)
    diagnosis = found(spec)
    assert diagnosis is not None
    (only,) = diagnosis.cured
    assert (only.cure, only.count, only.example) == ("bounded", 1, (0, 0))
    assert (only.worst, only.most_steps) == ((2, 2), 2)
    assert [(joint.effects, joint.left) for joint in diagnosis.joint] == [(((0, 1), (1, 1)), 0)]


def test_what_may_do_nothing_is_restored_under_fair_only() -> None:
    """An action whose alternative is to change nothing; without effects nothing would do."""
    assert {cure: each.count for cure, each in cured(parse(RETRY)).items()} == {"fair": 1}
    idle = RETRY.replace("nominal effects: M is off", "nominal effects: none")
    assert {cure: each.count for cure, each in cured(parse(idle)).items()} == {"nothing": 1}


def test_two_robots() -> None:
    """112 states have two faults or more; three steps restore all of them."""
    spec = parse((ROOT / "examples" / "two_robots.tum").read_text(encoding="utf-8"))
    (only,) = cured(spec).values()
    assert (only.cure, only.count, only.most_steps) == ("bounded", 112, 3)
    assert only.efforts == (((2, 2), 48), ((3, 2), 48), ((4, 3), 16))


def test_where_no_bound_can_be_kept_repetition_may_do() -> None:
    """Under `bounded`: from where `fair` would restore safety, and from where nothing would."""
    bounded = replace(parse(RETRY), restoration="bounded")
    assert {cure: each.count for cure, each in cured(bounded).items()} == {"fair": 1}
    idle = replace(parse(RETRY.replace("nominal effects: M is off", "nominal effects: none")), restoration="bounded")
    assert {cure: each.count for cure, each in cured(idle).items()} == {"nothing": 1}


@pytest.mark.parametrize("seed", range(6100, 6115))
def test_generated_under_bounded(seed: int) -> None:
    """Every state that no bound restores is told once, with whether `fair` would."""
    spec = replace(random_spec(seed, RESTORING), restoration="bounded")
    if count_states(spec) > 48:
        pytest.skip("the explicit meaning takes long")
    world = World(spec, spec.ordering)
    stuck = {state for state in world.valid if state not in world.safe} - world.restorable
    fairly = stuck & _restored(spec, "fair")
    diagnosis = found(spec)
    if diagnosis is None:
        assert not stuck
        return
    told = {
        each.cure: {state for state in world.valid if diagnosis.states.evaluate(each.root, state)}
        for each in diagnosis.cured
    }
    assert told == {cure: states for cure, states in (("fair", fairly), ("nothing", stuck - fairly)) if states}
    assert not diagnosis.joint


def test_where_all_is_restored_or_nothing_less_can_be_asked_nothing_is_said() -> None:
    """What is unrealizable for another reason has no diagnosis, and it can be left out."""
    idle = RETRY.replace("nominal effects: M is off", "nominal effects: none")
    assert found(replace(parse(idle), restoration="fair")) is None
    outcome = synthesize(parse(VALVES), certify=False, diagnose=False)
    assert isinstance(outcome, Unrealizable)
    assert outcome.restorability is None


def _restored(spec: Spec, restoration: Restoration) -> frozenset[State]:
    return World(replace(spec, restoration=restoration), spec.ordering).restorable


def test_severities_raise_the_level_in_several_steps_or_by_one_joint_action() -> None:
    """What would do is told as with one severity; a joint action need not reach safety."""
    (only,) = cured(parse(BRAKE)).values()
    assert (only.cure, only.count, only.worst) == ("bounded", 1, (2, 2))
    diagnosis = found(parse(TWO_SEVERE))
    assert diagnosis is not None
    assert [(each.cure, each.count) for each in diagnosis.cured] == [("bounded", 1)]
    assert [(joint.effects, joint.left) for joint in diagnosis.joint] == [(((0, 1), (1, 1)), 0)]


@pytest.mark.parametrize(
    ("seed", "tiers"), [*((seed, 1) for seed in range(6000, 6025)), *((seed, 2) for seed in range(6000, 6040))]
)
def test_generated(seed: int, tiers: int) -> None:
    """Every state without an allowed set is told once, with the first way to restore safety that would do."""
    spec = random_spec(seed, RESTORING)
    if tiers > 1:
        spec = severe(spec, "one_step", Random(seed))
    if count_states(spec) > 48:
        pytest.skip("the explicit meaning takes long")
    world = World(spec, spec.ordering)
    stuck = {state for state in world.valid if not world.options[state] and state not in world.safe}
    diagnosis = found(spec)
    if diagnosis is None:
        assert not stuck
        return
    surely = stuck & _restored(spec, "bounded")
    truth = {"bounded": surely, "fair": (stuck & _restored(spec, "fair")) - surely}
    truth["nothing"] = stuck - truth["bounded"] - truth["fair"]
    told = {
        each.cure: {state for state in world.valid if diagnosis.states.evaluate(each.root, state)}
        for each in diagnosis.cured
    }
    assert told == {cure: states for cure, states in truth.items() if states}
    for each in diagnosis.cured:
        assert each.count == len(told[each.cure])
        assert each.example in told[each.cure]
        assert sum(number for _, number in each.efforts) == (each.count if each.cure == "bounded" else 0)
    for joint in diagnosis.joint:
        jumped = {state for state in stuck if restored(spec, state, _after(state, joint.effects))}
        assert jumped
        assert spec.reaction_rules or joint.left <= len(stuck) - len(jumped)


def _after(state: State, effects: tuple[tuple[int, int], ...]) -> State:
    written = dict(effects)
    return tuple(written.get(variable, value) for variable, value in enumerate(state))
