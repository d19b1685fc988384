"""The explicit meaning against the text of the semantics, word for word, on small specifications."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics import literal
from tests.semantics.build import Build, chosen
from tumato_symbolic.semantics import (
    NOTHING,
    ActionSet,
    EffectStep,
    State,
    active_goals,
    all_states,
    allowed_sets,
    apply,
    broken_rule,
    count_states,
    duration,
    follow,
    is_safe,
    is_valid,
    judge,
    named,
    nominal_agrees,
    objections,
    outcomes,
    reached,
    residual_goal,
    settled_truth,
    successor,
)
from tumato_symbolic.spec import And, Constant, Executing, Formula, Iff, Is, Not, Or, Ordering, Spec

BOTH: tuple[Ordering, ...] = ("any", "first")
SPECS = [random_spec(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in range(2000, 2003)]


def _some(spec: Spec, count: int) -> list[literal.State]:
    return Random(0).sample(literal.states(spec), min(count, len(literal.states(spec))))


@pytest.mark.parametrize("ordering", BOTH)
def test_outcomes_are_the_ends_of_all_sequences(ordering: Ordering) -> None:
    """`Out(s, A)` state by state, each with a way of as few effects as any, of actions that take effect once."""
    for spec in SPECS:
        sets = [each for each in literal.sets(spec) if len(each) <= 3]
        for state in _some(spec, 2):
            for actions in sets:
                found = outcomes(spec, state, actions, ordering)
                assert {end: len(way) for end, way in found.items()} == literal.outcomes(spec, state, actions, ordering)
                for end, way in found.items():
                    here = state
                    for step in way:
                        assert step.effect in literal.effects(spec, step.action)
                        here = literal.changed(here, step.effect)
                        assert step.after == here
                    assert here == end
                    assert len({step.action for step in way}) == len(way)
                    assert {step.action for step in way} <= actions


def test_three_effects_in_every_order() -> None:
    """Which action still waits counts, not only the state that is reached: `b` by one action leaves others than by two.

    From a, the first action leads to b, the second (b to c through y) only matters when it comes after, and the
    third writes back. The same state with other actions waiting has other outcomes.
    """
    build = Build({"x": "abcd", "y": "ab"})
    one = build.action("x=b", alternatives=["y=b"])
    two = build.action("x=b", alternatives=["x=c"])
    three = build.action("y=b", alternatives=["x=d"])
    spec, start = build.spec(), build.state("aa")
    both = chosen(one, two, three)
    assert literal.outcomes(spec, start, both, "any") == {
        state: len(way) for state, way in outcomes(spec, start, both, "any").items()
    }
    assert set(outcomes(spec, start, both, "any")) == {build.state(x + y) for x, y in product("abcd", "ab")} - {start}
    assert set(outcomes(spec, start, both, "first")) == {build.state(text) for text in ("ba", "ab", "ca", "da")}


def test_two_ways_to_one_state_leave_different_actions() -> None:
    """After either of two actions with one effect the other one still waits, though the state is the same."""
    build = Build({"x": "abcd"})
    one = build.action("x=b", alternatives=["x=c"])
    two = build.action("x=b", alternatives=["x=d"])
    spec = build.spec()
    ends = outcomes(spec, build.state("a"), chosen(one, two), "any")
    assert set(ends) == {build.state(text) for text in "bcd"}
    build = Build({"x": "ab", "y": "ab", "z": "ab"})
    pair = [build.action("x=b", alternatives=["y=b"]), build.action("x=b", alternatives=["z=b"])]
    spec = build.spec()
    assert set(outcomes(spec, build.state("aaa"), chosen(*pair), "any")) == {
        build.state(text) for text in ("baa", "aba", "aab", "bba", "bab", "abb")
    }


@pytest.mark.parametrize("ordering", BOTH)
def test_every_condition_is_judged_as_written(ordering: Ordering) -> None:
    """The kinds of all objections to every set, and so `Ok(s, A)`; `allowed_sets` lists exactly these, in order."""
    for spec in SPECS:
        for state in _some(spec, 2):
            for actions in literal.sets(spec):
                if len(actions) <= 3:
                    kinds = {objection.kind for objection in objections(spec, state, actions, ordering)}
                    assert kinds == set(literal.broken(spec, state, actions, ordering))
    for spec in [each for each in SPECS if len(each.actions) <= 5]:
        for state in _some(spec, 2):
            assert list(allowed_sets(spec, state, ordering)) == literal.allowed(spec, state, ordering)


def test_objections_say_who_and_where() -> None:
    """Each objection names the actions to blame, in order, the rule that is broken, and the state that breaks it."""
    build = Build({"x": "abc", "y": "ab"}, resources=["arm"])
    one = build.action("x=b", needs=["arm"], when=[build.atom("y=a")])
    two = build.action("x=c", needs=["arm"], alternatives=["y=b"])
    rules = [Not(And((build.atom("x=b"), build.atom("y=b")))), Not(build.atom("x=c"))]
    spec = build.spec(state_rules=rules, reaction_rules=[Not(two)])
    state = build.state("ab")
    found = list(objections(spec, state, chosen(one, two), "any"))
    assert [(each.kind, each.actions) for each in found[:4]] == [
        ("precondition", (0,)),
        ("resource", (0, 1)),
        ("nominal-conflict", (0, 1)),
        ("reaction-rule", (0, 1)),
    ]
    assert (found[0].rule, found[3].rule) == (spec.actions[0].preconditions[0], spec.reaction_rules[0])
    assert [(each.state, each.rule) for each in found[4:]] == [
        (build.state("bb"), spec.state_rules[0]),
        (build.state("cb"), spec.state_rules[1]),
    ]
    first = EffectStep(0, ((0, 1),), build.state("bb"))
    assert found[4].outcome == (first,)
    (unsafe, nominal) = objections(spec, build.state("ca"), NOTHING, "first")
    assert (unsafe.kind, nominal.kind) == ("unsafe", "nominal-unsafe")
    assert (unsafe.actions, unsafe.outcome, unsafe.state) == ((), (), build.state("ca"))
    assert (nominal.actions, nominal.outcome, nominal.state) == ((), (), build.state("ca"))
    assert nominal.rule == spec.state_rules[1]


def test_states_validity_and_safety() -> None:
    """States come in row-major order; an assumption or a state rule that fails is named, assumptions first."""
    for spec in SPECS:
        assert list(all_states(spec)) == literal.states(spec)
        assert count_states(spec) == len(literal.states(spec))
        for state in literal.states(spec):
            assert is_valid(spec, state) == literal.valid(spec, state)
            assert is_safe(spec, state) == literal.safe(spec, state)
            rules = [*spec.assumptions, *spec.state_rules]
            assert broken_rule(spec, state) == next((r for r in rules if not literal.true(r.formula, state)), None)


def test_names_and_durations() -> None:
    """A state by the names of its values; durations of a set add up."""
    build = Build({"x": "abc", "y": "de"})
    one, two, three = (build.action(duration=length) for length in (3, 0, 4))
    spec = build.spec()
    assert named(spec, build.state("ce")) == {"x": "c", "y": "e"}
    assert [duration(spec, chosen(*actions)) for actions in ([], [one], [one, two], [one, two, three])] == [0, 3, 3, 7]
    assert apply(((1, 1), (0, 2)), build.state("ad")) == build.state("ce")


def test_nominal_effects_all_at_once() -> None:
    """Agreement and `δ` of every set."""
    for spec in SPECS:
        state = literal.states(spec)[-1]
        for actions in literal.sets(spec):
            assert nominal_agrees(spec, actions) == literal.agrees(spec, actions)
            if literal.agrees(spec, actions):
                assert successor(spec, state, actions) == literal.successor(spec, state, actions)


def test_goals_are_active_as_the_tree_says() -> None:
    """`Γ(s)` for every state; the residual goal keeps the actions that the active bodies speak of."""
    for spec in SPECS:
        for state in literal.states(spec):
            assert active_goals(spec, state) == literal.active(spec, state)
            for actions in literal.sets(spec)[:6]:
                residual = residual_goal(spec, state, actions)
                assert residual.bodies == literal.active(spec, state)
                bodies = [spec.bodies[body].formula for body in residual.bodies]
                after = literal.states(spec)[-1]
                assert reached(spec, residual, after) == all(literal.true(body, after, actions) for body in bodies)


def test_policies_are_judged_as_written() -> None:
    """What is missing, not allowed, not reached in time and not minimal, and the longest run, state by state."""
    met = set()
    for number, spec in enumerate(spec for spec in SPECS if len(spec.actions) <= 5 and len(literal.states(spec)) <= 12):
        random, ordering = Random(number), BOTH[number % 2]
        valid = [state for state in literal.states(spec) if literal.valid(spec, state)]
        options = {state: literal.allowed(spec, state, ordering) for state in valid}
        for chance in (1, 0.9):
            policy = {
                state: random.choice(options[state] if options[state] and random.random() < 0.9 else literal.sets(spec))
                for state in valid
                if random.random() < chance
            }
            judged = judge(spec, policy, ordering)
            bad = {state for state in policy if set(literal.broken(spec, state, policy[state], ordering))}
            runs = {state: literal.arrives(spec, policy, state, policy[state]) for state in policy if state not in bad}
            assert judged.missing == tuple(state for state in valid if state not in policy)
            assert [state for state, _ in judged.not_allowed] == [state for state in valid if state in bad]
            assert [state for state, _ in judged.goal_missed] == [s for s, steps in runs.items() if steps is None]
            assert judged.longest_run == max([steps for steps in runs.values() if steps is not None], default=0)
            cheaper = {
                state
                for state in policy
                if not literal.safe(spec, state)
                for each in options[state]
                if literal.duration(spec, each) < literal.duration(spec, policy[state])
                and literal.arrives(spec, policy, state, each) is not None
            }
            assert {state for state, _ in judged.not_minimal} == cheaper
            for state, each in judged.not_minimal:
                assert each in options[state]
            assert judged.sound_and_complete == (len(policy) == len(valid) and not bad and None not in runs.values())
            assert judged.minimal == (not cheaper)
            met |= {bool(judged.missing), len(bad) and "bad", "cheaper" if cheaper else ""}
    assert met >= {True, False, "cheaper"}


def line(bound: int | None) -> tuple[Build, Spec]:
    """Four places, one step at a time, to the last one."""
    build = Build({"x": "abcd"})
    for here, there in ("ab", "bc", "cd"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    goal = build.goal(build.atom("x=d"))
    from tests.semantics.build import priority

    return build, build.spec(priority(goal), bound=bound)


@pytest.mark.parametrize(
    ("bound", "end", "steps"), [(None, "goal", 3), (3, "goal", 3), (2, "bound", 2), (1, "bound", 1)]
)
def test_a_run_ends_at_the_bound(bound: int | None, end: str, steps: int) -> None:
    """A goal three steps away is met within three, and not within two."""
    build, spec = line(bound)
    policy: dict[State, ActionSet] = {
        (0,): frozenset((0,)),
        (1,): frozenset((1,)),
        (2,): frozenset((2,)),
        (3,): NOTHING,
    }
    run = follow(spec, policy, build.state("a"), policy[0,])
    assert (run.end, run.steps, run.states[0]) == (end, steps, (0,))
    assert run.states == tuple((place,) for place in range(steps + 1))
    assert run.decisions == tuple(policy[place,] for place in range(steps))
    assert follow(spec, policy, build.state("d"), NOTHING).steps == 1, "a goal that holds already takes a step"


def test_a_run_without_a_decision_or_in_a_loop() -> None:
    """A run ends where nothing is decided, where the decision has no successor, and where it comes back."""
    build, spec = line(None)
    stay: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): NOTHING}
    assert follow(spec, stay, (0,), stay[0,]).end == "loop"
    assert follow(spec, stay, (0,), stay[0,]).states == ((0,), (1,), (1,))
    assert follow(spec, {(0,): frozenset((0,))}, (0,), frozenset((0,))).end == "undefined"
    torn: dict[State, ActionSet] = {(0,): frozenset((0,)), (1,): frozenset((0, 1))}
    assert follow(spec, torn, (0,), torn[0,]).end == "undefined"
    assert follow(spec, {(1,): frozenset((1,)), (2,): frozenset((2,))}, (0,), frozenset((0,))).end == "goal"
    whole: dict[State, ActionSet] = {(place,): frozenset((place,)) for place in range(3)}
    assert follow(spec, whole, (0,), NOTHING).steps == 4, (
        "a first set that leads back is no loop where the policy goes on"
    )
    assert build.state("a") == (0,)


def _formulas(random: Random, depth: int) -> Formula:
    if depth == 0:
        return random.choice((Executing(0), Executing(1), Executing(2), Is(0, 1), Constant(True), Constant(False)))
    parts = tuple(_formulas(random, depth - 1) for _ in range(2))
    return random.choice((Not(parts[0]), And(parts), Or(parts), Iff(*parts)))


def test_settled_truth_is_never_wrong() -> None:
    """A truth value is that of every choice of the open actions, and is given where an operand decides alone."""
    random, met = Random(1), set()
    for _ in range(600):
        formula = _formulas(random, random.randrange(4))
        state = (random.randrange(2),)
        actions = {action: random.choice("xio") for action in range(3)}
        executed, idle, still_open = (frozenset(a for a, how in actions.items() if how == each) for each in "xio")
        given = settled_truth(formula, state, executed, idle)
        met.add(given)
        choices = [frozenset(n for n, taken in enumerate(each) if taken) for each in product((0, 1), repeat=3)]
        truths = {literal.true(formula, state, executed | (each & still_open)) for each in choices}
        assert given is None or truths == {given}
        if not still_open:
            assert given is not None
    assert met == {True, False, None}
    a, b = Executing(0), Executing(1)
    one, none = frozenset((0,)), NOTHING
    assert settled_truth(Or((a, b)), (0,), one, none) is True
    assert settled_truth(Or((b, a)), (0,), none, one) is None
    assert settled_truth(And((b, a)), (0,), none, one) is False
    assert settled_truth(And((b, a)), (0,), one, none) is None
    assert settled_truth(Iff(a, b), (0,), one, none) is None
    assert settled_truth(Iff(a, Not(b)), (0,), one, frozenset((1,))) is True
    assert settled_truth(Not(b), (0,), one, none) is None
