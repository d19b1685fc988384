"""The order of the variables: near each other what is related, and no decision depends on it."""

from __future__ import annotations

from random import Random

import pytest

from benchmarks.families import FAMILIES
from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.policy import Table
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.symbolic import build_steps, encode, lay_out, layout
from tumato_symbolic.symbolic.order import variable_order
from tumato_symbolic.synthesis import Realizable, SynthesisResult, Undecided, Unrealizable, synthesize


def family(name: str, size: int) -> Spec:
    """A specification of a benchmark family."""
    spec = load(Source(name, FAMILIES[name].text(size, True))).spec
    assert spec is not None
    return spec


def answer(outcome: SynthesisResult) -> object:
    """All decisions, or all failing states; of a conflict its kind: there may be many minimal sets."""
    match outcome:
        case Realizable(policy):
            assert isinstance(policy.decisions, Table)
            return policy.decisions.rows
        case Unrealizable(failures):
            return [(failure.kind, failure.kind != "conflict" and failure.states) for failure in failures]
        case Undecided(limit):
            return limit


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_every_variable_has_a_place(profile: str) -> None:
    """The order is a permutation, and the same specification has the same one."""
    for seed in range(20):
        spec = random_spec(seed, ALL_PROFILES[profile])
        assert sorted(variable_order(spec)) == list(range(len(spec.variables)))
        assert variable_order(spec) == variable_order(random_spec(seed, ALL_PROFILES[profile]))


@pytest.mark.parametrize("profile", sorted(ALL_PROFILES))
def test_no_decision_depends_on_the_order(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Policies and failing states are the same whatever the order of the variables."""
    specs = [random_spec(seed, ALL_PROFILES[profile]) for seed in range(15)]
    found = [answer(synthesize(spec)) for spec in specs]
    for shuffle in (1, 2):
        monkeypatch.setattr(layout, "variable_order", lambda spec, seed=shuffle: _shuffled(spec, seed))
        assert [answer(synthesize(spec)) for spec in specs] == found


def _shuffled(spec: Spec, seed: int) -> tuple[int, ...]:
    return tuple(Random(seed).sample(range(len(spec.variables)), len(spec.variables)))


def test_a_brake_stands_beside_its_drive() -> None:
    """Variables that are declared far apart and related are tested one after the other."""
    spec = family("pairs", 8)
    places = {spec.variables[variable].name: place for place, variable in enumerate(variable_order(spec))}
    drives = [name for name in places if name.startswith("S_Drive")]
    assert len(drives) == 8
    for drive in drives:
        assert abs(places[drive] - places[drive.replace("Drive", "Brake")]) == 1


def test_where_the_robot_is_comes_first() -> None:
    """A variable that most actions read or write is tested first, wherever it is declared."""
    spec = family("samples", 8)
    assert spec.variables[variable_order(spec)[0]].name == "S_Location"


def test_the_order_pays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of variables in a random order, the relation of allowed steps is many times larger."""
    spec = family("plant", 4)
    ours = _nodes(spec)
    monkeypatch.setattr(layout, "variable_order", lambda spec: _shuffled(spec, 2))
    assert _nodes(spec) > 3 * ours


def _nodes(spec: Spec) -> int:
    steps = build_steps(lay_out(spec, "autoref"), spec, "any")
    return len(steps.encoding.manager.descending(steps.allowed))


def test_choices_stand_above_what_they_write() -> None:
    """The bits of a group stand just above the first variable, as it is tested, that one of its actions writes."""
    spec = family("strewn", 4)
    encoded = encode(spec, "autoref")
    place = {bit: number for number, bit in enumerate(encoded.manager.bits)}
    assert encoded.order != tuple(range(len(spec.variables)))
    for group in encoded.groups:
        written = {v for action in group.actions for effect in spec.actions[action].effects for v, _ in effect}
        first = min(place[bit] for variable in written for bit in encoded.state_bits[variable])
        between = encoded.manager.bits[place[group.bits[-1]] + 1 : first]
        assert place[group.bits[0]] < first
        assert all(bit.startswith("g") for bit in between)
