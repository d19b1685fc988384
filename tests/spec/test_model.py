"""The record of a specification: what is derived from its fields is never old, and no field of its own."""

from __future__ import annotations

import pickle

from msgspec.structs import replace

from tests.generate import NOWHERE
from tests.semantics.build import Build
from tumato_symbolic.spec import Action, Alternative, Spec, digest


def _spec() -> Spec:
    build = Build({"x": "abc"})
    build.action("x=b", ["x=c", "x=b", ""])
    return build.spec(state_rules=[build.atom("x=a"), build.atom("x=b")])


def test_effects_of_an_action() -> None:
    """The nominal assignment first, each once; none where no effect mentions a variable."""
    spec = _spec()
    (action,) = spec.actions
    assert action.effects == (((0, 1),), ((0, 2),), ())
    assert replace(action, nominal=()).effects == ((), ((0, 2),), ((0, 1),))
    idle = Action("idle", 1, frozenset(), (), (), (Alternative(((),), "none", NOWHERE),), NOWHERE)
    assert idle.effects == ()


def test_tiers_follow_the_severities() -> None:
    """The most severe first, one at least; a replaced record has those of its own rules."""
    spec = _spec()
    first, second = spec.state_rules
    assert spec.tiers == ((first, second),)
    severe = replace(spec, state_rules=(replace(first, severity=3), second))
    assert severe.tiers == ((second,), (replace(first, severity=3),))
    assert (spec.restores_stepwise, severe.restores_stepwise) == (False, True)
    assert replace(severe, state_rules=()).tiers == ((),)
    assert severe.in_one_step.tiers == spec.tiers


def test_what_is_derived_is_no_part_of_the_record() -> None:
    """Neither of its text nor of its hash; a pickled record comes back whole."""
    spec = _spec()
    assert "effects" not in repr(spec)
    assert "tiers" not in repr(spec)
    back = pickle.loads(pickle.dumps(spec))
    assert (back, hash(back), digest(back)) == (spec, hash(spec), digest(spec))
    assert (back.tiers, back.actions[0].effects) == (spec.tiers, spec.actions[0].effects)
