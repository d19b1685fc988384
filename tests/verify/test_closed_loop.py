"""The walk piece by piece: groups and orders, goals, durations, states, what is remembered, what children are given."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib import import_module
from itertools import combinations, product
from random import Random
from typing import Any

import pytest
from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics import literal
from tests.semantics.build import Build, chosen, constraint, priority, when
from tests.verify.test_forged_steps import ORDERINGS, SPECS
from tumato_symbolic import parse
from tumato_symbolic.limits import Budget
from tumato_symbolic.policy import as_diagram, as_table, bind, policy_from_rows
from tumato_symbolic.semantics import (
    ActionSet,
    Contest,
    Residual,
    State,
    active_goals,
    contested_resources,
    contested_values,
    duration,
    excluded,
    exclusive_groups,
    reached,
    residual_goal,
)
from tumato_symbolic.spec import And, Executing, Not, Ordering, Spec, many_goals
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, BudgetError, given_up
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals
from tumato_symbolic.verify.by_diagrams.order import walk_order
from tumato_symbolic.verify.by_diagrams.parallel import ParallelProofs, Task
from tumato_symbolic.verify.by_diagrams.walk import UNASKED, Walk
from tumato_symbolic.verify.by_diagrams.witnesses import Witnesses
from tumato_symbolic.verify.by_states.packed import Packing
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.by_states.steps import Steps
from tumato_symbolic.verify.by_z3.encoding import Place
from tumato_symbolic.verify.by_z3.goal_terms import GoalTerms
from tumato_symbolic.verify.by_z3.solver import Solver
from tumato_symbolic.verify.decisions import Decisions


def nested() -> Spec:
    """Goals in conditions in lists in conditions, of both kinds, some of which speak of actions."""
    build = Build({"x": "abc", "y": "abc"})
    one, two = build.action("x=b"), build.action("y=b")
    a, b, c = (build.atom(f"x={letter}") for letter in "abc")
    p, q, r = (build.atom(f"y={letter}") for letter in "abc")
    inner = priority(when(p, build.goal(b)), when(q, build.goal(And((c, one)))), build.goal(Not(two)))
    middle = constraint(when(r, build.goal(p)), when(Not(a), inner), when(a, when_list(build, q, c)))
    return build.spec(priority(when(Not(c), middle), when(q, build.goal(a)), inner))


BY_CASES = """
BEGIN STATE VECTOR
state x can be a, b, c
state y can be a, b
END STATE VECTOR
BEGIN ACTIONS
action ring
  nominal effects: y is b
action go
  nominal effects: none
    when x is a: x is b
    when x is b: x is c
END ACTIONS
BEGIN GOALS
goal type: priority
when y is b then goal: x is c AND executing go
goal: x is b OR executing ring
END GOALS
"""
"""Goals that speak of an action of several cases."""


def when_list(build: Build, condition: Any, body: Any) -> Any:
    """A list with a conditional goal and another."""
    return priority(when(condition, build.goal(body)), constraint(build.goal(condition), build.goal(Executing(0))))


GENERATED = [random_spec(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in (3000, 3001)]
ALL = [*SPECS, nested(), *GENERATED]


def _model(spec: Spec, ordering: Ordering = "any") -> ClosedLoop:
    return ClosedLoop(spec, as_diagram(policy_from_rows(spec, {})), ordering)


def _value(model: ClosedLoop, function: int, state: literal.State, executed: literal.Actions) -> int:
    """What a function is for a state and a set of which at most one is in each group."""
    places = [0] * len(model.groups)
    for group, actions in enumerate(model.groups):
        for place, action in enumerate(actions, 1):
            places[group] = place if action in executed else places[group]
    values = {number: model.walk.constant(value) for number, value in enumerate((*state, *places))}
    (found,) = model.walk.values_of(model.walk.compose(function, values))
    return found


def _choices(model: ClosedLoop) -> list[literal.Actions]:
    sets = literal.sets(model.spec)
    return [each for each in sets if all(len(each & set(group)) <= 1 for group in model.groups)]


def _apart(contests: Iterable[Contest]) -> set[tuple[int, int]]:
    """The pairs of actions on different sides."""
    sides = [side for contest in contests for side in combinations(contest, 2)]
    return {(min(one, other), max(one, other)) for first, second in sides for one in first for other in second}


def test_groups_and_their_order() -> None:
    """No two actions of a group may be together; each group is tested just above the first variable that it writes."""
    for spec in ALL:
        pairs = list(combinations(range(len(spec.actions)), 2))
        state = literal.states(spec)[0]
        broken = {pair: set(literal.broken(spec, state, frozenset(pair), "first")) for pair in pairs}
        assert _apart(contested_values(spec)) == {pair for pair in pairs if "nominal-conflict" in broken[pair]}
        assert _apart(contested_resources(spec)) == {pair for pair in pairs if "resource" in broken[pair]}
        exclusive = [pair for pair in pairs if broken[pair] & {"nominal-conflict", "resource"}]
        masks = excluded(spec)
        assert [(one, other) for one, other in pairs if masks[one] >> other & 1] == exclusive
        assert [(one, other) for one, other in pairs if masks[other] >> one & 1] == exclusive
        groups = exclusive_groups(spec)
        assert sorted(action for group in groups for action in group) == list(range(len(spec.actions)))
        for group in groups:
            assert set(combinations(sorted(group), 2)) <= set(exclusive)
        for one, other in combinations(groups, 2):
            assert not all(tuple(sorted((other[0], action))) in exclusive for action in one)
        count = len(spec.variables)
        for tested in ([], list(reversed(range(count))), [count - 1]):
            order = walk_order(spec, tested, groups)
            assert sorted(order) == list(range(count + len(groups)))
            variables = [each for each in order if each < count]
            assert variables[: len(tested)] == tested
            for number, group in enumerate(groups):
                written = {v for action in group for effect in spec.actions[action].effects for v, _ in effect}
                place = order.index(count + number)
                below = [each for each in order[place:] if each < count]
                assert written <= set(below)
                assert not written or below[0] in written
                assert written or not [each for each in order[:place] if each < count]


def test_goals_of_every_prover() -> None:
    """Active and residual goals, of Z3, the walk and explicit-state checking, in every state, for some sets."""
    for spec in (*ALL, parse(BY_CASES)):
        model, solver, packing = _model(spec), Solver(), Packing(spec)
        goals = WalkGoals(model)
        runs = Runs(spec, packing, Steps(spec, packing, "any", lambda _: None), {}, lambda _: None)
        residuals = goals.residuals(model.valid, model.chosen)
        assert len({goal for goal, _ in residuals}) == len(residuals)
        for state in [state for state in literal.states(spec) if literal.valid(spec, state)][:40]:
            active = active_goals(spec, state)
            assert {body for body, where in goals.active.items() if _value(model, where, state, frozenset())} == active
            terms = GoalTerms.of(spec, Place.fresh(spec, "s", solver.context).after(tuple(enumerate(state))))
            assert {body for body, term in terms.active.items() if term} == active
            for each in _choices(model)[:6]:
                pending = residual_goal(spec, state, each)
                assert [goal for goal, where in residuals if _value(model, where, state, each)] == [pending]
                assert runs.residual(packing.pack(state), each) == pending
                executed = [number in each for number in range(len(spec.actions))]
                assert terms.is_residual(pending, executed) is True
                assert terms.is_residual(Residual(pending.bodies ^ {0}, pending.executed), executed) is False


def _meets(spec: Spec, rows: Mapping[State, ActionSet], goal: Residual, state: State) -> bool:
    """Whether the run from a state meets a goal in one step less than the bound."""
    met = set[State]()
    while not reached(spec, goal, state):
        if state not in rows or state in met or len(met) + 1 == spec.max_plan_length:
            return False
        met.add(state)
        state = literal.successor(spec, state, rows[state])
    return True


@pytest.mark.parametrize("bound", [None, 1, 2, 3])
def test_from_where_a_goal_is_near(bound: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs meet it in so many steps but one, whether goals are looked at one by one or all together."""
    answers = list[bool]()
    for seed, plain in enumerate((*ALL, parse(BY_CASES))):
        spec, random = replace(plain, max_plan_length=bound), Random(seed)
        drawn = {state: chosen for state, chosen in _some_rows(spec, random).items() if random.random() < 0.9}
        policy = bind(policy_from_rows(spec, drawn), spec)
        table = as_table(policy, len(drawn))
        assert table is not None
        rows = table.rows
        acting = {s for s, each in rows.items() if literal.valid(spec, s) and literal.agrees(spec, each)}

        runs = {state: rows[state] for state in acting}
        for most_apart in (0, 10**9):
            monkeypatch.setattr(many_goals, "MOST_APART", most_apart)
            model = ClosedLoop(spec, as_diagram(policy), "any")
            goals = WalkGoals(model)
            assert goals.are_many == (most_apart == 0 and bool(spec.bodies))
            near = {state: residual_goal(spec, state, rows[state]) for state in rows if literal.valid(spec, state)}
            assert {goal for goal, _ in goals.residuals(model.decided, model.policy)} == set(near.values())
            for goal in {None} if goals.are_many else set(near.values()):
                found = goals.own(goal, goals.within(goal), model.policy)
                for state in [state for state, each in near.items() if goal in (None, each)]:
                    answers.append(_meets(spec, runs, near[state], state))
                    assert _value(model, found, state, frozenset()) == answers[-1]
    assert 0.1 < sum(answers) / len(answers) < 0.9


def test_durations_sizes_and_the_least() -> None:
    """Sums over the chosen actions; the least of a measure is taken among the sets that are left."""
    build = Build({"x": "ab"}, ["arm"])
    for length, needs in ((3, ["arm"]), (1, []), (0, ["arm"]), (2, [])):
        build.action("x=b", duration=length, needs=needs)
    model = _model(build.spec())
    takes, size = model.duration(model.chosen), model.size(model.chosen)
    choices = _choices(model)
    for each in choices:
        assert _value(model, takes, (0,), each) == duration(model.spec, each)
        assert _value(model, size, (0,), each) == len(each)
    for required in ((1,), (0,), (0, 3), (2,), ()):
        where = model.walk.all_of(model.chosen[action] for action in required)
        left = model.least(where, takes)
        fitting = [each for each in choices if set(required) <= each]
        least = min(duration(model.spec, each) for each in fitting)
        best = [each for each in fitting if duration(model.spec, each) == least]
        assert [each for each in choices if _value(model, left, (0,), each)] == best


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_what_is_allowed_and_where_it_leads(ordering: Ordering) -> None:
    """`Ok(s, A)`, `δ(s, A)`, and the first state of a predicate, in the order of declaration."""
    for spec in ALL[:5]:
        model = _model(spec, ordering)
        step = model.successor(model.chosen)
        states = [state for state in literal.states(spec) if literal.valid(spec, state)]
        for state in states[:8]:
            fine = literal.allowed(spec, state, ordering)
            for each in _choices(model):
                assert _value(model, model.allowed, state, each) == (each in fine)
                assert model.holds(model.allowed, state, each) == (each in fine)
                if each in fine:
                    end = [_value(model, step.get(v, model.walk.variable(v)), state, each) for v in range(len(state))]
                    assert tuple(end) == literal.successor(spec, state, each)
        safe = [state for state in states if literal.safe(spec, state)]
        assert model.first_state(model.safe) == safe[0]
        others = model.walk.without(model.valid, model.safe)
        if others != FALSE:
            assert model.first_state(others) == next(state for state in states if state not in safe)


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_a_step_leads_into_a_target(ordering: Ordering) -> None:
    """Where the policy acts, every outcome is in it, and so is `δ`; resources are controlled once here."""
    answers = list[bool]()
    for seed, spec in enumerate(ALL):
        random, states = Random(seed), literal.states(spec)
        fine = [each for each in literal.sets(spec) if "resource" not in literal.broken(spec, states[0], each, "first")]
        rows = {state: random.choice(fine) for state in states if random.random() < 0.8}
        model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, rows)), ordering)
        acting = {s for s, each in rows.items() if literal.valid(spec, s) and literal.agrees(spec, each)}
        for outside in random.sample(states, min(3, len(states))):
            led = model.leads_into(model.walk.negation(model.is_state(outside)))
            for state in states:
                ends = {*literal.outcomes(spec, state, rows[state], ordering)} if state in acting else {outside}
                ends |= {literal.successor(spec, state, rows[state])} if state in acting else set()
                answers.append(outside not in ends)
                assert _value(model, led, state, frozenset()) == answers[-1]
    assert 0.1 < sum(answers) / len(answers) < 0.9


def _number(walk: Walk) -> int:
    """A function with the values 0, 1 and 2, for which nothing is remembered."""
    ones, twos = (walk.by_value(4 + each, (FALSE, walk.constant(1 + each))) for each in range(2))
    return walk.by_value(1, (ones, twos))


REMEMBERED: dict[str, Callable[[Walk, int, int], object]] = {
    "select": lambda walk, one, other: walk.select(one, (TRUE, other)),
    "select of three": lambda walk, one, other: walk.select(_number(walk), (FALSE, other, one)),
    "combine": lambda walk, one, other: walk.apply(operator.add, one, other),
    "compose": lambda walk, one, other: walk.compose(one, {3: other, 5: TRUE}),
    "substitute a value": lambda walk, one, _: walk.compose(one, {5: TRUE}),
    "cofactor_where": lambda walk, one, other: walk.cofactor_where(one, {4: 1}, other, one),
    "holds_where": lambda walk, one, other: walk.holds_where(one, {4: 1}, operator.ge, other, FALSE),
}


@pytest.mark.parametrize("name", REMEMBERED)
def test_every_operation_counts_what_it_remembers(name: str) -> None:
    """So a walk that may remember less is given up, and one that may remember just that much is not."""

    def made(most: int) -> tuple[Walk, int, int]:
        walk = Walk(range(6), [2] * 6, most_steps=10**9)
        one = walk.any_of(walk.all_of((walk.variable(n), walk.variable(5 - n))) for n in range(3))
        other = walk.apply(operator.eq, walk.variable(0), walk.variable(4))
        walk.most = walk.remembered + most
        return walk, one, other

    walk, one, other = made(10**9)
    before = walk.remembered
    REMEMBERED[name](walk, one, other)
    used = walk.remembered - before
    assert used >= 4, "one for each node at least"
    REMEMBERED[name](walk, one, other)
    assert walk.remembered - before == used, "what is known is not made again"
    walk, one, other = made(used)
    REMEMBERED[name](walk, one, other)
    assert not walk.is_full
    walk, one, other = made(used - 1)
    with pytest.raises(BudgetError, match="too large"):
        REMEMBERED[name](walk, one, other)
    assert walk.is_full


def test_room_is_made() -> None:
    """Where more than half is remembered of what may be, and functions take less: all results are forgotten."""
    walk = Walk(range(6), [2] * 6)
    one = walk.any_of(walk.all_of((walk.variable(n), walk.variable(5 - n))) for n in range(3))
    other = walk.apply(operator.eq, walk.variable(0), walk.variable(4))

    def remembered() -> list[int]:
        found = [walk.remembered]
        for operation in REMEMBERED.values():
            operation(walk, one, other)
            found.append(walk.remembered)
        return found

    remembered()
    functions = len(walk._levels)
    for used, most, forgets in (
        (100 * functions, 2 * functions, False),
        (100 * functions, 2 * functions + 1, True),
        (2 * functions, 4 * functions, False),
        (2 * functions, 4 * functions - 1, True),
    ):
        walk.remembered, walk.most = used, most
        walk.make_room()
        assert walk.remembered == (0 if forgets else used)
    walk.most = 10**9
    first = remembered()
    walk.most = 2 * functions + 1
    walk.remembered = 100 * functions
    walk.make_room()
    walk.most = 10**9
    assert remembered() == first
    assert sorted({*first}) == first
    assert len(walk._levels) == functions


def test_a_result_counts_as_one() -> None:
    """A constant is no result; a node that was looked up is."""
    walk = Walk(range(3), [2, 2, 2])
    assert walk.remembered == 0
    walk.apply(operator.add, walk.variable(0), walk.variable(1))
    assert walk.remembered == len(walk._applied[operator.add]) == 3


def test_time_and_watchers() -> None:
    """Heeded now and then while results are remembered."""
    walk = Walk(range(12), [2] * 12)
    met = []
    walk.watch = lambda: met.append(walk.remembered)
    one = walk.any_of(walk.all_of((walk.variable(n), walk.variable(11 - n))) for n in range(6))
    walk.apply(operator.add, one, walk.apply(operator.eq, walk.variable(3), walk.variable(9)))
    for number in range(40):
        walk.apply(operator.mul, one, walk.apply(operator.add, one, walk.constant(number)))
    assert met == [1024 * number for number in range(1, walk.remembered // 1024 + 1)]
    assert met
    walk.check_time()
    assert met[-1] == walk.remembered
    walk.deadline = 0.0
    with pytest.raises(BudgetError, match="time limit"):
        walk.check_time()


def _witnesses(spec: Spec, rows: dict[State, ActionSet], ordering: Ordering = "any") -> tuple[ClosedLoop, Witnesses]:
    policy = policy_from_rows(spec, rows)
    model = ClosedLoop(spec, as_diagram(policy), ordering)
    return model, Witnesses(model, Decisions(spec, policy), ordering)


def test_what_the_walk_gets_wrong_is_a_bug() -> None:
    """A witness is looked at again by the explicit meaning, which has to find it wrong too."""
    build = Build({"x": "abc"})
    bad = build.atom("x=b")
    dear, same, late = (build.action(f"x={there}", duration=2, when=[bad]) for there in "aac")
    never = build.action("x=a", duration=1, when=[Not(bad)])
    short = build.action("x=c", duration=1, when=[bad])
    spec = build.spec(constraint(build.goal(build.atom("x=a"))), [Not(bad)], assumptions=[])
    rows: dict[State, ActionSet] = {(0,): chosen(), (1,): chosen(dear)}
    model, witnesses = _witnesses(spec, rows)
    walk = model.walk

    def at(state: int, executed: Executing | None = None) -> int:
        where = [walk.by_value(0, [int(value == state) for value in range(3)])]
        alone = [model.chosen[a] if executed == Executing(a) else walk.negation(model.chosen[a]) for a in range(5)]
        return walk.all_of([*where, *([] if executed is None else alone)])

    assert witnesses.missing(at(2)).verdict == "refuted"
    with pytest.raises(RuntimeError, match="is decided"):
        witnesses.missing(at(0))
    assert witnesses.goal_missed((0,)) is None
    for wrong in (same, late, never, short):
        with pytest.raises(RuntimeError, match="is not better"):
            witnesses.not_minimal(at(1, wrong))
    excluded = replace(spec, assumptions=(replace(spec.state_rules[0], formula=Not(build.atom("x=c"))),))
    _, witnesses = _witnesses(excluded, rows)
    with pytest.raises(RuntimeError, match="is decided"):
        witnesses.missing(at(2))


class _Times(Budget):
    """Notes how much time is said to be used up."""

    def __init__(self) -> None:
        super().__init__()
        self.spent: list[float] = []

    def until(self, spent: float = 0.0) -> float:
        self.spent.append(spent)
        return super().until(spent)


def test_what_children_are_given() -> None:
    """The time that is left to each property, what tasks share done before, and no answer that needed too much."""
    walk, parallel, budget, told = Walk(range(2), [2, 2]), ParallelProofs(), _Times(), list[str]()
    parallel.seconds["goals"] = 1000.0
    shared: list[int] = []
    tasks = [
        Task("goals", "one", lambda: (len(shared), 1), lambda: shared.append(1)),
        Task("minimal", "two", lambda: (len(shared), 2)),
        Task("goals", "three", lambda: (len(shared), 3), lambda: shared.append(2)),
    ]
    parallel.ask(walk, tasks, 1, budget, told.append)
    assert told == ["goals", "minimal", "goals"]
    assert parallel.answers == {"one": (1, 1), "two": (1, 2), "three": (2, 3)}
    assert [1000 <= each < 1100 for each in budget.spent] == [True, False, True]
    assert 0 <= budget.spent[1] < 100
    assert 1000 <= parallel.seconds["goals"] < 1100
    assert 0 <= parallel.seconds["minimal"] < 100
    assert parallel.take("one", lambda: (5, 0)) == (1, 1)
    assert parallel.take("four", lambda: (5, 0)) == (5, 0)


def test_workers_share_what_may_be_remembered() -> None:
    """Where all together remember more than one may, no answer counts; else so much less is left."""

    def work(walk: Walk, count: int) -> int:
        walk.remembered += count
        walk.check_time()
        return count

    for most, counts in ((10, True), (9, False)):
        walk, parallel = Walk(range(2), [2, 2], most_steps=most + 5), ParallelProofs()
        walk.remembered = 5
        taken: list[int] = []
        tasks = [Task("goals", count, partial(work, walk, count)) for count in (4, 6)]
        parallel.ask(walk, tasks, 1, Budget(), lambda _: None)
        assert parallel.answers == ({4: 4, 6: 6} if counts else {})
        assert walk.most == (5 if counts else most + 5)
        if counts:
            assert parallel.take(4, partial(taken.append, 4)) == 4
            parallel.forget(walk)
            assert (walk.most, taken, parallel.answers, parallel.seconds) == (most + 5, [4], {}, {})


def test_substitution_keeps_the_order() -> None:
    """Functions for some of the variables, of which each may test variables above and below: what is found is one."""
    random, sizes = Random(7), (2, 3, 2, 2)
    points = list(product(*map(range, sizes)))

    def made(walk: Walk, table: Mapping[literal.State, int], point: literal.State = ()) -> int:
        if len(point) == len(sizes):
            return walk.constant(table[point])
        below = [made(walk, table, (*point, value)) for value in range(sizes[len(point)])]
        return walk.by_value(len(point), below)

    for order in ((0, 1, 2, 3), (2, 3, 1, 0)):
        walk = Walk(order, sizes)
        for _ in range(12):
            table, ones, twos = ({point: random.randint(0, most) for point in points} for most in (3, 1, 1))
            one, two = made(walk, ones), made(walk, twos)
            for given in ({3: one}, {0: one}, {1: two}, {0: one, 1: two}, {2: walk.constant(1), 1: two}):
                turned = dict[literal.State, int]()
                for point in points:
                    end = list(point)
                    for variable, by in given.items():
                        end[variable] = ones[point] if by == one else twos[point] if by == two else 1
                    turned[point] = table[tuple(end)]
                assert walk.compose(made(walk, table), given) == made(walk, turned)


@pytest.mark.parametrize("actions", [1, 2, 3, 4, 5])
def test_the_next_state_by_cases_and_by_variables(actions: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the number of actions, each of which writes a variable of its own."""
    build = Build({f"x{number}": "ab" for number in range(actions)})
    for number in range(actions):
        build.action(f"x{number}=b")
    spec = build.spec()
    states = literal.states(spec)
    rows = {state: frozenset(n for n in range(actions) if (state[n] + sum(state)) % 2 == 0) for state in states}
    for most in (0, 128):
        monkeypatch.setattr(import_module("tumato_symbolic.verify.by_diagrams.cases"), "MOST_CASES", most)
        model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, rows)), "any")
        for variable in range(actions):
            after = model.next(model.walk.variable(variable))
            for state in states:
                end = literal.successor(spec, state, rows[state])
                assert _value(model, after, state, frozenset()) == end[variable]


def _some_rows(spec: Spec, random: Random) -> dict[State, ActionSet]:
    """Sets of actions, drawn for every state; they may exclude each other, and nominal effects of some disagree."""
    rows = dict[State, ActionSet]()
    for state in literal.states(spec):
        drawn = frozenset(number for number in range(len(spec.actions)) if random.random() < 0.5)
        rows[state] = drawn if literal.agrees(spec, drawn) or random.random() < 0.3 else frozenset()
    return rows


@pytest.mark.parametrize("most", [0, 3, 128])
def test_the_next_state_where_some_groups_are_taken_apart(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Constants by one group, or by all, beside the next values of other variables: δ all the same."""
    monkeypatch.setattr(import_module("tumato_symbolic.verify.by_diagrams.cases"), "MOST_CASES", most)
    build = Build({"x": "abc", "y": "abc", "z": "ab"}, resources="R")
    for effect in ("x=a", "x=b y=a", "", "y=a", "x=c"):
        build.action(effect, needs="R")
    for effect in ("y=a", "z=b", "z=a y=b"):
        build.action(effect)
    spec = build.spec()
    for seed in range(8):
        random = Random(seed)
        drawn = _some_rows(spec, random)
        model = ClosedLoop(spec, as_diagram(policy_from_rows(spec, drawn)), "any")
        rows = {state: chosen for state, chosen in drawn.items() if literal.agrees(spec, chosen)}
        assert len(rows) < len(drawn)
        table = {state: random.randint(0, 4) for state in drawn}
        walk = model.walk
        function = walk.any_of(())
        for state, value in table.items():
            function = walk.select(model.is_state(state), (function, walk.constant(value)))
        after = model.next(function)
        for state, chosen_set in rows.items():
            assert _value(model, after, state, frozenset()) == table[literal.successor(spec, state, chosen_set)]
        elsewhere = walk.select(model.acting, (walk.constant(5), after))
        assert model.steps_hold(operator.eq, function, elsewhere)
        for state in rows:
            wrong = walk.select(model.is_state(state), (after, walk.apply(operator.add, after, walk.constant(1))))
            assert not model.steps_hold(operator.eq, function, wrong)
            assert model.steps_hold(operator.lt, function, wrong) == (len(rows) == 1)
            asked = walk.select(model.is_state(state), (walk.constant(UNASKED), wrong))
            assert model.steps_hold(operator.lt, function, asked)


def test_why_a_walk_is_given_up() -> None:
    """Its own reason, or that there are too many variables."""
    assert given_up(BudgetError("tired")) == "tired"
    assert given_up(RecursionError("maximum")) == "there are too many variables for the walk"
