"""Tests of dropping elements."""

from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tumato_symbolic.explain.elements import elements_of, keep_only, without
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.spec import Ordering
from tumato_symbolic.symbolic import available_backend, build_steps


@pytest.mark.parametrize("profile", ALL_PROFILES)
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_allowed_steps_are_a_conjunction_over_elements(profile: str, ordering: Ordering) -> None:
    """With any elements dropped, the allowed steps are those of the specification without them."""
    random = Random(profile)
    for seed in range(12):
        spec = random_spec(seed, ALL_PROFILES[profile])
        requirements = Requirements(spec, ordering, available_backend())
        for share in (0.3, 0.7, 1.0):
            kept = frozenset(each for each in elements_of(spec) if random.random() < share)
            expected = build_steps(requirements.encoding, keep_only(spec, kept), ordering)
            found = requirements.steps(kept)
            assert (found.valid, found.safe) == (expected.valid, expected.safe)
            assert found.allowed & requirements.valid == expected.allowed & requirements.valid


def test_dropping_nothing_changes_nothing() -> None:
    """A specification without no elements is itself; without all of them only effects and goals remain."""
    for seed in range(40):
        spec = random_spec(seed)
        assert without(spec, ()) == spec
        bare = without(spec, elements_of(spec))
        assert not elements_of(bare)
        assert [action.nominal for action in bare.actions] == [action.nominal for action in spec.actions]
        assert (bare.goals, bare.bodies) == (spec.goals, spec.bodies)
