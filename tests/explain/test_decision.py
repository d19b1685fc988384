"""Tests of `why`: the explicit meaning, told for one state."""

from tests.cli.inputs import AMR, AMR_POLICY
from tumato_symbolic import Policy, parse
from tumato_symbolic.explain.decision import Decisions, alternative, goal_notes, why
from tumato_symbolic.policy import bind
from tumato_symbolic.semantics import active_goals, all_states, allowed, duration, is_safe

SPEC = parse(AMR.read_text())
POLICY = Decisions(SPEC, bind(Policy.load(AMR_POLICY), SPEC))


def test_the_goals_told_are_the_active_ones() -> None:
    """In every state, the goals that are told as active are `Γ(s)`."""
    for state in all_states(SPEC):
        told = {note.body.formula for note in goal_notes(SPEC, state) if note.active and note.body}
        assert told == {SPEC.bodies[body].formula for body in active_goals(SPEC, state)}


def test_a_goal_is_told_with_its_own_line() -> None:
    """Two goals may ask for the same; each stands where it stands."""
    spec = parse(
        "BEGIN STATE VECTOR state S can be a, b, c END STATE VECTOR BEGIN GOALS goal type: priority\n"
        "when S is a then goal: true\nwhen S is b then goal: true\nEND GOALS"
    )
    lines = [[note.body.span.line for note in goal_notes(spec, (value,)) if note.body] for value in (0, 1, 2)]
    assert lines == [[2], [3], []]


def test_the_run_ends_in_the_goal_and_others_are_judged() -> None:
    """In every state the run meets the goal; what is forbidden is not allowed, and nothing is better."""
    for state in all_states(SPEC):
        decision = why(SPEC, POLICY, state, "any")
        assert decision.run.end == "goal"
        for other in decision.others:
            assert (other.verdict == "forbidden") == (not allowed(SPEC, state, other.chosen, "any"))
            if not is_safe(SPEC, state) and other.verdict not in ("forbidden", "misses"):
                assert duration(SPEC, other.chosen) >= decision.duration


def test_the_decision_itself_is_recognised() -> None:
    """Asked why not what the policy does, the answer is that it does."""
    for state in all_states(SPEC):
        assert alternative(SPEC, POLICY, state, POLICY[state], "any").verdict == "chosen"
