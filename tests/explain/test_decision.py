"""Tests of `why`: the explicit meaning, told for one state."""

from tests.cli.inputs import AMR, AMR_POLICY
from tumato_symbolic import Policy, Realizable, parse, synthesize
from tumato_symbolic.explain.decision import Decisions, alternative, goal_notes, why
from tumato_symbolic.policy import bind
from tumato_symbolic.report.decided import Decided, as_text
from tumato_symbolic.report.objections import Place
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


DETOUR = """
BEGIN STATE VECTOR state P can be a, b, c, e, d END STATE VECTOR
BEGIN ACTIONS
action to_b preconditions: P is a nominal effects: P is b
action b_to_d preconditions: P is b nominal effects: P is d
action to_c preconditions: P is a nominal effects: P is c
action c_to_e preconditions: P is c nominal effects: P is e
action e_to_d preconditions: P is e nominal effects: P is d
END ACTIONS
BEGIN GOALS goal type: priority
when P is b then goal: P is d OR P is c
goal: P is d
END GOALS
"""


def test_a_shorter_run_through_other_goals_comes_later() -> None:
    """What is said against it is that, and not that the decision has to suit runs to other goals."""
    spec = parse(DETOUR)
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    decision = why(spec, Decisions(spec, outcome.policy), (0,), "any")
    assert (decision.chosen, decision.run.steps) == (frozenset((2,)), 3)
    (other,) = (each for each in decision.others if each.chosen == frozenset((0,)))
    assert (other.verdict, other.run and other.run.steps) == ("leaving", 2)
    told = as_text(Decided(Place(spec, "detour.tum"), "policy.json", decision, None))
    assert "{to_b}: its run, of 2 steps, passes states where other goals are active" in told


def test_what_is_said_against_the_others_is_the_order_of_preference() -> None:
    """A longer run, and more actions."""
    spec = parse(DETOUR.replace("e_to_d", "stay nominal effects: none\naction e_to_d"))
    outcome = synthesize(spec)
    assert isinstance(outcome, Realizable)
    decisions = Decisions(spec, outcome.policy)
    verdicts = {each.chosen: each.verdict for each in why(spec, decisions, (1,), "any").others}
    assert verdicts[frozenset()] == "longer"
    assert alternative(spec, decisions, (1,), frozenset((1, 4)), "any").verdict == "larger"
