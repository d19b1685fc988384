"""Section 3 of the semantics: what may be executed together."""

from __future__ import annotations

import pytest

from tests.semantics.build import Build, chosen
from tumato_symbolic.semantics import (
    NOTHING,
    allowed,
    allowed_sets,
    is_safe,
    is_valid,
    objections,
    outcomes,
    successor,
)
from tumato_symbolic.spec import And, Iff, Not, Or, Ordering, Spec

BOTH: tuple[Ordering, ...] = ("any", "first")


def kinds(spec: Spec, state: tuple[int, ...], actions: frozenset[int], ordering: Ordering) -> list[str]:
    """The kinds of all objections."""
    return [objection.kind for objection in objections(spec, state, actions, ordering)]


@pytest.mark.parametrize("ordering", BOTH)
def test_every_precondition_of_every_action_holds(ordering: Ordering) -> None:
    """Condition 1: one precondition that fails forbids the whole set, and is the one to blame."""
    build = Build({"x": "ab", "y": "ab"})
    free = build.action("y=b")
    guarded = build.action("x=b", when=[build.atom("x=a"), build.atom("y=a")])
    spec = build.spec()
    assert allowed(spec, build.state("aa"), chosen(free, guarded), ordering)
    assert not allowed(spec, build.state("ab"), chosen(free, guarded), ordering)
    assert allowed(spec, build.state("ab"), chosen(free), ordering)
    (objection,) = objections(spec, build.state("ab"), chosen(free, guarded), ordering)
    assert (objection.kind, objection.actions) == ("precondition", (1,))
    assert objection.rule == spec.actions[1].preconditions[1]


@pytest.mark.parametrize("ordering", BOTH)
def test_no_two_actions_share_a_resource(ordering: Ordering) -> None:
    """Condition 2: actions with a common resource exclude each other; different resources, or none, do not."""
    build = Build({"x": "ab", "y": "ab", "z": "ab"}, resources=["motor", "arm"])
    drive = build.action("x=b", needs=["motor"])
    both = build.action("y=b", needs=["motor", "arm"])
    lift = build.action("z=b", needs=["arm"])
    talk = build.action()
    spec, state = build.spec(), build.state("aaa")
    assert kinds(spec, state, chosen(drive, both), ordering) == ["resource"]
    assert kinds(spec, state, chosen(both, lift), ordering) == ["resource"]
    assert allowed(spec, state, chosen(drive, lift, talk), ordering)
    assert sum(1 for _ in allowed_sets(spec, state, ordering)) == 2 * (1 + 3 + 1)


@pytest.mark.parametrize("ordering", BOTH)
def test_nominal_effects_agree(ordering: Ordering) -> None:
    """Condition 3: two values for one variable are a conflict, one value twice is none; alternatives do not count."""
    build = Build({"x": "abc", "y": "ab"})
    to_b = build.action("x=b", alternatives=["x=a"])
    to_b_too = build.action("x=b y=b", alternatives=["x=c"])
    to_c = build.action("x=c")
    spec, state = build.spec(), build.state("aa")
    assert allowed(spec, state, chosen(to_b, to_b_too), ordering)
    assert successor(spec, state, chosen(to_b, to_b_too)) == build.state("bb")
    assert kinds(spec, state, chosen(to_b, to_c), ordering) == ["nominal-conflict"]
    assert kinds(spec, state, chosen(to_b, to_b_too, to_c), ordering) == ["nominal-conflict"] * 2


@pytest.mark.parametrize("ordering", BOTH)
def test_every_reaction_rule_holds(ordering: Ordering) -> None:
    """Condition 4: `executing a` is membership in the set, so rules can force and forbid actions."""
    build = Build({"x": "ab"})
    go, stop = build.action("x=b"), build.action("x=a")
    force = Or((Not(build.atom("x=b")), stop))
    forbid = Not(And((build.atom("x=a"), stop)))
    spec = build.spec(reaction_rules=[force, forbid])
    assert list(allowed_sets(spec, build.state("a"), ordering)) == [NOTHING, chosen(go)]
    assert list(allowed_sets(spec, build.state("b"), ordering)) == [chosen(stop)]
    (objection,) = objections(spec, build.state("b"), NOTHING, ordering)
    assert (objection.kind, objection.rule) == ("reaction-rule", spec.reaction_rules[0])


@pytest.mark.parametrize("ordering", BOTH)
def test_every_outcome_keeps_the_state_rules_and_the_assumptions(ordering: Ordering) -> None:
    """Condition 5: one alternative that breaks a state rule, or leaves the valid states, forbids the action."""
    build = Build({"x": "abcd"})
    fine = build.action("x=b")
    unsafe = build.action("x=b", alternatives=["x=a", "x=c"])
    invalid = build.action("x=b", alternatives=["x=d"])
    spec = build.spec(state_rules=[Not(build.atom("x=c"))], assumptions=[Not(build.atom("x=d"))])
    state = build.state("a")
    assert list(allowed_sets(spec, state, ordering)) == [NOTHING, chosen(fine)]
    (objection,) = objections(spec, state, chosen(unsafe), ordering)
    assert (objection.kind, objection.state, objection.rule) == ("unsafe", build.state("c"), spec.state_rules[0])
    (objection,) = objections(spec, state, chosen(invalid), ordering)
    assert (objection.state, objection.rule) == (build.state("d"), spec.assumptions[0])


@pytest.mark.parametrize("ordering", BOTH)
def test_doing_nothing_is_allowed_only_in_a_safe_state(ordering: Ordering) -> None:
    """`Out(s, ∅) = {s}`."""
    build = Build({"x": "ab"})
    repair = build.action("x=a")
    spec = build.spec(state_rules=[build.atom("x=a")])
    assert not is_safe(spec, build.state("b"))
    assert is_valid(spec, build.state("b"))
    assert outcomes(spec, build.state("b"), NOTHING, ordering) == {build.state("b"): ()}
    assert list(allowed_sets(spec, build.state("b"), ordering)) == [chosen(repair)]
    assert kinds(spec, build.state("b"), NOTHING, ordering) == ["unsafe", "nominal-unsafe"]
    assert allowed(spec, build.state("a"), NOTHING, ordering)


def test_under_first_the_nominal_successor_must_still_be_safe() -> None:
    """Condition 6: each effect alone is safe, both together are not; under `any` condition 5 says so already."""
    build = Build({"x": "ab", "y": "ab"})
    left, right = build.action("x=b"), build.action("y=b")
    spec = build.spec(state_rules=[Not(And((build.atom("x=b"), build.atom("y=b"))))])
    state, both = build.state("aa"), chosen(left, right)
    assert kinds(spec, state, both, "first") == ["nominal-unsafe"]
    assert "unsafe" in kinds(spec, state, both, "any")


def test_the_orderings_differ_where_effects_arrive_in_turn() -> None:
    """An alternative after another action's effect is an outcome under `any` only."""
    build = Build({"x": "ab", "y": "ab", "z": "ab"})
    left = build.action("x=b", alternatives=["z=b"])
    right = build.action("y=b")
    spec = build.spec(state_rules=[Not(And((build.atom("y=b"), build.atom("z=b"))))])
    state, both = build.state("aaa"), chosen(left, right)
    assert set(outcomes(spec, state, both, "first")) == {build.state(text) for text in ("baa", "aab", "aba")}
    assert set(outcomes(spec, state, both, "any")) == {
        build.state(text) for text in ("baa", "aab", "aba", "bba", "abb")
    }
    assert allowed(spec, state, both, "first")
    assert not allowed(spec, state, both, "any")


def test_an_action_strikes_at_most_once() -> None:
    """Under `any` two effects of the same action never follow each other, though every order of actions counts."""
    build = Build({"x": "abc", "y": "ab"})
    throw = build.action("x=b", alternatives=["y=b"])
    spec, state = build.spec(), build.state("aa")
    assert set(outcomes(spec, state, chosen(throw), "any")) == {build.state("ba"), build.state("ab")}
    rule = Not(And((build.atom("x=b"), build.atom("y=b"))))
    assert allowed(build.spec(state_rules=[rule]), state, chosen(throw), "any")
    build.action("x=c")
    after = outcomes(build.spec(), state, frozenset((0, 1)), "any")
    assert set(after) == {build.state(text) for text in ("ba", "ab", "ca", "cb")}
    assert [effect.action for effect in after[build.state("cb")]] in ([0, 1], [1, 0])


@pytest.mark.parametrize("ordering", BOTH)
def test_two_faults_cannot_be_restored_in_one_step(ordering: Ordering) -> None:
    """After the first effect alone the other rule is still broken; one action that repairs both is allowed."""
    build = Build({"x": "ab", "y": "ab"})
    first, second = build.action("x=a"), build.action("y=a")
    both = build.action("x=a y=a")
    spec = build.spec(state_rules=[build.atom("x=a"), build.atom("y=a")])
    assert kinds(spec, build.state("bb"), chosen(first, second), ordering) == ["unsafe", "unsafe"]
    assert list(allowed_sets(spec, build.state("bb"), ordering)) == [chosen(both)]
    assert list(allowed_sets(spec, build.state("ba"), ordering)) == [chosen(first), chosen(both), chosen(first, both)]


@pytest.mark.parametrize("ordering", BOTH)
def test_an_action_without_effects_adds_no_outcome(ordering: Ordering) -> None:
    """`Out(s, A)` is that of the others, and `{s}` where there are none: it may accompany what restores safety."""
    build = Build({"x": "ab", "y": "ab"})
    repair, beep, blink = build.action("x=a"), build.action(), build.action("", alternatives=[""])
    spec = build.spec(state_rules=[build.atom("x=a")])
    state, silent = build.state("bb"), chosen(beep, blink)
    assert outcomes(spec, state, silent, ordering) == {state: ()}
    assert set(outcomes(spec, state, silent | chosen(repair), ordering)) == {build.state("ab")}
    assert kinds(spec, state, silent, ordering) == ["unsafe", "nominal-unsafe"]
    assert list(allowed_sets(spec, state, ordering)) == [
        chosen(repair),
        chosen(repair, beep),
        chosen(repair, blink),
        chosen(repair, beep, blink),
    ]


@pytest.mark.parametrize("ordering", BOTH)
def test_an_alternative_that_writes_makes_no_change_an_effect(ordering: Ordering) -> None:
    """Nominal effects `none` beside such an alternative take effect: the state itself is an outcome."""
    build = Build({"x": "ab", "y": "ab"})
    repair, fumble = build.action("x=a"), build.action("", alternatives=["y=b"])
    spec = build.spec(state_rules=[build.atom("x=a")])
    state = build.state("ba")
    assert set(outcomes(spec, state, chosen(fumble), ordering)) == {state, build.state("bb")}
    assert list(allowed_sets(spec, state, ordering)) == [chosen(repair)]


@pytest.mark.parametrize("ordering", BOTH)
def test_sets_come_smallest_first_then_as_declared(ordering: Ordering) -> None:
    """The order in which `allowed_sets` yields is the one that decides ties."""
    build = Build({"x": "ab"})
    for _ in range(3):
        build.action()
    found = [tuple(sorted(chosen)) for chosen in allowed_sets(build.spec(), build.state("a"), ordering)]
    assert found == [(), (0,), (1,), (2,), (0, 1), (0, 2), (1, 2), (0, 1, 2)]


def test_equivalence_holds_when_both_sides_agree() -> None:
    """`p IFONLYIF q` in a reaction rule: the action runs exactly where the state says so."""
    build = Build({"x": "ab"})
    beep = build.action()
    spec = build.spec(reaction_rules=[Iff(beep, build.atom("x=b"))])
    assert list(allowed_sets(spec, build.state("a"), "any")) == [NOTHING]
    assert list(allowed_sets(spec, build.state("b"), "any")) == [chosen(beep)]
