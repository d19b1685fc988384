"""What Z3 is told, piece by piece: terms, states, counts, sets to be chosen, scopes; each against plain Python."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import Any

import pytest
import z3
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics import literal
from tests.semantics.build import Build
from tests.verify.test_forged_steps import SPECS
from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import as_diagram, policy_from_rows
from tumato_symbolic.semantics import (
    ActionSet,
    Residual,
    active_goals,
    duration,
    is_safe,
    is_valid,
    objections,
    reached,
    residual_goal,
    successor,
)
from tumato_symbolic.spec import And, Not, Ordering, Spec
from tumato_symbolic.verify.by_z3 import outcomes
from tumato_symbolic.verify.by_z3.choice import Choice
from tumato_symbolic.verify.by_z3.encoding import Place, formula_term, safe_term, successor_place, valid_term
from tumato_symbolic.verify.by_z3.goal_terms import GoalTerms, reached_term
from tumato_symbolic.verify.by_z3.outcomes import UnsafeOutcome, objections_to
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.solver import Solver, UndecidedError
from tumato_symbolic.verify.by_z3.step_counts import StepCounts
from tumato_symbolic.verify.by_z3.terms import (
    Term,
    at_most_one,
    code_at_most,
    conjunction,
    disjunction,
    either,
    implies,
    negation,
    same,
)
from tumato_symbolic.verify.unrealizability.allowed_step import is_state

GENERATED = [random_spec(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in (3000, 3001)]


def _values(term: Term, unknowns: Sequence[Any]) -> Iterator[tuple[tuple[bool, ...], bool]]:
    """What the unknowns may be, and what the term is then."""
    context = unknowns[0].ctx
    for values in product((False, True), repeat=len(unknowns)):
        if isinstance(term, bool):
            yield values, term
            continue
        pairs = [(unknown, z3.BoolVal(value, context)) for unknown, value in zip(unknowns, values, strict=True)]
        yield values, z3.is_true(z3.simplify(z3.substitute(term, *pairs)))


OPERATIONS: dict[str, tuple[int, Callable[..., Term], Callable[..., bool]]] = {
    "negation": (1, negation, lambda one: not one),
    "conjunction": (3, lambda *each: conjunction(each), lambda *each: all(each)),
    "disjunction": (3, lambda *each: disjunction(each), lambda *each: any(each)),
    "implies": (2, implies, lambda one, other: other or not one),
    "same": (2, same, lambda one, other: one == other),
    "either": (3, either, lambda one, two, three: two if one else three),
    "at most one": (3, lambda *each: at_most_one(each), lambda *each: sum(each) <= 1),
    **{
        f"at most {most}": (
            3,
            lambda *bits, most=most: code_at_most(bits, most),
            lambda *bits, most=most: _code(bits) <= most,
        )
        for most in range(8)
    },
}


def _code(bits: Sequence[bool]) -> int:
    return sum(1 << place for place, bit in enumerate(bits) if bit)


@pytest.mark.parametrize("name", OPERATIONS)
def test_terms_are_what_they_say(name: str) -> None:
    """Whichever operands are constants, and whichever are one and the same."""
    count, make, meaning = OPERATIONS[name]
    context = z3.Context()
    unknowns = [z3.Bool(f"u{number}", context) for number in range(count)]
    for operands in product(*(((False, True, unknown, unknowns[0])) for unknown in unknowns)):
        for values, found in _values(make(*operands), unknowns):
            given = dict(zip(map(str, unknowns), values, strict=True))
            meant = [each if isinstance(each, bool) else given[str(each)] for each in operands]
            assert found == meaning(*meant), (operands, values)


def test_terms_of_nothing_and_of_constants_are_constants() -> None:
    """What is settled without Z3 is not asked of it."""
    assert conjunction(()) is True and disjunction(()) is False and at_most_one(()) is True
    unknown = z3.Bool("u", z3.Context())
    assert conjunction((unknown, False)) is False and disjunction((unknown, True)) is True
    assert conjunction((True, unknown)) is unknown and disjunction((False, unknown)) is unknown
    assert at_most_one((True, True, unknown)) is False and at_most_one((unknown, False)) is True


def test_cases_are_of_the_kind_of_their_parts() -> None:
    """Booleans or numbers, which Z3's operators tell apart."""
    context = z3.Context()
    unknown, other = z3.Bool("u", context), z3.Bool("v", context)
    one, two = (z3.BitVecVal(number, 3, context) for number in (1, 2))
    assert isinstance(either(unknown, other, unknown), z3.BoolRef)
    number = either(unknown, one, two)
    assert isinstance(number, z3.BitVecRef)
    assert z3.simplify(z3.substitute(number, (unknown, z3.BoolVal(False, context)))).as_long() == 2


@pytest.mark.parametrize(("reason", "raised"), [("timeout", False), ("interrupted from keyboard", True)])
def test_no_answer_is_unknown_unless_ctrl_c_was_pressed(
    reason: str, raised: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Z3 takes the signal for itself, and says so."""
    solver = Solver()
    monkeypatch.setattr(solver._solver, "check", lambda: z3.unknown)
    monkeypatch.setattr(solver._solver, "reason_unknown", lambda: reason)
    if raised:
        with pytest.raises(KeyboardInterrupt):
            solver.ask()
    else:
        assert solver.ask() == "unknown"


@pytest.mark.parametrize("largest", [0, 1, 2, 3, 5, 6, 7, 14])
def test_counts_and_never(largest: int) -> None:
    """Numbers up to the largest and never are told apart; `one > other + 1`, with never as infinity."""
    counts = StepCounts(largest, z3.Context())
    solver = Solver(counts.context)
    every = [None, *range(largest + 1)]
    for one, other in product(every, every):
        equal = solver.ask(counts.code(one) == counts.code(other))
        assert (equal == "sat") == (one == other)
        far, near = (float("inf") if each is None else each for each in (one, other))
        answer = solver.ask(counts.exceeds_by_two(counts.code(one), counts.code(other)))
        assert (answer == "sat") == (far > near + 1), (one, other)
    for one in every:
        assert (solver.ask(counts.is_number(counts.code(one))) == "sat") == (one is not None)


@pytest.mark.parametrize("spec", [*SPECS, *GENERATED[:3]])
def test_states_and_formulas(spec: Spec) -> None:
    """A code is in range where it is a state; rules, goals and the literals of a state mean what they say there."""
    solver = Solver()
    place = Place.fresh(spec, "s", solver.context)
    states = list(literal.states(spec))
    with solver.scope(place.in_range(spec)):
        count = 0
        with solver.scope():
            while solver.ask() == "sat":
                state = place.read(solver.model)
                assert state in states
                count += 1
                solver.add(negation(is_state(place, state)))
        assert count == len(states)
        for state in states[:20]:
            with solver.scope(is_state(place, state)):
                for term, meant in ((valid_term, is_valid), (safe_term, is_safe)):
                    assert (solver.ask(term(spec, place)) == "sat") == meant(spec, state)
                    assert (solver.ask(negation(term(spec, place))) == "sat") != meant(spec, state)
                goals = GoalTerms.of(spec, place)
                active = {body for body, term in goals.active.items() if solver.ask(term) == "sat"}
                assert active == active_goals(spec, state)


def test_residual_goals_as_terms() -> None:
    """The residual goal of a state and a set is that one and no other; it holds where it holds."""
    for spec in GENERATED:
        solver = Solver()
        everything = [
            (state, chosen) for state in list(literal.states(spec))[:6] for chosen in list(literal.sets(spec))[:8]
        ]
        goals = {residual_goal(spec, state, chosen) for state, chosen in everything}
        goals |= {Residual(goal.bodies, frozenset()) for goal in goals}
        for state, chosen in everything:
            place = Place.fresh(spec, "s", solver.context).after(tuple(enumerate(state)))
            executed = [number in chosen for number in range(len(spec.actions))]
            terms = GoalTerms.of(spec, place)
            pending = residual_goal(spec, state, chosen)
            for goal in goals:
                assert (solver.ask(terms.is_residual(goal, executed)) == "sat") == (goal == pending)
                assert (solver.ask(reached_term(spec, goal, place)) == "sat") == reached(spec, goal, state)


def test_the_next_state() -> None:
    """`δ(s, A)` bit by bit, for sets whose nominal effects agree; what is not written stays."""
    for spec in [*SPECS, *GENERATED[:4]]:
        place = Place.fresh(spec, "s", z3.Context())
        for state in list(literal.states(spec))[::5]:
            here = place.after(tuple(enumerate(state)))
            for chosen in list(literal.sets(spec))[:16]:
                if "nominal-conflict" not in set(literal.broken(spec, state, chosen, "first")):
                    after = successor_place(spec, here, [number in chosen for number in range(len(spec.actions))])
                    assert after.read(None) == successor(spec, state, chosen)


def _choice(spec: Spec) -> tuple[Solver, Place, Choice]:
    solver = Solver()
    here = Place.fresh(spec, "s", solver.context)
    return solver, here, Choice(spec, here, solver)


def _only(choice: Choice, chosen: ActionSet) -> list[Term]:
    return [term if number in chosen else negation(term) for number, term in enumerate(choice.executed)]


def test_a_set_to_be_chosen_meets_all_conditions_but_one() -> None:
    """Exactly the sets that are allowed under `first`, whose only outcomes are single effects.

    What these falsify of other actions' preconditions is not looked at.
    """
    for spec in [*SPECS, *(spec for spec in GENERATED if len(spec.actions) <= 5)]:
        solver, here, choice = _choice(spec)
        solver.add(*choice.conditions())
        for state in list(literal.states(spec))[:8]:
            for chosen in literal.sets(spec):
                if not literal.valid(spec, state):
                    continue
                answer = solver.ask(is_state(here, state), *_only(choice, chosen))
                wrong = set(literal.broken(spec, state, chosen, "first")) - {"falsified"}
                assert (answer == "sat") == (not wrong), (state, chosen, wrong)
                if answer == "sat":
                    assert choice.read(solver.model) == chosen
                    assert choice.after.read(solver.model) == literal.successor(spec, state, chosen)


@pytest.mark.parametrize("unit", [1, 3, 10**12])
def test_durations_of_a_set_to_be_chosen(unit: int) -> None:
    """At most so long, and shorter than another set, exactly, whatever all durations have in common."""
    build = Build({"x": "ab"})
    for length in (4, 0, 6, 2):
        build.action("x=a", duration=length * unit)
    spec = build.spec()
    solver, _, choice = _choice(spec)
    for chosen in literal.sets(spec):
        with solver.scope(*_only(choice, chosen)):
            takes = duration(spec, chosen)
            for limit in {-1, 0, takes - 1, takes, takes + 1, 12 * unit, 13 * unit, 20 * unit, 100 * unit}:
                assert (solver.ask(choice.lasts_at_most(limit)) == "sat") == (takes <= limit), (chosen, limit)
            for other in literal.sets(spec):
                executed = [number in other for number in range(4)]
                assert (solver.ask(choice.cheaper_than(executed)) == "sat") == (takes < duration(spec, other))


def test_what_a_bad_outcome_teaches() -> None:
    """The lemma rules out exactly the sets with all these actions in states from where they lead to no good."""
    spec = SPECS[1]
    lessons = 0
    for state, chosen in product(list(literal.states(spec))[:4], literal.sets(spec)):
        for objection in objections(spec, state, chosen, "any"):
            if objection.kind != "unsafe" or len(objection.outcome) < 2:
                continue
            lessons += 1
            solver, here, choice = _choice(spec)
            solver.add(choice.lemma(objection))
            acting = {step.action for step in objection.outcome}
            for other, rival in product(literal.states(spec), literal.sets(spec)):
                end = other
                for step in objection.outcome:
                    end = literal.changed(end, step.effect)
                wrong = acting <= rival and not is_safe(spec, end)
                assert (solver.ask(is_state(here, other), *_only(choice, rival)) == "sat") == (not wrong)
            if lessons == 3:
                return


def test_what_the_solver_should_have_known_is_a_bug() -> None:
    """Only an outcome of two effects or more may be news."""
    spec = SPECS[0]
    _, _, choice = _choice(spec)
    kinds = set()
    for state, chosen in product(literal.states(spec), literal.sets(spec)):
        for objection in objections(spec, state, chosen, "any"):
            if objection.kind != "unsafe" or len(objection.outcome) < 2:
                kinds.add(objection.kind)
                with pytest.raises(RuntimeError, match="violates what it knows"):
                    choice.lemma(objection)
    assert {"unsafe", "precondition", "nominal-unsafe"} <= kinds


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_unsafe_outcomes_that_are_none(ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """An outcome that Z3 gives is replayed: where other actions run, or its end is safe, that is a bug."""
    build = Build({"x": "abc", "y": "ab"})
    build.action("x=b")
    build.action("y=b", ["x=c"])
    spec = build.spec(state_rules=[Not(build.atom("x=c"))])
    solver = Solver()
    here = Place.fresh(spec, "s", solver.context).after(((0, 0), (1, 0)))
    unsafe = UnsafeOutcome(spec, here, [True, True], ordering, solver.context)
    assert solver.ask(*unsafe.constraints) == "sat"
    objection = unsafe.objection(solver.model, (0, 0), frozenset({0, 1}))
    assert [step.action for step in objection.outcome] == [1], "the effect that is not needed is left out"
    assert (objection.actions, objection.state, objection.rule) == ((0, 1), (2, 0), spec.state_rules[0])
    with pytest.raises(RuntimeError, match="against the solver"):
        unsafe.objection(solver.model, (0, 0), frozenset({0}))
    monkeypatch.setattr(outcomes, "fault_after", lambda *_: None)
    with pytest.raises(RuntimeError, match="against the solver"):
        unsafe.objection(solver.model, (0, 0), frozenset({0, 1}))


def test_not_too_many_objections_at_once() -> None:
    """As many as are learned from at a time, single effects first where the outcomes are many."""
    build = Build({f"x{number}": "ab" for number in range(8)})
    actions = [build.action(f"x{number}=b", when=[build.atom("x0=b")]) for number in range(8)]
    spec = build.spec()
    everything = frozenset(range(len(actions)))
    found = objections_to(spec, (0,) * 8, everything, "any")
    assert [(each.kind, each.actions) for each in found] == [("precondition", (number,)) for number in range(8)]
    assert objections_to(spec, (1,) * 8, everything, "any") == []
    twice = replace(spec, actions=tuple(replace(each, preconditions=each.preconditions * 3) for each in spec.actions))
    orderings: tuple[Ordering, ...] = ("any", "first")
    for ordering in orderings:
        assert len(objections_to(twice, (0,) * 8, everything, ordering)) == outcomes.OBJECTIONS_AT_ONCE


def test_an_outcome_that_is_not_found_in_time_is_open() -> None:
    """Many actions have outcomes that are sought, not listed: no answer is no proof that all are safe."""
    build = Build({f"x{number}": "ab" for number in range(8)})
    for number in range(8):
        build.action(f"x{number}=b")
    everything = frozenset(range(8))
    fine = build.spec()
    wrong = build.spec(state_rules=[Not(And((build.atom("x0=b"), build.atom("x7=b"))))])
    assert objections_to(fine, (0,) * 8, everything, "any") == []
    assert len(objections_to(wrong, (0,) * 8, everything, "any")) == 1
    with pytest.raises(UndecidedError, match="every outcome of a set is safe"):
        objections_to(wrong, (0,) * 8, everything, "any", deadline=0.0)


def test_what_is_assumed_for_a_while() -> None:
    """Terms of a scope end with it, definitions stay, however deep they are made; a time that is over is no answer."""
    solver = Solver()
    one, two, three = (z3.Bool(name, solver.context) for name in ("one", "two", "three"))
    with solver.scope(one):
        assert solver.ask(negation(one)) == "unsat"
        with solver.scope(two):
            solver.define(same(three, one))
            assert solver.ask(negation(three)) == "unsat"
        assert solver.ask(negation(two)) == "sat"
        assert solver.ask(negation(three)) == "unsat"
    assert solver.ask(negation(one)) == "sat"
    assert solver.ask(one, negation(three)) == "unsat"
    assert solver.ask(three, deadline=0.0) == "unknown"
    assert solver.ask(False, deadline=0.0) == "unsat"
    assert solver.ask(one) == "sat" and z3.is_true(solver.model[one])
    assert solver.ask(one, negation(one)) == "unsat"
    solver.add(False)
    assert solver.ask() == "unsat"
    fresh = Solver(solver.context)
    with fresh.scope():
        fresh.define(one)
    assert fresh.ask(negation(one)) == "unsat"


def test_the_bits_of_a_state() -> None:
    """The literals of a state hold there and nowhere else, the most significant bits of the first variable first."""
    build = Build({"x": "abcdefg", "y": "ab", "z": "abc"})
    spec = build.spec()
    problem = PolicyProblem(spec, as_diagram(policy_from_rows(spec, {})), Budget())
    for state in literal.states(spec):
        with problem.solver.scope(*problem.literals(state)):
            assert problem.solver.ask(is_state(problem.state, state)) == "sat"
            assert problem.solver.ask(negation(is_state(problem.state, state))) == "unsat"
    model = problem.first_model("nothing", formula_term(build.atom("y=b"), problem.state))
    assert problem.state.read(model) == (0, 1, 0)
    assert problem.first_model("nothing", problem.defined) is None
