"""Section 4 of the semantics: which goals are active, and what is left of them."""

from __future__ import annotations

from tests.semantics.build import Build, chosen, constraint, priority, when
from tumato_symbolic.semantics import NOTHING, active_goals, reached, residual_goal
from tumato_symbolic.spec import TRUE, And, Not, Or


def test_without_goals_nothing_is_active() -> None:
    """`Γ(s) = ∅` without a goal block and where nothing is entered; then any state reaches the residual goal."""
    build = Build({"x": "ab"})
    for goals in (None, priority(), constraint(when(build.atom("x=b"), build.goal(TRUE)))):
        spec = build.spec(goals)
        assert active_goals(spec, build.state("a")) == frozenset()
        assert reached(spec, residual_goal(spec, build.state("a"), NOTHING), build.state("b"))


def test_priority_stops_after_the_first_entered_member() -> None:
    """A conditional goal whose condition fails is passed over; the first that is entered ends the walk."""
    build = Build({"x": "abc"})
    first, second, third = (build.goal(build.atom(f"x={value}")) for value in "abc")
    spec = build.spec(priority(when(build.atom("x=b"), first), when(Not(build.atom("x=c")), second), third))
    assert [active_goals(spec, build.state(value)) for value in "abc"] == [{1}, {0}, {2}]


def test_priority_stops_at_an_entered_list_that_yields_nothing() -> None:
    """An entered nested list ends the walk even when nothing in it is active; one that is not entered does not."""
    build = Build({"x": "ab", "y": "ab"})
    never = when(build.atom("y=b"), build.goal(build.atom("x=a")))
    last = build.goal(build.atom("x=b"))
    for nested in (priority(never), constraint(never), priority(), constraint()):
        unconditional = build.spec(priority(nested, last))
        assert active_goals(unconditional, build.state("aa")) == frozenset()
        conditional = build.spec(priority(when(build.atom("x=a"), nested), last))
        assert active_goals(conditional, build.state("aa")) == frozenset()
        assert active_goals(conditional, build.state("ba")) == {last.body}


def test_a_constraint_list_tries_every_member() -> None:
    """Every member is tried, also after one that was entered; conditions still decide."""
    build = Build({"x": "ab", "y": "ab"})
    one, two, three = (build.goal(build.atom(text)) for text in ("x=a", "x=b", "y=a"))
    spec = build.spec(constraint(one, when(build.atom("y=b"), two), priority(three, one)))
    assert active_goals(spec, build.state("aa")) == {one.body, three.body}
    assert active_goals(spec, build.state("ab")) == {one.body, two.body, three.body}


def test_a_nested_list_is_walked_by_its_own_kind() -> None:
    """A priority list in a constraint list stops its own walk only."""
    build = Build({"x": "ab", "y": "ab"})
    bodies = [build.goal(build.atom(text)) for text in ("x=a", "x=b", "y=a", "y=b")]
    spec = build.spec(constraint(priority(bodies[0], bodies[1]), constraint(bodies[2], bodies[3])))
    assert active_goals(spec, build.state("aa")) == {0, 2, 3}


def test_the_same_body_at_two_places_is_one_goal() -> None:
    """`Γ(t) = Γ(s)` compares sets of bodies, wherever in the tree they stand."""
    build = Build({"x": "ab", "y": "ab"})
    body = build.atom("y=b")
    spec = build.spec(priority(when(build.atom("x=a"), build.goal(body)), constraint(build.goal(body))))
    assert active_goals(spec, build.state("aa")) == active_goals(spec, build.state("ba")) != frozenset()


def test_executing_is_settled_by_the_first_set_and_the_rest_by_the_state_reached() -> None:
    """Also within one disjunction: `X OR executing a`, `executing a AND X`, `NOT executing a`."""
    build = Build({"x": "ab"})
    ring, other = build.action(), build.action()
    at_b = build.atom("x=b")
    here, there = build.state("a"), build.state("b")
    for body, with_ring, without in (
        (Or((at_b, ring)), (True, True), (False, True)),
        (And((ring, at_b)), (False, True), (False, False)),
        (Not(ring), (False, False), (True, True)),
    ):
        spec = build.spec(priority(build.goal(body)))
        for first, expected in ((chosen(ring, other), with_ring), (chosen(other), without)):
            goal = residual_goal(spec, here, first)
            assert (reached(spec, goal, here), reached(spec, goal, there)) == expected


def test_a_residual_goal_keeps_only_the_actions_that_its_bodies_speak_of() -> None:
    """First sets that differ in other actions leave the same residual goal; those that differ in these do not."""
    build = Build({"x": "ab"})
    ring, other = build.action(), build.action()
    spec = build.spec(priority(build.goal(Or((build.atom("x=b"), ring)))))
    state = build.state("a")
    assert residual_goal(spec, state, chosen(other)) == residual_goal(spec, state, NOTHING)
    assert residual_goal(spec, state, chosen(ring)) == residual_goal(spec, state, chosen(ring, other))
    assert residual_goal(spec, state, chosen(ring)) != residual_goal(spec, state, NOTHING)
