"""Steps that are just wrong: one outcome, one order, one condition, by every prover, against the text of section 3."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Literal

import pytest
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics import literal
from tests.semantics.build import Build, rules
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import State
from tumato_symbolic.spec import And, Formula, Iff, Is, Not, Or, Ordering, Spec
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop

Name = Literal["z3", "walk", "explicit"]
PROVERS: tuple[Name, ...] = ("z3", "walk", "explicit")
ORDERINGS: tuple[Ordering, ...] = ("any", "first")


def writers() -> Build:
    """Four actions that write one variable, nominally alike, each with an alternative of its own, and another one."""
    build = Build({"x": "abcd", "y": "ab"}, ["arm"])
    build.action("x=b", ["x=c"])
    build.action("x=b", ["x=d", "y=b"])
    build.action("y=b", ["x=a", "x=c y=a"], needs=["arm"])
    build.action("x=b y=b", ["y=a"], needs=["arm"])
    return build


def forbidding(spec: Spec, state: literal.State) -> Spec:
    """The specification with one state that is not safe."""
    here = And(tuple(Is(variable, value) for variable, value in enumerate(state)))
    return replace(spec, state_rules=rules(Not(here)))


def compatible(spec: Spec) -> Iterator[literal.Actions]:
    """The sets of two and three actions that may run together as far as resources and nominal effects go."""
    for chosen in literal.sets(spec):
        kinds = set(literal.broken(spec, literal.states(spec)[0], chosen, "any"))
        if 1 < len(chosen) < 4 and not kinds & {"resource", "nominal-conflict"}:
            yield chosen


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize("ordering", ORDERINGS)
def test_every_outcome_is_found_and_no_other(ordering: Ordering, prover: Name) -> None:
    """A decision is refuted exactly where the one forbidden state is an outcome, and the way is a real one."""
    plain = writers().spec()
    start = (0, 0)
    met = set()
    for chosen in compatible(plain):
        ends = literal.outcomes(plain, start, chosen, ordering)
        for state in literal.states(plain):
            if state == start:
                continue
            spec = forbidding(plain, state)
            wrong = state in ends or state == literal.successor(plain, start, chosen)
            policy = policy_from_rows(spec, {start: chosen})
            (result,) = verify(policy, spec, ordering=ordering, prover=prover, properties=["safe"]).properties
            assert result.verdict == ("refuted" if wrong else "proved"), (chosen, state)
            met.add(wrong)
            if state in ends:
                assert result.refutation is not None and result.refutation.objection is not None
                way = result.refutation.objection.outcome
                here: State = start
                for step in way:
                    here = literal.changed(here, step.effect)
                    assert step.after == here
                assert here == state
                assert len({step.action for step in way}) == len(way)
    assert met == {True, False}


def ruled() -> Spec:
    """Preconditions, resources, disagreement, reaction rules with IFONLYIF and AND, assumptions, unsafe outcomes."""
    build = Build({"x": "abc", "y": "ab"}, ["arm", "leg"])
    one = build.action("x=b", ["x=c"], when=[Or((build.atom("x=a"), build.atom("y=b")))], needs=["arm"])
    two = build.action("y=b", ["x=a"], needs=["leg"], duration=2)
    three = build.action("x=b y=a", needs=["leg", "arm"], when=[Not(build.atom("x=b")), build.atom("y=b")])
    four = build.action("", ["y=a"], duration=1)
    rules: list[Formula] = [
        Iff(And((one, build.atom("y=b"))), And((one, four))),
        Not(And((two, build.atom("x=c"), Not(one)))),
        Or((Iff(three, build.atom("x=a")), Not(three), four)),
    ]
    safe: list[Formula] = [
        Not(And((build.atom("x=c"), build.atom("y=a")))),
        Or((build.atom("x=a"), Not(build.atom("y=b")), Is(0, 1))),
    ]
    return build.spec(state_rules=safe, reaction_rules=rules, assumptions=[Or((build.atom("x=a"), Is(0, 1), Is(1, 0)))])


SPECS = [ruled(), writers().spec(state_rules=[Not(And((Is(0, 3), Is(1, 1)))), Not(And((Is(0, 2), Is(1, 0))))])]


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_what_the_walk_takes_for_allowed(ordering: Ordering) -> None:
    """`Ok(s, A)` as a function of the walk, for every valid state and set without two actions of one group."""
    generated = [random_spec(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in range(3000, 3002)]
    for spec in [*SPECS, *(each for each in generated if len(each.actions) <= 5)]:
        model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, {})), ordering)
        for state in [state for state in literal.states(spec) if literal.valid(spec, state)][:12]:
            fine = literal.allowed(spec, state, ordering)
            for chosen in literal.sets(spec):
                if all(len(chosen & set(group)) <= 1 for group in model.groups):
                    assert model.holds(model.allowed, state, chosen) == (chosen in fine), (state, chosen)
                else:
                    assert chosen not in fine


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize("ordering", ORDERINGS)
def test_every_decision_is_judged_as_written(ordering: Ordering, prover: Name) -> None:
    """One decision in one state, all of them, with the kind of what is wrong; elsewhere nothing is decided."""
    for spec in SPECS:
        for state, chosen in product(literal.states(spec)[:6], literal.sets(spec)):
            if len(chosen) > 3:
                continue
            policy = policy_from_rows(spec, {state: chosen})
            (result,) = verify(policy, spec, ordering=ordering, prover=prover, properties=["safe"]).properties
            broken = set(literal.broken(spec, state, chosen, ordering)) if literal.valid(spec, state) else set()
            assert result.verdict == ("refuted" if broken else "proved"), (state, chosen, broken)
            if broken:
                assert result.refutation is not None and result.refutation.objection is not None
                assert (result.refutation.state, result.refutation.decision) == (state, chosen)
                assert result.refutation.objection.kind in broken


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize("ordering", ORDERINGS)
@pytest.mark.parametrize("is_allowed", [True, False])
def test_a_rival_of_two_actions_that_go_wrong_together(is_allowed: bool, ordering: Ordering, prover: Name) -> None:
    """Each of its effects alone is safe; where all of them together are not, it is no set that would have served."""
    build = Build({"x": "au", "y": "ab", "z": "ab"})
    one, other = build.action("x=a y=b", duration=1), build.action("x=a z=b", duration=1)
    build.action("x=a", duration=9)
    both = [] if is_allowed else [Not(And((build.atom("y=b"), build.atom("z=b"))))]
    spec = build.spec(state_rules=[Not(build.atom("x=u")), *both], reaction_rules=[Iff(one, other)])
    policy = policy_from_rows(spec, {build.state("uaa"): frozenset((2,))})
    answer = verify(policy, spec, ordering=ordering, prover=prover, properties=["safe", "minimal"])
    assert [result.verdict for result in answer.properties] == ["proved", "refuted" if is_allowed else "proved"]


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_outcomes_in_states_of_which_some_actions_say_nothing(ordering: Ordering) -> None:
    """Whether all outcomes are in a set of states, also where it is told by variables that only some actions write."""
    build = Build({"x": "abc", "y": "ab", "z": "ab"}, ["arm"])
    for nominal, alternatives, needs in (
        ("x=b", ["x=c"], []),
        ("x=b", ["x=a y=b"], ["arm"]),
        ("y=b", [], []),
        ("", ["z=b"], ["arm"]),
        ("z=b", ["y=a"], []),
    ):
        build.action(nominal, alternatives, needs=needs)
    spec = build.spec()
    model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, {})), ordering)
    wanted: list[Formula] = [Not(Is(0, 2)), Or((Is(0, 0), Is(0, 1))), Is(1, 1), Not(Is(2, 1)), Or((Is(0, 0), Is(2, 0)))]
    sets = [frozenset[int](), *(frozenset({each}) for each in range(len(spec.actions))), *compatible(spec)]
    met = set()
    for formula in [*wanted, And(()), Or(())]:
        within = model.outcomes_in(model.formula(formula))
        for state, chosen in product(literal.states(spec), sets):
            ends = literal.outcomes(spec, state, chosen, ordering)
            expected = all(literal.true(formula, end) for end in ends)
            assert model.holds(within, state, chosen) == expected, (formula, state, chosen)
            met.add(expected)
    assert met == {True, False}
