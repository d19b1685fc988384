"""Active goals as sets of states, against the walk of one state."""

from __future__ import annotations

from tests.generate import PROFILES, random_spec
from tests.semantics.build import Build, constraint, priority, when
from tumato_symbolic.semantics import active_goals, all_states, is_valid
from tumato_symbolic.spec import Spec
from tumato_symbolic.symbolic import available_backend, build_steps, encode, regions


def check_regions(spec: Spec) -> None:
    """Every valid state is in the region of its own `Γ`, and in no other."""
    encoding = encode(spec, available_backend())
    found = regions(encoding, build_steps(encoding, spec, "any").valid)
    for state in all_states(spec):
        homes = [active for active, states in found.items() if encoding.contains(states, state)]
        assert homes == ([active_goals(spec, state)] if is_valid(spec, state) else []), state


def test_one_body_twice_in_a_constraint_list() -> None:
    """A body that stands alone and again under a condition is one goal, whether the condition holds or not."""
    build = Build({"x": "ab"})
    body = build.goal(build.atom("x=b"))
    check_regions(build.spec(constraint(body, priority(when(build.atom("x=a"), body)))))


def test_regions_are_the_active_goals_of_every_state() -> None:
    """The sets that synthesis works on are `Γ`, state by state, nested lists and repeated bodies included."""
    for profile in PROFILES.values():
        for seed in range(60):
            check_regions(random_spec(seed, profile))
