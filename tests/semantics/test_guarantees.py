"""What a policy guarantees, held against the definitions played out move by move."""

from random import Random

import pytest

from tests.generate import random_spec
from tests.profiles import PROFILES
from tests.semantics.build import Build, priority, when
from tests.verify.policies import near_policies
from tumato_symbolic.semantics import (
    ActionSet,
    Guarantee,
    Move,
    Prospects,
    Residual,
    Shortcoming,
    Shortcomings,
    State,
    allowed,
    guarantees,
    is_valid,
    next_states,
    reached,
    residual_goal,
    shows,
    steps_from,
    successor,
)
from tumato_symbolic.spec import Not, Ordering, Spec

Rows = dict[State, ActionSet]


class Played:
    """The levels of a state, by an opponent who tries everything."""

    def __init__(self, spec: Spec, rows: Rows, ordering: Ordering, goal: Residual) -> None:
        self.spec, self.rows, self.ordering, self.goal = spec, rows, ordering, goal

    def endures(self, state: State, deviations: int, before: frozenset[State] = frozenset()) -> bool:
        """Whether the goal is met from a state where it is pending, with so many deviations at most."""
        if reached(self.spec, self.goal, state):
            return True
        return state not in before and self.step_endures(state, deviations, before | {state})

    def step_endures(self, state: State, deviations: int, before: frozenset[State] = frozenset()) -> bool:
        """The same of a state whose first step has to be taken."""
        if state not in self.rows:
            return False
        nominal = successor(self.spec, state, self.rows[state])
        others = next_states(self.spec, state, self.rows[state], self.ordering) - {nominal} if deviations else set()
        return self.endures(nominal, deviations, before) and all(self.endures(t, deviations - 1) for t in others)

    def steps(self, state: State, before: frozenset[State] = frozenset()) -> int | None:
        """How many steps the goal is away at worst; None where it is not forced."""
        if before and reached(self.spec, self.goal, state):
            return 0
        if state in before or state not in self.rows:
            return None
        following = next_states(self.spec, state, self.rows[state], self.ordering)
        found = [self.steps(after, before | {state}) for after in following]
        return None if None in found else 1 + max(each for each in found if each is not None)


def _played(spec: Spec, rows: Rows, ordering: Ordering, state: State) -> Guarantee | None:
    game = Played(spec, rows, ordering, residual_goal(spec, state, rows[state]))
    steps = game.steps(state)
    if steps is not None:
        return Guarantee("guaranteed", steps=steps)
    many = len(rows) + 1
    survived = [count for count in range(many + 1) if game.step_endures(state, count)]
    if len(survived) > many:
        return Guarantee("fair")
    assert survived == list(range(len(survived)))
    if not survived:
        return None
    return Guarantee("survives", deviations=survived[-1]) if survived[-1] else Guarantee("nominal")


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_levels_are_those_of_the_game(ordering: Ordering) -> None:
    """On small generated specifications, with policies that may be partial and miss their goals."""
    met = set()
    for seed in range(24):
        spec, random = random_spec(seed, PROFILES[("restoring", "interacting")[seed % 2]]), Random(seed)
        for rows in near_policies(spec, ordering, random, count=1):
            decided = {s: a for s, a in rows.items() if is_valid(spec, s) and allowed(spec, s, a, ordering)}
            if len(decided) > 12:
                continue
            found = guarantees(spec, decided, ordering)
            assert found == {state: _played(spec, decided, ordering, state) for state in decided}
            met |= {each and each.kind for each in found.values()}
    assert {"guaranteed", "fair", "nominal", None} <= met


def _leaking() -> tuple[Spec, Rows]:
    """A tank from full (a) to empty (d): each way from start to goal may lose some instead. Empty: no goal."""
    build = Build({"x": "sg", "tank": "abcd"})
    for here, there in ("ab", "bc", "cd"):
        build.action("x=g", (f"tank={there}",), when=(build.atom(f"tank={here}"), build.atom("x=s")))
    spec = build.spec(priority(when(Not(build.atom("tank=d")), build.goal(build.atom("x=g")))))
    go = {build.state(f"s{tank}"): frozenset({number}) for number, tank in enumerate("abc")}
    stay = {build.state(text): frozenset[int]() for text in ("ga", "gb", "gc", "gd", "sd")}
    return spec, go | stay


def test_deviations_are_counted() -> None:
    """With a the goal is met although the tank leaks twice, and not three times."""
    spec, rows = _leaking()
    found = guarantees(spec, rows, "any")
    assert found[0, 0] == Guarantee("survives", deviations=2)
    assert found[0, 1] == Guarantee("survives", deviations=1)
    assert found[0, 2] == Guarantee("nominal")
    assert found[0, 3] == found[1, 0] == Guarantee("guaranteed", steps=1)


def _shortcoming(spec: Spec, rows: Rows, state: State) -> Shortcoming | None:
    steps = steps_from(spec, rows, rows, "any")
    assert steps is not None
    prospects = Prospects(spec, residual_goal(spec, state, rows[state]), steps)
    told = Shortcomings(spec, rows, "any", prospects.endures, prospects.forced.__contains__)
    guarantee = prospects.of(steps[state])
    assert guarantee is not None
    return told.of(state, guarantee)


def test_a_shortcoming_has_one_deviation_more() -> None:
    """Three leaks lead to where the goal is not met; only that shows that no more than two are survived."""
    spec, rows = _leaking()
    found = _shortcoming(spec, rows, (0, 0))
    assert found is not None
    assert (found.deviations, [move.after for move in found.moves]) == (3, [(0, 1), (0, 2), (0, 3)])
    assert found.rest == ((0, 3), (0, 3))
    two = Guarantee("survives", deviations=2)
    assert shows(spec, rows, "any", two, found)
    assert not shows(spec, rows, "any", Guarantee("survives", deviations=1), found)
    assert not shows(spec, rows, "any", Guarantee("fair"), found)
    shorter = Shortcoming(found.state, found.moves[:2], rest=((0, 2), (1, 2), (1, 2)))
    assert not shows(spec, rows, "any", Guarantee("survives", deviations=1), shorter)
    nominal = Move(rows[0, 0], (0, 1))
    assert not shows(spec, rows, "any", two, Shortcoming(found.state, (nominal, *found.moves[1:]), rest=found.rest))


def test_a_loop_shows_that_a_state_is_no_more_than_fair() -> None:
    """An action that may change nothing may do so for ever; nothing else is a loop."""
    build = Build({"x": "sg"})
    build.action("x=g", ("",), when=(build.atom("x=s"),))
    spec = build.spec(priority(build.goal(build.atom("x=g"))))
    rows: dict[State, ActionSet] = {(0,): frozenset({0}), (1,): frozenset()}
    assert guarantees(spec, rows, "any")[(0,)] == Guarantee("fair")
    found = _shortcoming(spec, rows, (0,))
    assert found is not None
    assert (found.loop, [move.after for move in found.moves]) == (0, [(0,)])
    assert shows(spec, rows, "any", Guarantee("fair"), found)
    assert not shows(spec, rows, "any", Guarantee("nominal"), found)
    assert not shows(spec, rows, "any", Guarantee("fair"), Shortcoming((0,), found.moves, loop=1))
    reaching = Shortcoming((0,), (Move(rows[(0,)], (1,)),), loop=0)
    assert not shows(spec, rows, "any", Guarantee("fair"), reaching)
    assert not shows(spec, rows, "any", Guarantee("fair"), Shortcoming((0,), (), loop=0))
