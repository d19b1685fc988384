"""Every family, at its smallest size."""

from functools import cache

import pytest

from benchmarks.families import FAMILIES
from tumato_symbolic import Realizable, Unrealizable, synthesize
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.semantics import all_states, allowed_sets, count_states, is_safe, is_valid
from tumato_symbolic.spec import Spec, load
from tumato_symbolic.synthesis import SynthesisResult

NAMES = sorted(FAMILIES)
COUNTED_UP_TO = 50_000
LONG_TEXTS = {"grid", "obstacles", "counter", "loads"}
"""Families whose large sizes take long to read; of them the quick ones are read."""


@cache
def _solved(name: str, realizable: bool) -> tuple[Spec, SynthesisResult]:
    family = FAMILIES[name]
    spec = load(Source(name, family.text(family.sizes[0], realizable))).spec
    assert spec is not None
    return spec, synthesize(spec)


@pytest.mark.parametrize("realizable", [True, False], ids=["realizable", "twin"])
@pytest.mark.parametrize("name", NAMES)
def test_every_size_is_a_specification(name: str, realizable: bool) -> None:
    """No size of a family has an error, and the same size is the same text again."""
    family = FAMILIES[name]
    for size in family.quick if name in LONG_TEXTS else {*family.sizes, *family.quick}:
        text = family.text(size, realizable)
        loaded = load(Source(name, text))
        assert loaded.spec is not None, loaded.diagnostics
        assert text == family.text(size, realizable)


@pytest.mark.parametrize("name", NAMES)
def test_the_family_is_realizable(name: str) -> None:
    """The smallest size has a policy."""
    assert isinstance(_solved(name, True)[1], Realizable)


@pytest.mark.parametrize("name", NAMES)
def test_the_twin_is_not_realizable(name: str) -> None:
    """The twin of the smallest size has none."""
    assert isinstance(_solved(name, False)[1], Unrealizable)


@pytest.mark.parametrize("name", NAMES)
def test_counts_agree_with_the_explicit_meaning(name: str) -> None:
    """Valid and safe states are as many as the semantics counts one by one."""
    spec, outcome = _solved(name, True)
    counts = outcome.statistics
    assert counts is not None
    assert counts.total == count_states(spec)
    if counts.total <= COUNTED_UP_TO:
        valid = [state for state in all_states(spec) if is_valid(spec, state)]
        assert counts.valid == len(valid)
        assert counts.safe == sum(is_safe(spec, state) for state in valid)


def test_the_uav_has_the_size_of_the_published_class() -> None:
    """16 variables, 17 actions, 221,184 states of which 64,512 are valid; five actions are forced, seven allowed."""
    spec, outcome = _solved("uav", True)
    assert outcome.statistics is not None
    assert (len(spec.variables), len(spec.actions)) == (16, 17)
    assert (outcome.statistics.total, outcome.statistics.valid) == (221_184, 64_512)
    busy = {"S_Position": "site", "S_Flight": "flying", "S_Lights": "on", "S_Camera": "on", "S_Weather": "windy"}
    busy |= {"S_Battery": "low", "S_Link": "down", "S_Images": "stored", "S_Report": "sent"}
    state = tuple(variable.values.index(busy.get(variable.name, variable.values[0])) for variable in spec.variables)
    sets = list(allowed_sets(spec, state, "any"))
    assert min(map(len, sets)) == 5
    assert max(map(len, sets)) == 7


def test_the_factory_has_the_size_of_the_paper() -> None:
    """2,688 valid states and 18 actions."""
    spec, outcome = _solved("factory", True)
    assert outcome.statistics is not None
    assert (outcome.statistics.valid, len(spec.actions)) == (2_688, 18)


def test_the_plant_is_what_it_promises() -> None:
    """About 1 % of the states are unsafe, half of the actions have alternatives, runs have 10 steps and more."""
    spec, outcome = _solved("plant", True)
    assert isinstance(outcome, Realizable)
    counts = outcome.statistics
    assert 0.009 < counts.unsafe / counts.valid < 0.011
    assert 2 * sum(bool(action.alternatives) for action in spec.actions) >= len(spec.actions) >= 20
    assert counts.longest_run is not None
    assert counts.longest_run >= 10
    assert len(spec.bodies) == 3
    assert counts.changed > 0
