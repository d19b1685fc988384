"""Explicit-state checking: states as numbers, single steps, how much is looked at, and when it is too much."""

from __future__ import annotations

from itertools import product
from typing import Any

import pytest

from tests.generate import ALL_PROFILES, random_spec
from tests.semantics import literal
from tests.semantics.build import Build, chosen
from tests.verify.policies import certified
from tests.verify.test_forged_ranks import along, exact, restoring
from tests.verify.test_forged_steps import ORDERINGS, SPECS
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import policy_from_rows
from tumato_symbolic.semantics import ActionSet, Residual, State, duration, holds, nominal_agrees
from tumato_symbolic.spec import TRUE, Not, Ordering, Spec
from tumato_symbolic.verify import PropertyName
from tumato_symbolic.verify.by_states import packed, prover, steps
from tumato_symbolic.verify.by_states.packed import Packing, valid_states
from tumato_symbolic.verify.by_states.prover import StateProver
from tumato_symbolic.verify.by_states.runs import Runs
from tumato_symbolic.verify.by_states.steps import Steps
from tumato_symbolic.verify.decisions import LARGEST_TABLE

GENERATED = [random_spec(seed, ALL_PROFILES[profile]) for profile in ALL_PROFILES for seed in (3000, 3001)]
GOAL = Residual(frozenset((0,)), frozenset())


def _steps(spec: Spec, ordering: Ordering) -> tuple[Packing, Steps]:
    packing = Packing(spec)
    return packing, Steps(spec, packing, ordering, lambda _: None)


def _prover(spec: Spec, rows: dict[State, ActionSet], ordering: Ordering = "any", ranks: Any = None) -> StateProver:
    policy = policy_from_rows(spec, rows) if ranks is None else certified(spec, rows, ranks)
    return StateProver(spec, policy, ordering, Context())


def test_states_as_numbers() -> None:
    """Every state has a number of its own, and effects change just what they write."""
    build = Build({"x": "abcde", "y": "a", "z": "ab"})
    effect = build.effect("x=d z=b")
    spec = build.spec()
    packing = Packing(spec)
    states = list(literal.states(spec))
    assert len({packing.pack(state) for state in states}) == len(states)
    for state in states:
        assert packing.unpack(packing.pack(state)) == state
        keep, put = packing.writes(effect)
        assert packing.unpack(packing.pack(state) & keep | put) == literal.changed(state, effect)
        assert packing.unpack(packing.pack(state) & packing.mask([0, 2])) == (state[0], 0, state[2])


@pytest.mark.parametrize("few", [0, 3, 100])
@pytest.mark.parametrize("spec", GENERATED)
def test_rules_that_are_asked_of_as_one(spec: Spec, few: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether all rules hold is whether each does, however many are put together."""
    monkeypatch.setattr(packed, "REMEMBERED_BITS", few)
    packing, rules = Packing(spec), (*spec.assumptions, *spec.state_rules)
    test = packed.all_hold(packing, rules)
    for state in literal.states(spec):
        assert test(packing.pack(state)) == all(holds(rule.formula, state) for rule in rules)


@pytest.mark.parametrize("spec", [*SPECS, *GENERATED])
def test_valid_states_in_their_order(spec: Spec) -> None:
    """Those that satisfy all assumptions, as they are declared."""
    assert list(valid_states(spec, Packing(spec))) == [
        state for state in literal.states(spec) if literal.valid(spec, state)
    ]


def test_assumptions_that_mention_nothing() -> None:
    """They hold or fail at once."""
    build = Build({"x": "ab"})
    for assumption, count in ((TRUE, 2), (Not(TRUE), 0)):
        spec = build.spec(assumptions=[assumption])
        assert len(list(valid_states(spec, Packing(spec)))) == count


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_steps_are_as_written(ordering: Ordering) -> None:
    """Outcomes, the nominal successor, what is allowed, and what is cheaper, of every set in every valid state."""
    for spec in [*SPECS, *(each for each in GENERATED if len(each.actions) <= 5)]:
        packing, taken = _steps(spec, ordering)
        for state in [state for state in literal.states(spec) if literal.valid(spec, state)][:10]:
            code = packing.pack(state)
            fine = set(literal.allowed(spec, state, ordering))
            for each in literal.sets(spec):
                assert taken.allowed(code, each) == (each in fine)
                after = taken.after(code, each)
                agreeing = nominal_agrees(spec, each)
                assert (after is not None) == agreeing
                if after is not None:
                    assert packing.unpack(after) == literal.successor(spec, state, each)
                ends = {packing.unpack(code) for code in taken.outcomes(code, each)}
                assert ends == set(literal.outcomes(spec, state, each, ordering))
            if not literal.safe(spec, state):
                for limit in range(4):
                    found = list(taken.cheaper_sets(code, limit))
                    assert len(found) == len(set(found))
                    assert set(found) == {each for each in fine if duration(spec, each) < limit}


def test_how_much_there_is_to_look_at() -> None:
    """At least one thing for every decided state and one for every outcome; without end where a set has too many."""
    build = Build({"x": "abcd"})
    one, two = build.action("x=b", ["x=c", "x=d"]), build.action("x=b", ["x=a"])
    spec = build.spec()
    rows: dict[State, ActionSet] = {(0,): chosen(), (1,): chosen(one), (2,): chosen(one, two)}
    assert _prover(spec, rows, "first").work == 1 + (1 + 3) + (1 + 3 + 2)
    assert _prover(spec, rows, "any").work == 1 + (1 + 3) + (1 + 3) * (1 + 2)


def test_too_many_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether a set is safe stays open where its effects interleave in more ways than are listed, but under `first`."""
    build = Build({"x": "ab"})
    actions = [build.action("x=b") for _ in range(4)]
    spec = build.spec()
    rows: dict[State, ActionSet] = {(0,): chosen(*actions), (1,): chosen()}
    for most, verdict in ((16, "proved"), (15, "undecided")):
        monkeypatch.setattr(steps, "MOST_WAYS", most)
        monkeypatch.setattr(prover, "MOST_WAYS", most)
        result = _prover(spec, rows).prove("safe")
        assert result.verdict == verdict
        work = _prover(spec, rows).work
        assert work is not None and (work == 17 if verdict == "proved" else work >= most * LARGEST_TABLE)
        assert _prover(spec, rows, "first").prove("safe").verdict == "proved"
    assert result.reason == "4 actions at a time can interleave in too many ways to list"


@pytest.mark.parametrize("most", [2, 3, 4])
def test_too_many_decided_states(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """As many states as are looked at are not too many; rows for states that are not valid do not count."""
    monkeypatch.setattr(prover, "LARGEST_TABLE", most)
    build = Build({"x": "abcd"})
    spec = build.spec(assumptions=[Not(build.atom("x=b"))])
    asked = _prover(spec, {state: frozenset() for state in literal.states(spec)})
    assert asked.prove("total").verdict == ("proved" if most >= 3 else "undecided")
    assert asked.work == (3 if most >= 3 else None)
    assert asked.valid_states() == (3 if most >= 3 else None)
    assert asked.has_valid_state()


@pytest.mark.parametrize("name", ["total", "safe", "goals", "minimal"])
def test_all_that_is_looked_at_is_accounted_for(name: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A proof that may look at fewer things than it has to is given up; one that may look at just as many is made."""
    monkeypatch.setattr(prover, "_CHECKED_EVERY", 1)
    spec, rows = restoring(7, 7)
    needed = 0
    while (result := _prover(spec, rows).prove(name, needed)).verdict == "undecided":
        assert result.reason == "there are too many cases to check one by one"
        needed += 1
    # valid states; what sets write, and outcomes; starts of runs, and states that are passed for the first time; of the
    # cheaper set, what it writes, its outcome, twice, and its run
    assert needed == {"total": 9, "safe": 9 + 9, "goals": 9 + 9 + 9 + 6, "minimal": 3 + 8}[name]
    for allowed in (needed, needed + 1, None):
        assert _prover(spec, rows).prove(name, allowed).verdict == "proved"
    again = _prover(spec, rows)
    assert again.prove("total").verdict == "proved"
    assert again.prove(name, needed).verdict == "proved", "what was looked at before does not count"


def test_undecided_states_and_a_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a certificate says of states without a decision is looked at too, up to a number of them."""
    spec, rows = along(3)
    rows = {state: rows[state] for state in ((2,), (3,))}
    right = {state: rank for state, rank in exact(spec, rows).items() if state in rows}
    for ranks, expected in ((right, "used"), ({**right, (1,): 2}, "wrong")):
        for most, status in ((3, expected), (2, "incomplete")):
            monkeypatch.setattr(prover, "MOST_UNDECIDED", most)
            asked = _prover(spec, rows, ranks={GOAL: ranks})
            asked.policy_is_safe = True
            assert asked.prove("goals").verdict == "proved"
            assert asked.use.status == status, (ranks, most)
    assert asked.use.reason == "over 2 states are not decided"


def test_what_the_steps_get_wrong_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every refutation is looked at again by the explicit meaning."""
    spec, rows = restoring(2, 3)
    planted: tuple[tuple[PropertyName, Any, str], ...] = (("safe", Steps, "allowed"), ("goals", Runs, "serves"))
    for name, owner, broken in planted:
        with monkeypatch.context() as patched:
            patched.setattr(owner, broken, lambda *_: False)
            with pytest.raises(RuntimeError, match="against"):
                asked = _prover(spec, {(0,): rows[(0,)]})
                if name == "goals":
                    asked._allowed = {0: rows[(0,)]}
                    asked._decided = {0: rows[(0,)], 1: rows[(1,)], 2: rows[(2,)]}
                    asked._decisions = rows  # type: ignore[assignment]
                asked.prove(name)
    with monkeypatch.context() as patched:
        patched.setattr(Runs, "serves", lambda *_: True)
        late, policy = restoring(2, 2)
        with pytest.raises(RuntimeError, match="is not better"):
            _prover(late, policy).prove("minimal")
    with monkeypatch.context() as patched:
        patched.setattr(Steps, "allowed", lambda *_: True)
        build = Build({"x": "ab"})
        bad = build.atom("x=b")
        build.action("x=a", when=[Not(bad)])
        dear = build.action("x=a", duration=1)
        wrong = build.spec(state_rules=[Not(bad)])
        patched.setattr(Steps, "cheaper_sets", lambda *_: iter([frozenset({0})]))
        with pytest.raises(RuntimeError, match="is not better"):
            _prover(wrong, {(0,): chosen(), (1,): chosen(dear)}).prove("minimal")


def test_the_best_of_several_sets() -> None:
    """The shortest, then the one with the fewest actions, then the first; whatever comes in between."""
    build = Build({"x": "ab"})
    bad = build.atom("x=b")
    lengths = (5, 2, 1, 1, 2, 1)
    actions = [build.action("x=a", when=[bad], duration=each) for each in lengths]
    spec = build.spec(state_rules=[Not(bad)])
    for decision, best in ((0, 2), (1, 2), (2, None), (3, None)):
        result = _prover(spec, {(0,): chosen(), (1,): chosen(actions[decision])}).prove("minimal")
        cheaper = None if result.refutation is None else result.refutation.cheaper
        assert cheaper == (None if best is None else chosen(actions[best]))
    assert not [None for one, other in product(lengths, lengths) if one + other < 2]


def test_a_set_is_not_grown_beyond_the_limit() -> None:
    """Three actions that may be together: only those sets that are shorter than the decision."""
    build = Build({"x": "ab"})
    for _ in range(3):
        build.action("x=a", duration=2)
    spec = build.spec(state_rules=[Not(build.atom("x=b"))])
    packing, taken = _steps(spec, "any")
    for limit, count in ((2, 0), (3, 3), (4, 3), (5, 6), (7, 7)):
        assert len(list(taken.cheaper_sets(packing.pack((1,)), limit))) == count
