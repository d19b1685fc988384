"""Certificates of unrealizability are proved when they are right, and never when what they claim is false."""

from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.oracle import World, decide_world
from tests.semantics.build import rules
from tests.unrealizability import (
    CONFLICTS,
    assert_never_wrong,
    certified,
    changed,
    claim_is_true,
    unrealizable,
    unrealizable_specs,
)
from tumato_symbolic.policy.unrealizability import Conflict, NoAllowedSet, NoPlan, dumps, loads
from tumato_symbolic.spec import FALSE, Ordering
from tumato_symbolic.verify import verify_unrealizable

ORDERINGS = pytest.mark.parametrize("ordering", ["any", "first"])


@ORDERINGS
@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_certificates_of_generated_specifications_are_proved(profile: str, ordering: Ordering) -> None:
    """What `synthesize` gives is proved, as it is and through its file; without cubes Z3 proves it as well."""
    kinds = set()
    for spec, certificate in unrealizable_specs(profile, range(16), ordering):
        kinds.add(type(certificate.reason))
        verdict = verify_unrealizable(loads(dumps(certificate)), spec, ordering=ordering)
        assert (verdict.verdict, verdict.stale, verdict.ordering) == ("proved", False, ordering)
        assert claim_is_true(World(spec, ordering), certificate)
        if isinstance(certificate.reason, NoAllowedSet):
            open_claim = replace(certificate, reason=replace(certificate.reason, cubes=None))
            assert verify_unrealizable(open_claim, spec, ordering=ordering).verdict == "proved"
    assert kinds == {NoAllowedSet, NoPlan}


@ORDERINGS
@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_changed_certificates_are_never_wrongly_proved(profile: str, ordering: Ordering) -> None:
    """Cubes and layers that were changed are proved only where all that they claim is true."""
    met = set()
    for spec, certificate in unrealizable_specs(profile, range(5), ordering):
        world = World(spec, ordering)
        for seed in range(6):
            met.add(assert_never_wrong(world, changed(certificate, Random(seed))))
    assert "refuted" in met


@pytest.mark.parametrize("seed", CONFLICTS)
def test_conflicts_of_generated_specifications(seed: int) -> None:
    """A conflict is proved; changed, it is proved only where the states still cannot be served together."""
    spec = random_spec(seed, ALL_PROFILES["interacting"])
    certificate, _ = unrealizable(spec, Conflict)
    assert verify_unrealizable(loads(dumps(certificate)), spec, ordering="any").verdict == "proved"
    world = World(spec, "any")
    verdicts = [assert_never_wrong(world, changed(certificate, Random(dice))) for dice in range(12)]
    assert set(verdicts) == {"proved", "refuted"}


@ORDERINGS
def test_a_certificate_does_not_carry_over_to_a_realizable_specification(ordering: Ordering) -> None:
    """A certificate for a specification made harder proves nothing about the one that has a policy."""
    tried = 0
    for seed in range(20):
        spec = random_spec(seed, ALL_PROFILES["interacting" if seed % 2 else "restoring"])
        world = World(spec, ordering)
        if decide_world(world).kind != "realizable":
            continue
        dice = Random(seed)
        without = dice.randrange(len(spec.actions))
        never = replace(spec.actions[without], preconditions=rules(FALSE))
        harder = (
            replace(spec, max_plan_length=1),
            replace(spec, actions=(*spec.actions[:without], never, *spec.actions[without + 1 :])),
            replace(spec, state_rules=(*spec.state_rules, *rules(FALSE))),
        )
        for other in harder:
            certificate = certified(other, ordering)
            if certificate is not None:
                tried += 1
                assert verify_unrealizable(certificate, other, ordering=ordering).verdict == "proved"
                assert assert_never_wrong(world, certificate) == "refuted"
    assert tried >= 10
