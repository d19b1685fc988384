"""Active and residual goals as the explicit meaning has them; what the rules say is in `tests/conformance`."""

from __future__ import annotations

from tests.semantics.build import Build, chosen, constraint, priority, when
from tumato_symbolic import parse
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import NOTHING, active_goals, goals_as_written, residual_goal
from tumato_symbolic.spec import Or


def test_the_same_body_at_two_places_is_one_goal() -> None:
    """`Γ(t) = Γ(s)` compares sets of bodies, wherever in the tree they stand."""
    build = Build({"x": "ab", "y": "ab"})
    body = build.atom("y=b")
    spec = build.spec(priority(when(build.atom("x=a"), build.goal(body)), constraint(build.goal(body))))
    assert active_goals(spec, build.state("aa")) == active_goals(spec, build.state("ba")) != frozenset()


def test_goals_with_one_body_keep_their_own_places() -> None:
    """What is told of a state names the lines that are active there, not the first that reads the same."""
    text = "\n".join(
        [
            *("BEGIN STATE VECTOR", "state x can be a, b", "state y can be a, b", "END STATE VECTOR", "BEGIN ACTIONS"),
            *("action go", "nominal effects: y is b", "END ACTIONS", "BEGIN GOALS", "goal type: priority"),
            *("when x is a then goal: y is b", "when x is b then goal: y is b", "END GOALS", ""),
        ]
    )
    spec = parse(text)
    for state, line in (((0, 0), 11), ((1, 0), 12)):
        assert [(body, rule.span.line) for body, rule in goals_as_written(spec, state)] == [(0, line)]
        assert Place(spec, "x.tum").goals(state) == f"`y is b` (x.tum:{line})"


def test_a_residual_goal_keeps_only_the_actions_that_its_bodies_speak_of() -> None:
    """First sets that differ in other actions leave the same residual goal; those that differ in these do not."""
    build = Build({"x": "ab"})
    ring, other = build.action(), build.action()
    spec = build.spec(priority(build.goal(Or((build.atom("x=b"), ring)))))
    state = build.state("a")
    assert residual_goal(spec, state, chosen(other)) == residual_goal(spec, state, NOTHING)
    assert residual_goal(spec, state, chosen(ring)) == residual_goal(spec, state, chosen(ring, other))
    assert residual_goal(spec, state, chosen(ring)) != residual_goal(spec, state, NOTHING)
