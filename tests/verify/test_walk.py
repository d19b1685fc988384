"""The walk: its operations against plain evaluation, and its verdicts against the judge and Z3."""

import operator
from importlib import import_module
from itertools import product
from random import Random

import pytest

from tests.generate import random_spec
from tests.profiles import ALL_PROFILES
from tests.semantics.build import Build, chosen
from tests.verify.policies import certified, dressed, exact_ranks, near_policies, wrong_ranks
from tests.verify.test_against_semantics import assert_witness
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, Judgement, State, all_states, judge
from tumato_symbolic.spec import Not, Or, Ordering, Spec
from tumato_symbolic.verify import PropertyResult, Refutation, Verification, verify
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, BudgetError
from tumato_symbolic.verify.by_diagrams.prover import WalkProver
from tumato_symbolic.verify.by_diagrams.walk import UNASKED, Walk

Rows = dict[State, ActionSet]
SIZES = (2, 3, 1, 4)
POINTS = list(product(*map(range, SIZES)))


def _function(walk: Walk, random: Random, most: int) -> tuple[int, dict[State, int]]:
    """A function drawn at random, and its table."""
    table = {point: random.randint(0, most) for point in POINTS}

    def build(point: State) -> int:
        if len(point) == len(SIZES):
            return walk.constant(table[point])
        return walk.by_value(len(point), [build((*point, value)) for value in range(SIZES[len(point)])])

    return build(()), table


def _table(walk: Walk, function: int) -> dict[State, int]:
    constants = {point: [walk.constant(value) for value in point] for point in POINTS}
    values = {point: walk.compose(function, dict(enumerate(constants[point]))) for point in POINTS}
    assert all(len(walk.values_of(value)) == 1 for value in values.values())
    return {point: walk.values_of(value)[0] for point, value in values.items()}


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 1, 0, 2)])
def test_operations_do_what_they_say(order: tuple[int, ...]) -> None:
    """`select`, `combine`, `substitute`, `assign` and the predicates agree with evaluation at every point."""
    random = Random(0)
    for _ in range(20):
        walk = Walk(order, SIZES)
        number, numbers = _function(walk, random, 2)
        cases = [_function(walk, random, 3) for _ in range(3)]
        one, other = _function(walk, random, 1), _function(walk, random, 1)
        assert _table(walk, walk.select(number, [case for case, _ in cases])) == {
            point: cases[numbers[point]][1][point] for point in POINTS
        }
        for zero, other_case in (cases[:2], [cases[0], one], [other, cases[1]], [cases[2], cases[2]]):
            assert _table(walk, walk.select(one[0], (zero[0], other_case[0]))) == {
                point: (zero, other_case)[one[1][point]][1][point] for point in POINTS
            }
        assert _table(walk, walk.by_value(1, [case for case, _ in cases])) == {
            point: cases[point[1]][1][point] for point in POINTS
        }
        assert walk.constant(-1) == walk.constant(-1) != walk.constant(2)
        added = walk.apply(operator.add, number, cases[0][0])
        assert _table(walk, added) == {point: numbers[point] + cases[0][1][point] for point in POINTS}
        assert walk.values_of(added) == sorted({numbers[point] + cases[0][1][point] for point in POINTS})
        less = walk.apply(operator.sub, number, cases[0][0])
        assert _table(walk, less) == {point: numbers[point] - cases[0][1][point] for point in POINTS}
        moved = walk.compose(cases[0][0], {0: one[0], 1: number, 3: walk.constant(2)})
        assert _table(walk, moved) == {
            point: cases[0][1][one[1][point], numbers[point], point[2], 2] for point in POINTS
        }
        written = walk.cofactor_where(one[0], {1: 2, 3: 0}, cases[0][0], number)
        assert _table(walk, written) == {
            point: cases[0][1][point[0], 2, point[2], 0] if one[1][point] else numbers[point] for point in POINTS
        }
        small = _table(walk, walk.within(one[0], cases[0][0]))
        assert all(small[point] == cases[0][1][point] for point in POINTS if one[1][point])
        both, either = walk.all_of((one[0], other[0])), walk.any_of((one[0], other[0]))
        assert _table(walk, both) == {point: one[1][point] & other[1][point] for point in POINTS}
        assert _table(walk, either) == {point: one[1][point] | other[1][point] for point in POINTS}
        assert walk.without(one[0], other[0]) == walk.all_of((one[0], walk.negation(other[0])))
        assert walk.count(both) == sum(one[1][point] & other[1][point] for point in POINTS)


@pytest.mark.parametrize("order", [(0, 1, 2, 3), (3, 1, 0, 2)])
def test_a_comparison_after_writing_is_one_at_every_point(order: tuple[int, ...]) -> None:
    """Whatever was written in comparisons before: what is remembered of one is no answer to another."""
    random, answers = Random(0), list[bool]()
    for _ in range(40):
        walk = Walk(order, SIZES)
        function, table = _function(walk, random, 1)
        other, others = _function(walk, random, 1)
        where, holds = _function(walk, random, 1)
        asked, is_asked = _function(walk, random, 1)
        bound = walk.select(asked, (walk.constant(UNASKED), other))
        for _ in range(12):
            written = {variable: random.randrange(size) for variable, size in enumerate(SIZES) if random.random() < 0.5}
            after = {point: tuple(written.get(place, value) for place, value in enumerate(point)) for point in POINTS}
            compared = [point for point in POINTS if holds[point] and is_asked[point]]
            expected = all(table[after[point]] <= others[point] for point in compared)
            assert walk.holds_where(where, written, operator.le, function, bound) == expected
            answers.append(expected)
    assert 0.1 < sum(answers) / len(answers) < 0.9
    assert walk.holds_where(FALSE, {}, operator.lt, TRUE, FALSE)
    assert walk.holds_where(TRUE, {}, operator.lt, TRUE, walk.constant(UNASKED))


def test_what_a_function_is_elsewhere_may_make_it_small() -> None:
    """Within the states where it is the same in all of them it is a constant; in no states it may be anything."""
    walk = Walk((0, 1, 2, 3), SIZES)
    random = Random(0)
    for _ in range(20):
        function, table = _function(walk, random, 3)
        for value in map(walk.constant, walk.values_of(function)):
            assert walk.within(walk.apply(operator.eq, function, value), function) == value
        assert walk.within(TRUE, function) == function
        assert set(_table(walk, walk.within(FALSE, function)).values()) <= set(table.values())
        care, holds = _function(walk, random, 1)
        deep = walk.compose(function, {0: FALSE, 1: TRUE})
        found = _table(walk, walk.within(care, deep))
        assert all(found[point] == table[0, 1, *point[2:]] for point in POINTS if holds[point])


def test_equal_functions_are_one() -> None:
    """However it was made, a function has one number; an impossible one is `FALSE`."""
    walk = Walk((1, 0), (3, 2))
    x, y = walk.by_value(0, (TRUE, FALSE, FALSE)), walk.variable(1)
    assert walk.by_value(0, [walk.variable(0)] * 3) == walk.variable(0)
    assert walk.negation(walk.any_of((x, y))) == walk.all_of((walk.negation(y), walk.negation(x)))
    assert walk.all_of((x, walk.without(y, x))) == FALSE
    assert walk.any_of((x, y, walk.negation(x))) == TRUE


def test_the_budget_ends_the_walk() -> None:
    """A walk that remembers more than it may is given up, and stays so."""
    walk = Walk(range(12), [2] * 12, most_steps=20)
    for _ in range(2):
        with pytest.raises(BudgetError, match="too large"):
            walk.all_of(walk.apply(operator.eq, walk.variable(n), walk.variable(11 - n)) for n in range(6))


def _walked(spec: Spec, rows: Rows, ordering: Ordering, random: Random) -> Verification:
    answer = verify(dressed(spec, rows, random), spec, ordering=ordering, prover="walk")
    assert {result.proved_by for result in answer.properties if result.verdict == "proved"} <= {"walk"}
    return answer


def _verdicts(answer: Verification) -> dict[str, str]:
    return {result.name: result.verdict for result in answer.properties}


def _assert_first_witness(
    spec: Spec, rows: Rows, judged: Judgement, ordering: Ordering, refutation: Refutation
) -> None:
    """A witness, and the first of the states that are not allowed or miss their goal."""
    assert_witness(spec, rows, judged, ordering, refutation)
    state = refutation.state
    match refutation.kind:
        case "not-allowed":
            first = judged.not_allowed[0]
            assert state == first[0]
            assert refutation.objection is not None
            assert refutation.objection.kind == first[1].kind
        case "goal-missed":
            assert (state, refutation.run) == judged.goal_missed[0]


@pytest.mark.parametrize("profile", ALL_PROFILES)
@pytest.mark.parametrize("ordering", ["any", "first"])
def test_the_walk_judges_as_the_explicit_meaning_does(
    profile: str, ordering: Ordering, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every verdict is the judge's; the witness is the first state that fails, and the best set.

    So it is where the nominal step is taken variable by variable, and where it is taken case by case.
    """
    met, cases = set(), import_module("tumato_symbolic.verify.by_diagrams.cases")
    for seed in range(300, 306):
        spec, random = random_spec(seed, ALL_PROFILES[profile]), Random(seed)
        for rows in near_policies(spec, ordering, random):
            judged = judge(spec, rows, ordering)
            wrong = (judged.missing, judged.not_allowed, judged.goal_missed, judged.not_minimal)
            for most_cases in (0, 128):
                monkeypatch.setattr(cases, "MOST_CASES", most_cases)
                answer = _walked(spec, rows, ordering, random)
                assert list(_verdicts(answer).values()) == ["refuted" if each else "proved" for each in wrong]
            for result in answer.properties:
                met.add((result.name, result.verdict))
                if result.refutation is not None:
                    _assert_first_witness(spec, rows, judged, ordering, result.refutation)
    assert len(met) >= 7


def test_both_provers_agree_also_on_certificates() -> None:
    """`both` raises where Z3 and the walk differ: right and false ranks, right and wrong policies, both orderings."""
    met = set()
    for seed in range(11, 16):
        spec, random = random_spec(seed, ALL_PROFILES[("restoring", "interacting")[seed % 2]]), Random(seed)
        ordering: Ordering = ("any", "first")[seed // 2 % 2]
        for rows in near_policies(spec, ordering, random, count=1):
            ranks = exact_ranks(spec, rows, ordering)
            policies = [certified(spec, rows, ranks)]
            policies += [certified(spec, rows, wrong_ranks(ranks, random))] if ranks else []
            for policy in policies:
                both = verify(policy, spec, ordering=ordering, prover="both")
                walked = verify(policy, spec, ordering=ordering, prover="walk")
                assert _verdicts(both) == _verdicts(walked)
                if both.verdict == "proved":
                    assert {result.proved_by for result in both.properties} == {"z3+walk"}
                    met.add(walked.certificate.status)
    assert met >= {"used", "incomplete"}


# Witnesses


def _minimal(spec: Spec, rows: Rows) -> PropertyResult:
    """The walk's verdict on *minimal*; where `rows` says nothing, nothing is done."""
    everywhere = {state: rows.get(state, frozenset()) for state in all_states(spec)}
    return verify(policy_from_rows(spec, everywhere), spec, properties=["minimal"], prover="walk").properties[0]


def test_a_cheaper_set_is_found_among_many() -> None:
    """The best set is the cheapest, then the smallest, then the first."""
    build = Build({"x": "ab"})
    dear, *cheap = (build.action("x=a", duration=amount) for amount in (5, 2, 2, 0))
    spec = build.spec(state_rules=[Not(build.atom("x=b"))])
    refutation = _minimal(spec, {(1,): chosen(dear)}).refutation
    assert refutation is not None
    assert (refutation.state, refutation.cheaper) == ((1,), chosen(cheap[2]))
    assert _minimal(spec, {(1,): chosen(cheap[2])}).verdict == "proved"


def test_a_long_way_into_an_unsafe_state_is_not_listed() -> None:
    """Sixteen actions at once have 2^16 outcomes; the unsafe one is walked to, and is as short as it can be."""
    build = Build({**{f"x{number}": "ab" for number in range(16)}})
    actions = [build.action(f"x{number}=b") for number in range(16)]
    both = [Not(build.atom("x3=b")), Not(build.atom("x11=b"))]
    spec = build.spec(state_rules=[Or(tuple(both))])
    start = (0,) * 16
    policy = policy_from_rows(spec, {start: chosen(*actions)})
    prover = WalkProver(spec, policy, "any")
    refutation = prover.prove("safe").refutation
    assert refutation is not None
    assert refutation.objection is not None
    assert {step.action for step in refutation.objection.outcome} == {3, 11}
