"""Active and residual goals as the explicit meaning has them; what the rules say is in `tests/conformance`."""

from __future__ import annotations

from tests.semantics.build import Build, chosen, constraint, priority, when
from tumato_symbolic.semantics import NOTHING, active_goals, residual_goal
from tumato_symbolic.spec import Or


def test_the_same_body_at_two_places_is_one_goal() -> None:
    """`Γ(t) = Γ(s)` compares sets of bodies, wherever in the tree they stand."""
    build = Build({"x": "ab", "y": "ab"})
    body = build.atom("y=b")
    spec = build.spec(priority(when(build.atom("x=a"), build.goal(body)), constraint(build.goal(body))))
    assert active_goals(spec, build.state("aa")) == active_goals(spec, build.state("ba")) != frozenset()


def test_a_residual_goal_keeps_only_the_actions_that_its_bodies_speak_of() -> None:
    """First sets that differ in other actions leave the same residual goal; those that differ in these do not."""
    build = Build({"x": "ab"})
    ring, other = build.action(), build.action()
    spec = build.spec(priority(build.goal(Or((build.atom("x=b"), ring)))))
    state = build.state("a")
    assert residual_goal(spec, state, chosen(other)) == residual_goal(spec, state, NOTHING)
    assert residual_goal(spec, state, chosen(ring)) == residual_goal(spec, state, chosen(ring, other))
    assert residual_goal(spec, state, chosen(ring)) != residual_goal(spec, state, NOTHING)
