"""Forged ranks: one rank of one state is made every other number, and each prover takes them for what they are."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Literal, NoReturn

import pytest

from tests.semantics import literal
from tests.semantics.build import Build, priority, when
from tests.verify.policies import certified, exact_ranks
from tumato_symbolic.semantics import NOTHING, Residual, State
from tumato_symbolic.spec import Not, Spec
from tumato_symbolic.verify import verify
from tumato_symbolic.verify.by_diagrams.functions import BudgetError
from tumato_symbolic.verify.by_diagrams.ranks import WalkRanks
from tumato_symbolic.verify.by_z3 import rank_terms
from tumato_symbolic.verify.by_z3.rank_terms import RankProof
from tumato_symbolic.verify.by_z3.solver import UndecidedError
from tumato_symbolic.verify.claimed_ranks import NOT_ALL

Table = dict[literal.State, int]
Policy = dict[literal.State, literal.Actions]
Name = Literal["z3", "walk", "explicit"]
JUDGES: dict[str, Name] = {"at once": "z3", "by parts": "z3", "walk": "walk"}
needing_no_rival = pytest.mark.parametrize("prover", [*JUDGES, "explicit"], indirect=True)
"""Explicit-state checking takes the ranks of a certificate for goals only."""


@pytest.fixture(params=JUDGES)
def prover(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Name:
    """Z3 with all ranks at once, Z3 with each rank apart, the walk, and explicit-state checking."""
    if request.param == "by parts":
        monkeypatch.setattr(rank_terms, "AT_ONCE", -1.0)
    return JUDGES.get(request.param, "explicit")


def along(length: int, bound: int | None = None) -> tuple[Spec, Policy]:
    """So many places in a row to the last one, which is the goal; the policy goes there, one place at a time."""
    places = "abcdefgh"[: length + 1]
    build = Build({"x": places + "z"})
    actions = [build.action(f"x={there}", when=[build.atom(f"x={here}")]) for here, there in itertools.pairwise(places)]
    spec = build.spec(priority(build.goal(build.atom(f"x={places[-1]}"))), bound=bound)
    policy: Policy = {(number,): frozenset((action.action,)) for number, action in enumerate(actions)}
    return spec, {**policy, (length,): frozenset()}


def exact(spec: Spec, policy: Policy) -> Table:
    """How far the goal is from every safe state."""
    body = spec.bodies[0].formula
    found = {}
    for state in literal.states(spec):
        here, steps = state, 0
        while here in policy and not literal.true(body, here) and steps < 20:
            here, steps = literal.successor(spec, here, policy[here]), steps + 1
        if literal.true(body, here) and literal.safe(spec, state):
            found[state] = steps
    return found


def forged(spec: Spec, right: Table) -> Iterator[Table]:
    """The ranks themselves, and with one of them too small, too large, the largest but one, or none."""
    yield right
    most = max(right.values())
    safe = [state for state in literal.states(spec) if literal.safe(spec, state)]
    for state in {*safe[:2], *safe[-2:]}:
        here = right.get(state, most)
        for rank in {None, 0, max(0, here - 1), here + 1, here + 2, most + 1, most + 2}:
            if rank != right.get(state):
                changed = {**right, state: -1 if rank is None else rank}
                yield {each: number for each, number in changed.items() if number >= 0}
    yield {state: rank + 1 if rank else rank for state, rank in right.items()}
    yield {state: 2 * rank for state, rank in right.items()}
    yield {state: min(rank, 1) for state, rank in right.items()}


def decrease(spec: Spec, policy: Policy, table: Table) -> bool:
    """0 is in the goal only, and from every other rank the policy steps to a smaller one of a safe state."""
    for state, rank in table.items():
        if rank == 0 and not literal.true(spec.bodies[0].formula, state):
            return False
        if rank > 0:
            if state not in policy:
                return False
            after = literal.successor(spec, state, policy[state])
            if not literal.safe(spec, after) or after not in table or table[after] >= rank:
                return False
    return True


def bound_below(spec: Spec, policy: Policy, table: Table) -> bool:
    """0 in the goal; elsewhere at most one more than after the policy's step, which leads to a safe state."""
    never = 1000
    for state in literal.states(spec):
        if not literal.safe(spec, state):
            continue
        here = table.get(state, never)
        if literal.true(spec.bodies[0].formula, state):
            if here != 0:
                return False
        elif state in policy:
            after = literal.successor(spec, state, policy[state])
            if not literal.safe(spec, after) or (table.get(after, never) < never and here > table[after] + 1):
                return False
    return True


def _status(spec: Spec, policy: Policy, table: Table, prover: Name, name: str) -> tuple[str, str]:
    goal = Residual(frozenset((0,)), frozenset())
    answer = verify(certified(spec, policy, {goal: table}), spec, prover=prover, properties=["safe", name])
    return answer.properties[1].verdict, answer.certificate.status


@needing_no_rival
@pytest.mark.parametrize("right", [True, False])
@pytest.mark.parametrize(("length", "bound"), [(1, None), (3, None), (3, 4), (4, 4), (3, 2)])
def test_ranks_of_goals(length: int, bound: int | None, right: bool, prover: Name) -> None:
    """The policy is right or wrong whatever the ranks say; they are *wrong* where they do not decrease to the goal or
    exceed the bound, *incomplete* where one is missing that is needed, and *used* otherwise.

    A wrong policy goes round at the beginning, or takes longer than is allowed.
    """
    spec, policy = along(length, bound)
    if not right:
        policy = {**policy, (0,): policy[length,]}
    too_long = bound is not None and length > bound
    expected, usual = ("proved", "used") if right and not too_long else ("refuted", "incomplete")
    met = set()
    for table in forged(spec, exact(spec, policy)):
        needed = [literal.successor(spec, state, policy[state]) for state in policy]
        if not decrease(spec, policy, table) or (
            bound is not None and any(table.get(state, 0) >= bound for state in needed)
        ):
            wanted = "wrong"
        else:
            wanted = "used" if all(state in table for state in needed) else "incomplete"
        verdict, status = _status(spec, policy, table, prover, "goals")
        assert (verdict, status) == (expected, wanted), table
        met.add(wanted)
    assert met >= ({"wrong"} if too_long else {"wrong", usual})


@needing_no_rival
@pytest.mark.parametrize("length", [2, 3, 4, 7])
def test_a_bound_that_is_near(length: int, prover: Name) -> None:
    """A policy whose longest run takes as many steps as the bound is right; with one step less it is refuted, with
    right ranks and without."""
    for bound, verdict in ((length + 1, "proved"), (length, "proved"), (length - 1, "refuted")):
        spec, policy = along(length, bound)
        right = exact(spec, policy)
        status = "used" if verdict == "proved" else "wrong"
        assert _status(spec, policy, right, prover, "goals") == (verdict, status), "a rank may exceed the bound"
        assert _status(spec, policy, {}, prover, "goals")[0] == verdict
        lowered = {state: max(0, rank - 1) for state, rank in right.items()}
        assert _status(spec, policy, lowered, prover, "goals")[0] == verdict


def restoring(length: int, bound: int) -> tuple[Spec, Policy]:
    """From the unsafe state the cheap way back is far from the goal, the dear one is at the goal."""
    places = "abcdefgh"[: length + 1]
    build = Build({"x": places + "u"})
    steps = [build.action(f"x={there}", when=[build.atom(f"x={here}")]) for here, there in itertools.pairwise(places)]
    bad = build.atom("x=u")
    cheap = build.action("x=a", when=[bad], duration=1)
    dear = build.action(f"x={places[-1]}", when=[bad], duration=2)
    spec = build.spec(priority(build.goal(build.atom(f"x={places[-1]}"))), state_rules=[Not(bad)], bound=bound)
    policy: Policy = {(number,): frozenset((action.action,)) for number, action in enumerate(steps)}
    policy |= {(length,): frozenset(), (length + 1,): frozenset((dear.action,))}
    assert cheap.action == length
    return spec, policy


@pytest.mark.parametrize("length", [1, 3])
def test_ranks_of_a_rival(length: int, prover: Name) -> None:
    """The dear set is minimal where the cheap one comes one step too late, and is not where it comes in time; ranks
    carry the proof exactly where they are nowhere too large, and large enough."""
    met = set()
    for bound in (length, length + 1):
        spec, policy = restoring(length, bound)
        minimal = bound == length
        for table in forged(spec, exact(spec, policy)):
            verdict, status = _status(spec, policy, table, prover, "minimal")
            assert verdict == ("proved" if minimal else "refuted"), table
            if minimal:
                carries = bound_below(spec, policy, table) and table.get((0,), 1000) >= bound
                assert status == ("used" if carries else "incomplete"), table
                met.add(status)
    assert met == {"used", "incomplete"}


@needing_no_rival
def test_a_rank_leads_out_of_the_safe_states(prover: Name) -> None:
    """Ranks speak of safe states: a step that leaves them has no rank, though the run comes back."""
    build = Build({"x": "abc"})
    out = build.action("x=b", when=[build.atom("x=a")])
    back = build.action("x=c", when=[build.atom("x=b")])
    unsafe = Not(build.atom("x=b"))
    spec = build.spec(priority(build.goal(build.atom("x=c"))), state_rules=[unsafe])
    policy: Policy = {(0,): frozenset((out.action,)), (1,): frozenset((back.action,)), (2,): frozenset[int]()}
    assert _status(spec, policy, {(0,): 2, (1,): 1, (2,): 0}, prover, "goals")[1] == "set aside"


GOALS = [Residual(frozenset((number,)), frozenset()) for number in range(2)]


def going_round(bound: int | None = None, modes: str = "qp") -> tuple[Spec, Policy]:
    """Four places in a ring; in mode `p` the goal is the third, in mode `q` the fourth; the mode stays."""
    build = Build({"m": modes, "x": "abcd"})
    steps = [build.action(f"x={there}", when=[build.atom(f"x={here}")]) for here, there in ("ab", "bc", "cd", "da")]
    goals = [when(build.atom(f"m={mode}"), build.goal(build.atom(f"x={place}"))) for mode, place in ("pc", "qd")]
    policy: Policy = {(mode, place): frozenset((step.action,)) for mode in range(2) for place, step in enumerate(steps)}
    return build.spec(priority(*goals), bound=bound), policy


def _of_two(spec: Spec, policy: Policy, ranks: dict[Residual, Table], prover: Name) -> tuple[str, str, State | None]:
    answer = verify(certified(spec, policy, ranks), spec, prover=prover, properties=["safe", "goals"])
    refutation = answer.properties[1].refutation
    return answer.properties[1].verdict, answer.certificate.status, refutation.state if refutation else None


@needing_no_rival
def test_every_goal_is_looked_at(prover: Name) -> None:
    """What one goal lacks, or a run that misses it, does not hide that the ranks of another one exceed the bound."""
    spec, policy = going_round(bound=9)
    right = exact_ranks(spec, policy, "any")
    assert _of_two(spec, policy, right, prover) == ("proved", "used", None)
    standing = {**policy, (1, 3): NOTHING, (0, 0): NOTHING}
    ranks = exact_ranks(spec, standing, "any")
    assert _of_two(spec, standing, ranks, prover)[:2] == ("refuted", "incomplete")
    for goal in GOALS:
        assert _of_two(spec, policy, {goal: right[goal]}, prover) == ("proved", "incomplete", None)
        far = {state: 9 * rank for state, rank in right[goal].items()}
        assert _of_two(spec, policy, {goal: far}, prover) == ("proved", "wrong", None)
        far = {state: 9 * rank for state, rank in ranks[goal].items()}
        assert _of_two(spec, standing, {**ranks, goal: far}, prover)[:2] == ("refuted", "wrong")


@needing_no_rival
def test_ranks_of_other_goals_may_exceed_the_bound(prover: Name) -> None:
    """Where another goal is pending, a rank may be as large as it likes; that one is missing elsewhere is no worse."""
    spec, policy = going_round(bound=9)
    right = exact_ranks(spec, policy, "any")
    far = {state: rank if state[0] == 0 else 9 * rank for state, rank in right[GOALS[1]].items()}
    assert _of_two(spec, policy, {**right, GOALS[1]: far}, prover) == ("proved", "used", None)
    del far[0, 0]
    assert _of_two(spec, policy, {**right, GOALS[1]: far}, prover) == ("proved", "incomplete", None)


@pytest.mark.parametrize("prover", JUDGES, indirect=True)
@pytest.mark.parametrize("modes", ["qp", "pq"])
def test_the_first_run_that_fails_is_the_witness(modes: str, prover: Name, monkeypatch: pytest.MonkeyPatch) -> None:
    """That of the goal which is looked at first, not the first state; and it stands, whatever becomes of the rest."""
    spec, policy = going_round(modes=modes)
    standing = {**policy, (1, 0): NOTHING, (0, 0): NOTHING}
    ranks = exact_ranks(spec, standing, "any")
    verdict, status, state = _of_two(spec, standing, ranks, prover)
    assert (verdict, status, state and modes[state[0]]) == ("refuted", "incomplete", "p" if prover == "z3" else "q")

    def tired(*_: object) -> NoReturn:
        raise UndecidedError("ranks are below the bound") if prover == "z3" else BudgetError

    monkeypatch.setattr(RankProof, "first_too_large", tired)
    monkeypatch.setattr(WalkRanks, "claimed_far", tired)
    answer = verify(certified(spec, standing, ranks), spec, prover=prover, properties=["goals"])
    assert (answer.verdict, answer.certificate.status, answer.certificate.reason) == ("refuted", "incomplete", NOT_ALL)
    right = exact_ranks(spec, policy, "any")
    del right[GOALS[0]][modes.index("p"), 3]
    assert verify(certified(spec, policy, right), spec, prover=prover, properties=["goals"]).verdict == "undecided"
