"""Section 5 of the semantics: nominal runs, and the judgement of a policy."""

from __future__ import annotations

import pytest

from tests.semantics.build import Build, chosen, priority, when
from tumato_symbolic.semantics import NOTHING, follow, judge
from tumato_symbolic.spec import Executing, Not, Or, Ordering, Spec


def corridor(bound: int | None = None) -> tuple[Build, Spec, list[Executing]]:
    """Places a, b, c and d in a row; the goal is d everywhere."""
    build = Build({"x": "abcd"})
    moves = [build.action(f"x={there}", when=[build.atom(f"x={here}")]) for here, there in ("ab", "bc", "cd")]
    return build, build.spec(priority(build.goal(build.atom("x=d"))), bound=bound), moves


def test_a_goal_needs_one_step_at_least() -> None:
    """`k ≥ 1`: where the goal already holds, the run must hold it again after a step."""
    build = Build({"x": "ab"})
    leave = build.action("x=b", when=[build.atom("x=a")])
    back = build.action("x=a", when=[build.atom("x=b")])
    spec = build.spec(priority(build.goal(build.atom("x=a"))))
    at_a, at_b = build.state("a"), build.state("b")
    assert follow(spec, {at_a: NOTHING, at_b: chosen(back)}, at_a, NOTHING).steps == 1
    assert follow(spec, {at_a: NOTHING, at_b: chosen(back)}, at_a, chosen(leave)).steps == 2
    assert judge(spec, {at_a: chosen(leave), at_b: NOTHING}, "any").goal_missed[0][0] == at_a


def test_the_bound_counts_steps() -> None:
    """A run of exactly `max_plan_length` steps is in time, one step more is not; without a bound any length is."""
    for bound, end in ((None, "goal"), (3, "goal"), (2, "bound")):
        build, spec, moves = corridor(bound)
        policy = {build.state(place): chosen(move) for place, move in zip("abc", moves, strict=True)}
        policy[build.state("d")] = NOTHING
        run = follow(spec, policy, build.state("a"), policy[build.state("a")])
        assert run.end == end
        assert judge(spec, policy, "any").sound_and_complete == (end == "goal")
        assert judge(spec, policy, "any").longest_run == (3 if end == "goal" else 2)


def test_a_loop_misses_the_goal() -> None:
    """A run that comes back without the goal never reaches it, and the judge says so for every state on the way."""
    build, spec, moves = corridor()
    policy = {build.state(place): chosen(move) for place, move in zip("abc", moves, strict=True)}
    policy |= {build.state("d"): NOTHING, build.state("c"): NOTHING}
    judgement = judge(spec, policy, "any")
    assert [state for state, _ in judgement.goal_missed] == [build.state(place) for place in "abc"]
    assert {run.end for _, run in judgement.goal_missed} == {"loop"}


def test_a_state_met_twice_may_act_differently_the_first_time() -> None:
    """`follow` takes the first set as given: coming back to the start is no loop when the policy goes on."""
    build, spec, moves = corridor()
    policy = {build.state(place): chosen(move) for place, move in zip("abc", moves, strict=True)}
    assert follow(spec, policy, build.state("a"), NOTHING).steps == 4


def test_the_run_may_pass_through_other_goals_and_only_its_own_counts() -> None:
    """`Γ` is that of the first state, although other goals are active on the way."""
    build = Build({"x": "abc"})
    on = build.action("x=b", when=[build.atom("x=a")])
    end = build.action("x=c", when=[build.atom("x=b")])
    goals = priority(when(build.atom("x=a"), build.goal(build.atom("x=c"))), build.goal(Not(build.atom("x=a"))))
    policy = {build.state("a"): chosen(on), build.state("b"): chosen(end), build.state("c"): NOTHING}
    judgement = judge(build.spec(goals), policy, "any")
    assert judgement.sound_and_complete
    assert judgement.longest_run == 2


def test_executing_is_that_of_the_first_decision() -> None:
    """`executing a` holds for the whole run when the first set has `a`, whatever the later decisions are."""
    build = Build({"x": "abc"})
    ring = build.action("x=b", when=[build.atom("x=a")])
    on = build.action("x=c", when=[build.atom("x=b")])
    goals = priority(when(build.atom("x=a"), build.goal(ring)), when(build.atom("x=b"), build.goal(Not(ring))))
    spec = build.spec(goals)
    policy = {build.state("a"): chosen(ring), build.state("b"): chosen(on), build.state("c"): NOTHING}
    assert judge(spec, policy, "any").sound_and_complete
    policy[build.state("a")] = NOTHING
    assert [state for state, _ in judge(spec, policy, "any").goal_missed] == [build.state("a")]


def test_a_policy_must_be_total_and_allowed() -> None:
    """Missing states and sets that are not allowed are named; what is said of states that are not valid is ignored."""
    build, spec, moves = corridor()
    judgement = judge(spec, {build.state("a"): chosen(moves[1])}, "any")
    assert judgement.missing == tuple(build.state(place) for place in "bcd")
    assert [(state, why.kind) for state, why in judgement.not_allowed] == [(build.state("a"), "precondition")]
    assumed = build.spec(assumptions=[build.atom("x=a")])
    assert judge(assumed, {build.state("a"): NOTHING, build.state("b"): chosen(moves[0])}, "any").sound_and_complete


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_minimal_means_no_cheaper_set_that_serves(ordering: Ordering) -> None:
    """In an unsafe state only; equal durations do not count, nor a cheaper set whose run misses the goal."""
    build = Build({"x": "abcd"})
    unsafe = build.atom("x=d")
    slow = build.action("x=a", when=[unsafe], duration=3)
    also = build.action("x=a", when=[unsafe], duration=3)
    quick_astray = build.action("x=c", when=[unsafe], duration=1)
    on = build.action("x=b", when=[build.atom("x=a")], duration=7)
    free = build.action()
    spec = build.spec(priority(when(Or((unsafe, build.atom("x=a"))), build.goal(build.atom("x=b")))), [Not(unsafe)])
    rest = {build.state("a"): chosen(on, free), build.state("b"): NOTHING, build.state("c"): NOTHING}
    for decision in (chosen(slow), chosen(also), chosen(slow, also)):
        judgement = judge(spec, {**rest, build.state("d"): decision}, ordering)
        assert judgement.sound_and_complete
        cheaper = ((build.state("d"), chosen(slow)),) if len(decision) == 2 else ()
        assert judgement.not_minimal == cheaper
    astray = judge(spec, {**rest, build.state("d"): chosen(quick_astray)}, ordering)
    assert [state for state, _ in astray.goal_missed] == [build.state("d")]


def test_a_cheaper_set_must_be_in_time_too() -> None:
    """Within `max_plan_length` the dear set is minimal when the cheap one comes too late."""
    for bound, minimal in ((2, False), (1, True)):
        build = Build({"x": "abc"})
        dear = build.action("x=a", when=[build.atom("x=c")], duration=5)
        cheap = build.action("x=b", when=[build.atom("x=c")], duration=1)
        on = build.action("x=a", when=[build.atom("x=b")])
        spec = build.spec(priority(build.goal(build.atom("x=a"))), [Not(build.atom("x=c"))], bound=bound)
        policy = {build.state("a"): NOTHING, build.state("b"): chosen(on), build.state("c"): chosen(dear)}
        judgement = judge(spec, policy, "any")
        assert judgement.sound_and_complete
        assert judgement.minimal == minimal
        assert judgement.not_minimal == (() if minimal else ((build.state("c"), chosen(cheap)),))
