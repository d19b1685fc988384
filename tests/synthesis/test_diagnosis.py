"""What would restore the states that cannot be restored in one step, against the explicit meaning and known answers."""

from dataclasses import replace

import pytest

from tests.generate import random_spec
from tests.profiles import RESTORING
from tests.repo.documents import ROOT
from tests.restoration.truth import World
from tests.semantics.test_restoration import RETRY, VALVES
from tumato_symbolic import Unrealizable, parse, synthesize
from tumato_symbolic.semantics import State, count_states
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.synthesis import Cured, Restorability


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


@pytest.mark.parametrize("seed", range(6000, 6025))
def test_generated(seed: int) -> None:
    """Every state without an allowed set is told once, with the first way to restore safety that would do."""
    spec = random_spec(seed, RESTORING)
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
        jumped = {state for state in stuck if _after(state, joint.effects) in world.safe}
        assert jumped
        assert spec.reaction_rules or joint.left <= len(stuck) - len(jumped)


def _after(state: State, effects: tuple[tuple[int, int], ...]) -> State:
    written = dict(effects)
    return tuple(written.get(variable, value) for variable, value in enumerate(state))
