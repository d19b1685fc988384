"""Active and residual goals as the explicit meaning has them; what the rules say is in `tests/conformance`."""

from __future__ import annotations

from tests.semantics.build import Build, chosen, constraint, priority, when
from tumato_symbolic import parse
from tumato_symbolic.explain.decision import goal_notes
from tumato_symbolic.report.objections import Place
from tumato_symbolic.semantics import NOTHING, active_goals, goals_as_written, residual_goal
from tumato_symbolic.spec import Or


def test_the_same_body_at_two_places_is_one_goal() -> None:
    """`Γ(t) = Γ(s)` compares sets of bodies, wherever in the tree they stand."""
    build = Build({"x": "ab", "y": "ab"})
    body = build.atom("y=b")
    spec = build.spec(priority(when(build.atom("x=a"), build.goal(body)), constraint(build.goal(body))))
    assert active_goals(spec, build.state("aa")) == active_goals(spec, build.state("ba")) != frozenset()


def test_goals_with_one_body_keep_their_own_places_and_words() -> None:
    """What is told of a state names the lines that are active there, as they are written, not the first of a body."""
    text = "\n".join(
        [
            *("BEGIN STATE VECTOR", "state x can be a, b", "state y can be a, b", "END STATE VECTOR"),
            *("BEGIN ALIASES", "define done as y is b", "END ALIASES", "BEGIN ACTIONS"),
            *("action go", "nominal effects: y is b", "END ACTIONS", "BEGIN GOALS", "goal type: priority"),
            *("when x is a then goal: y is b", "when x is b then goal: done", "END GOALS", ""),
        ]
    )
    spec = parse(text)
    for state, line, words in (((0, 0), 14, "y is b"), ((1, 0), 15, "done")):
        assert [(body, rule.span.line) for body, rule in goals_as_written(spec, state)] == [(0, line)]
        assert Place(spec, "x.tum").goals(state) == f"`{words}` (x.tum:{line})"
        assert [note.body and note.body.text for note in goal_notes(spec, state) if note.active] == [words]


def test_a_residual_goal_keeps_only_the_actions_that_its_bodies_speak_of() -> None:
    """First sets that differ in other actions leave the same residual goal; those that differ in these do not."""
    build = Build({"x": "ab"})
    ring, other = build.action(), build.action()
    spec = build.spec(priority(build.goal(Or((build.atom("x=b"), ring)))))
    state = build.state("a")
    assert residual_goal(spec, state, chosen(other)) == residual_goal(spec, state, NOTHING)
    assert residual_goal(spec, state, chosen(ring)) == residual_goal(spec, state, chosen(ring, other))
    assert residual_goal(spec, state, chosen(ring)) != residual_goal(spec, state, NOTHING)
