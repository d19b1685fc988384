"""What a report counts and says beside its verdicts: obligations, states, what became of the certificate."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Literal, cast

import pytest
from msgspec.structs import replace

from tests.semantics.build import Build, chosen, constraint, priority, when
from tests.verify.policies import certified, exact_ranks
from tests.verify.test_forged_ranks import along, exact, restoring
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.limits import Budget, Context
from tumato_symbolic.policy import Certificate, Policy, RankedGoal, as_diagram, policy_from_rows
from tumato_symbolic.semantics import ActionSet, Residual, State, all_states, residual_goal
from tumato_symbolic.spec import FALSE, And, Executing, Goal, Iff, Not, Or, Ordering, Spec, canonical_text, digest
from tumato_symbolic.verify import PropertyResult, ProverName, Verification, verify
from tumato_symbolic.verify.by_diagrams.prover import WalkProver
from tumato_symbolic.verify.by_states.prover import StateProver
from tumato_symbolic.verify.by_z3 import rank_terms
from tumato_symbolic.verify.by_z3.policy_problem import PolicyProblem
from tumato_symbolic.verify.by_z3.prover import Z3Prover
from tumato_symbolic.verify.by_z3.rank_source import RankSource
from tumato_symbolic.verify.decisions import Decisions

prove = import_module("tumato_symbolic.verify.prove")
Name = Literal["z3", "walk", "explicit"]
PROVERS: tuple[Name, ...] = ("z3", "walk", "explicit")
GOAL = Residual(frozenset((0,)), frozenset())


@pytest.fixture(params=["at once", "by parts", "walk", "explicit"])
def prover(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Name:
    """Every prover; Z3 in both of its ways."""
    if request.param == "by parts":
        monkeypatch.setattr(rank_terms, "AT_ONCE", -1.0)
    return request.param if request.param in PROVERS else "z3"


def _obligations(answer: Verification) -> list[int]:
    return [result.obligations for result in answer.properties]


COUNTED = {
    # preconditions, agreement (`x` alone is written), what is done in unsafe states, outcomes; goals: that there are no
    # others, and two for each; minimal: one and one for each rank function
    "z3": [1, 4 + 1 + 1 + 1, 1 + 2, 1],
    # preconditions, conflicts, outcomes; goals: one, one for each rank function, and one for each goal
    "walk": [1, 4 + 1 + 1, 1 + 1 + 1, 1],
    # decided states
    "explicit": [5, 5, 5, 0],
}


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize("name", PROVERS)
def test_obligations_are_counted(name: Name, ordering: Ordering) -> None:
    """As many as there were to prove; `first` has one more for Z3 and the walk, that all effects together are safe."""
    spec, policy = along(4)
    spec = replace(spec, variables=(replace(spec.variables[0], values=tuple("abcde")),))
    answer = verify(certified(spec, policy, {GOAL: exact(spec, policy)}), spec, ordering=ordering, prover=name)
    total, safe, goals, minimal = COUNTED[name]
    assert answer.verdict == "proved"
    assert _obligations(answer) == [total, safe + (ordering == "first" and name != "explicit"), goals, minimal]
    without = verify(policy_from_rows(spec, policy), spec, prover=name, properties=["goals"])
    assert _obligations(without) == [goals - (name == "walk")]


def test_only_what_may_fail_is_an_obligation() -> None:
    """A variable that nobody writes, or that one action writes, cannot be given two values; one user shares nothing."""
    build = Build({"x": "ab", "y": "ab", "z": "ab"}, ["arm", "leg"])
    build.action("x=b y=b", needs=["arm"])
    build.action("x=a", needs=["arm", "leg"])
    spec = build.spec()
    everything = {state: frozenset((0, 1)) for state in all_states(spec)}
    for rows, safe in ((dict.fromkeys(everything, frozenset[int]()), 1 + 2), (everything, 0)):
        answer = verify(policy_from_rows(spec, rows), spec, prover="z3", properties=["safe"])
        assert _obligations(answer) == [safe]
    rows = {state: frozenset((state[0],)) for state in everything}
    answer = verify(policy_from_rows(spec, rows), spec, prover="z3", properties=["safe"])
    assert _obligations(answer) == [1 + 1 + 2]


@pytest.mark.parametrize(("name", "count"), [("z3", 2), ("walk", 2), ("explicit", 1)])
def test_obligations_of_minimal(name: Name, count: int) -> None:
    """For the provers, one and one for each goal of a rival; for explicit-state checking, the unsafe states."""
    spec, policy = restoring(2, 2)
    for each in (policy_from_rows(spec, policy), certified(spec, policy, {GOAL: exact(spec, policy)})):
        answer = verify(each, spec, prover=name, properties=["minimal"])
        assert (answer.verdict, _obligations(answer)) == ("proved", [count])


def test_what_is_refuted_counts_nothing() -> None:
    """A refutation has its witness, and no obligations."""
    spec, policy = along(2)
    for name in PROVERS:
        answer = verify(policy_from_rows(spec, {(0,): policy[(0,)]}), spec, prover=name, properties=["total", "goals"])
        assert [(each.verdict, each.obligations) for each in answer.properties] == [("refuted", 0)] * 2


def _partly(rows: Mapping[State, ActionSet], spec: Spec, diagram: bool) -> Policy:
    policy = policy_from_rows(spec, rows)
    return replace(policy, decisions=as_diagram(policy)) if diagram else policy


@pytest.mark.parametrize("diagram", [False, True])
@pytest.mark.parametrize("name", [*PROVERS, "auto", "both"])
def test_states_are_counted(name: ProverName, diagram: bool) -> None:
    """Valid states, and those of them that are decided, whatever is said of states that are not valid."""
    build = Build({"x": "abc", "y": "ab"})
    spec = build.spec(assumptions=[Not(build.atom("x=c"))])
    inside = [(0, 0), (0, 1), (1, 0), (1, 1)]
    for decided in (inside, inside[:3]):
        for outside in ([], [(2, 0)], [(2, 0), (2, 1)]):
            rows: dict[State, ActionSet] = {state: frozenset[int]() for state in (*decided, *outside)}
            answer = verify(_partly(rows, spec, diagram), spec, prover=name)
            whole = decided == inside
            assert answer.verdict == ("proved" if whole else "refuted")
            assert answer.decides_all == whole
            if name in ("z3", "both") and diagram and outside and whole:
                assert answer.valid_states is None, "Z3 does not count what it cannot tell apart"
            else:
                assert (answer.valid_states, answer.decided_states) == (4, len(decided))


@pytest.mark.parametrize("name", [*PROVERS, "auto", "both"])
def test_no_valid_state_is_an_error_for_every_prover(name: ProverName) -> None:
    """An empty `V` is never a proof; a single valid state that is not decided is no error."""
    build = Build({"x": "ab"})
    with pytest.raises(UserError, match="TUM312"):
        verify(policy_from_rows(build.spec(assumptions=[FALSE]), {}), build.spec(assumptions=[FALSE]), prover=name)
    spec = build.spec(assumptions=[build.atom("x=b")])
    assert verify(policy_from_rows(spec, {}), spec, prover=name).verdict == "refuted"


def turning() -> tuple[Spec, dict[State, ActionSet], list[Residual]]:
    """Three places in a round; in each the next one is the goal, and so is the last one where its action started."""
    build = Build({"x": "abc"})
    steps = [build.action(f"x={there}", when=[build.atom(f"x={here}")]) for here, there in ("ab", "bc", "ca")]
    places = [build.atom(f"x={letter}") for letter in "abc"]
    last = Or((places[0], And((Executing(0), places[1]))))
    goals: list[Goal] = [when(places[0], build.goal(last)), when(places[1], build.goal(places[2])), build.goal(last)]
    spec = build.spec(priority(*goals))
    rows: dict[State, ActionSet] = {(number,): chosen(step) for number, step in enumerate(steps)}
    residuals = [
        Residual(frozenset((0,)), frozenset((0,))),
        Residual(frozenset((1,)), frozenset()),
        Residual(frozenset((0,)), frozenset()),
    ]
    return spec, rows, residuals


def test_every_goal_needs_its_ranks(prover: Name) -> None:
    """Where ranks of one of several goals are missing, the certificate is incomplete and says of which."""
    spec, rows, residuals = turning()
    ranks = exact_ranks(spec, rows, "any")
    assert list(ranks) == residuals
    for left_out in range(-1, 3):
        kept = {goal: table for number, (goal, table) in enumerate(ranks.items()) if number != left_out}
        for given in (kept, dict(reversed(kept.items()))):
            answer = verify(certified(spec, rows, given), spec, prover=prover)
            assert answer.verdict == "proved"
            if left_out < 0:
                assert answer.certificate.status == "used"
            else:
                assert answer.certificate.status == "incomplete"
                body = spec.bodies[1 if left_out == 1 else 0].text
                told = "it has no ranks of (" + body + ")" + (" while executing act0" if left_out == 0 else "")
                assert answer.certificate.reason == told


def test_every_goal_is_proved_by_its_ranks(prover: Name) -> None:
    """A run that misses its goal is found beside right ranks of all others, whichever goal it misses."""
    spec, rows, residuals = turning()
    ranks = exact_ranks(spec, rows, "any")
    for bound in (2, 1):
        bounded = replace(spec, max_plan_length=bound)
        expected = [state for state in rows if bound < 1 + ranks[residuals[state[0]]][(state[0] + 1) % 3,]]
        answer = verify(certified(bounded, rows, ranks), bounded, prover=prover, properties=["safe", "goals"])
        refutation = answer.properties[1].refutation
        assert (refutation and refutation.state) == (expected[0] if expected else None)
    waiting = {**rows, (1,): frozenset[int]()}
    answer = verify(certified(spec, waiting, ranks), spec, prover=prover, properties=["safe", "goals"])
    refutation = answer.properties[1].refutation
    assert refutation is not None and refutation.state == (1,)


def test_a_rank_after_a_state_is_missing(prover: Name) -> None:
    """The reason names the state after which there is no rank; ranks that are there do not exceed the bound."""
    for bound in (None, 3, 9):
        spec, policy = along(3, bound)
        table = exact(spec, policy)
        del table[(0,)], table[(1,)]
        answer = verify(certified(spec, policy, {GOAL: table}), spec, prover=prover, properties=["safe", "goals"])
        assert answer.certificate.status == "incomplete"
        assert answer.certificate.reason == f"it has no rank of ({spec.bodies[0].text}) after x is a"


@pytest.mark.parametrize("name", ["z3", "walk"])
def test_ranks_that_a_rival_needs(name: Name) -> None:
    """Minimal takes ranks of the residual goal of a cheaper set; where the certificate has others only, it says so."""
    spec, policy = restoring(2, 2)
    other = Residual(frozenset(), frozenset())
    right, late = exact(spec, policy), dict[State, int]({(2,): 0})
    for given, status in (({GOAL: right}, "used"), ({other: late}, "incomplete"), ({}, "unneeded")):
        answer = verify(certified(spec, policy, given), spec, prover=name, properties=["safe", "minimal"])
        assert (answer.verdict, answer.certificate.status) == ("proved", status)
        if status == "incomplete":
            assert answer.certificate.reason == f"it has no ranks of ({spec.bodies[0].text})"


@pytest.mark.parametrize("parts", [False, True])
def test_a_decision_without_a_successor_needs_no_rank(parts: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nominal effects disagree there is no next state, so its rank is no lower bound of anything."""
    if parts:
        monkeypatch.setattr(rank_terms, "AT_ONCE", -1.0)
    build = Build({"x": "abcdu"})
    bad = build.atom("x=u")
    one, two = build.action("x=b"), build.action("x=c")
    cheap, dear = (build.action(f"x={there}", when=[bad], duration=time) for time, there in ((1, "a"), (2, "d")))
    spec = build.spec(priority(build.goal(build.atom("x=d"))), state_rules=[Not(bad)])
    decided = (chosen(one, two), chosen(), chosen(), chosen(), chosen(dear))
    rows: dict[State, ActionSet] = {(place,): each for place, each in enumerate(decided)}
    assert chosen(cheap) != chosen(dear)
    for name in ("z3", "walk"):
        policy = certified(spec, rows, {GOAL: {(3,): 0}})
        answer = verify(policy, spec, prover=name, properties=["minimal"])
        assert (answer.verdict, answer.certificate.status) == ("proved", "used")


NOT_MENTIONED = "`Executed` has act0, which its goal does not mention"


def test_a_goal_that_is_named_wrongly(prover: Name) -> None:
    """An action that the goal does not mention, a goal that comes twice, a negative rank: wrong, and told so."""
    spec, rows, residuals = turning()
    ranks = exact_ranks(spec, rows, "any")
    right = certified(spec, rows, ranks)
    assert right.certificate is not None
    first, second, third = right.certificate.goals
    mentioned = canonical_text(spec, spec.bodies[0].formula)
    not_mentioned = Residual(residuals[1].bodies, frozenset((0,)))
    cases: list[tuple[tuple[RankedGoal, ...], str]] = [
        ((first, replace(second, executed=("act0",)), third), NOT_MENTIONED),
        ((replace(first, executed=("act0", "act1")), second), NOT_MENTIONED.replace("act0", "act1")),
        ((first, second, third, first), f"it ranks ({spec.bodies[0].text}) while executing act0 twice"),
        ((replace(first, bodies=(mentioned, "x is d")),), "it ranks 'x is d', which is no goal of the specification"),
    ]
    assert not_mentioned not in ranks
    for goals, reason in cases:
        policy = replace(right, certificate=replace(right.certificate, goals=goals))
        answer = verify(policy, spec, prover=prover)
        assert (answer.verdict, answer.certificate.status) == ("proved", "wrong")
        assert answer.certificate.reason == reason
    builder = DiagramBuilder[int | None]((0,), (None, -1))
    negative = Certificate(builder.finish(), (replace(first, root=0),))
    answer = verify(replace(right, certificate=negative), spec, prover=prover)
    assert (answer.certificate.status, answer.certificate.reason) == ("wrong", "it has a negative rank")


def test_the_reasons_why_a_certificate_is_not_used(prover: Name) -> None:
    """Each status has its reason, and a policy that is not safe may be at fault itself."""
    spec, policy = along(3, 3)
    table = exact(spec, policy)
    goal = f"({spec.bodies[0].text})"
    right = certified(spec, policy, {GOAL: table})
    assert right.certificate is not None
    (ranked,) = right.certificate.goals
    nonsense = replace(right, certificate=replace(right.certificate, goals=(replace(ranked, bodies=("x is q",)),)))
    cases = [
        (replace(right, digest=None), "stale", "it was made for no specification in particular"),
        (replace(right, digest="other"), "stale", "it was made for another specification"),
        (replace(nonsense, digest="other"), "stale", "it was made for another specification"),
        (replace(right, certificate=None, certificate_problem="torn"), "wrong", "torn"),
        (replace(right, certificate=None), "absent", None),
        (certified(spec, policy, {GOAL: {**table, (0,): 1}}), "wrong", f"the ranks of {goal} do not decrease to it"),
        (
            certified(spec, policy, {GOAL: {state: 5 * rank for state, rank in table.items()}}),
            "wrong",
            f"its ranks of {goal} exceed the bound",
        ),
    ]
    for each, status, reason in cases:
        answer = verify(each, spec, prover=prover, properties=["safe", "goals"])
        assert (answer.verdict, answer.certificate.status, answer.certificate.reason) == ("proved", status, reason)
    unsafe = {**policy, (0,): policy[(1,)]}
    low = certified(spec, unsafe, {GOAL: {**table, (0,): 1}})
    answer = verify(low, spec, prover=prover, properties=["safe", "goals"])
    assert (answer.properties[0].verdict, answer.certificate.status) == ("refuted", "set aside")
    assert answer.certificate.reason == f"the ranks of {goal} do not decrease to it"


def test_decisions_are_those_for_valid_states() -> None:
    """A mapping from valid states that are decided, as a table and as a diagram, in the order of the states."""
    build = Build({"x": "abc", "y": "ab"})
    action = build.action("x=b")
    spec = build.spec(assumptions=[Not(build.atom("x=c"))])
    rows: dict[State, ActionSet] = {(1, 1): chosen(action), (0, 1): chosen(), (2, 0): chosen(action)}
    for diagram in (False, True):
        decisions = Decisions(spec, _partly(rows, spec, diagram))
        assert list(decisions) == [(0, 1), (1, 1)]
        assert dict(decisions) == {(0, 1): chosen(), (1, 1): chosen(action)}
        assert len(decisions) == 2
        assert (0, 1) in decisions and (2, 0) not in decisions and (0, 0) not in decisions
        assert decisions.get((2, 0)) is None
        assert decisions.followers == {(0, 1): (0, 1), (1, 1): (1, 1)}
        assert decisions.origins == {(0, 1): [(0, 1)], (1, 1): [(1, 1)]}


def test_who_has_pending_goal() -> None:
    """A decision that is allowed does; one that is not does where the policy is known to be safe, for then it is."""
    build = Build({"x": "ab", "y": "ab"})
    fine, wrong = build.action("x=b"), build.action("y=b", when=[build.atom("x=b")])
    spec = build.spec(constraint(build.goal(build.atom("x=b"))))
    policy = policy_from_rows(spec, {(0, 0): chosen(fine), (0, 1): chosen(wrong)})
    problem = PolicyProblem(spec, as_diagram(policy), Budget())
    for known in (False, True):
        source = RankSource(problem, policy, "any", known)
        assert [source.has_pending_goal(state) for state in ((0, 0), (0, 1))] == [True, known]


def test_whoever_is_asked_last_does_not_make_it_a_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where nobody reaches a verdict, there is none, and the last reason of each is told."""
    spec, policy = along(2)
    for number, owner in enumerate((WalkProver, Z3Prover, StateProver)):
        reason = f"tired {number}"
        monkeypatch.setattr(
            owner, "prove", lambda _, name, *__, reason=reason, **___: PropertyResult(name, "undecided", reason=reason)
        )
    answer = verify(policy_from_rows(spec, policy), spec)
    assert [each.verdict for each in answer.properties] == ["undecided"] * 4
    assert {each.reason for each in answer.properties} == {"tired 0; tired 1; tired 2"}
    assert answer.certificate.status == "unneeded"


def test_whether_all_states_are_decided() -> None:
    """Known from the proof of total, or from both numbers; where they were not counted, nothing is known."""
    spec, policy = along(2)
    answer = verify(policy_from_rows(spec, policy), spec, properties=["safe"])
    assert (answer.valid_states, answer.decided_states, answer.decides_all) == (4, 3, False)
    assert replace(answer, decided_states=4).decides_all
    assert not replace(answer, valid_states=None, decided_states=None).decides_all
    assert not replace(answer, decided_states=None).decides_all


def test_states_are_not_counted_where_that_takes_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """One by one only where there are not more of them than are looked at anyway."""
    spec, policy = along(2)
    for most, expected in ((4, 4), (3, None)):
        monkeypatch.setattr(prove, "LARGEST_TABLE", most)
        answer = verify(policy_from_rows(spec, policy), spec, prover="explicit")
        assert (answer.valid_states, answer.decided_states) == (expected, 3)


def test_the_digest_is_that_of_the_specification() -> None:
    """What these certificates are made for."""
    spec, policy = along(2)
    assert certified(spec, policy, {}).digest == digest(spec)


def test_a_run_that_fails_is_found_without_the_ranks_of_its_goal(prover: Name) -> None:
    """A certificate that lacks the ranks of a goal proves nothing of it, though it has right ones of all others."""
    spec, rows, residuals = turning()
    ranks = exact_ranks(spec, rows, "any")
    for place, goal in list(enumerate(residuals))[1:]:
        wrong = {**rows, (place,): frozenset[int]()}
        pending = residual_goal(spec, (place,), frozenset())
        others = {each: table for each, table in ranks.items() if each not in (goal, pending)}
        answer = verify(certified(spec, wrong, others), spec, prover=prover, properties=["safe", "goals"])
        refutation = answer.properties[1].refutation
        assert refutation is not None, place
        assert refutation.state is not None and refutation.run is not None
        assert refutation.run.end == "loop"


@pytest.mark.parametrize("name", [*PROVERS, "auto"])
def test_the_first_of_many_states_has_the_best_set(name: ProverName) -> None:
    """Where cheaper sets serve in several states, it is the first state, as declared, that is named."""
    letters = "abcdefgh"
    build = Build({"x": letters, "y": letters})
    target = build.atom("x=a")
    wherever = {letter: build.atom(f"x={letter}") for letter in letters}
    for first in ("ch", "df", "hb"):
        build._actions.clear()
        dear = build.action("x=a y=a", duration=9)
        here = And((wherever[first[0]], build.atom(f"y={first[1]}")))
        later = And((wherever["h"], build.atom("y=h")))
        lengths = (6, 4, 4, 4, 5)
        cheap = [build.action("x=a y=a", when=[Or((here, later))], duration=each) for each in lengths]
        spec = build.spec(constraint(build.goal(target)), state_rules=[target])
        rows = {state: chosen() if state[0] == 0 else chosen(dear) for state in all_states(spec)}
        answer = verify(policy_from_rows(spec, rows), spec, prover=name, properties=["minimal"])
        refutation = answer.properties[0].refutation
        assert refutation is not None
        assert refutation.state == build.state(first)
        assert refutation.cheaper == chosen(cheap[1])
        assert refutation.decision == chosen(dear)


def test_what_is_learned_after_every_property() -> None:
    """Whoever ends the proof from outside is told what was proved by then, and that the rest is open."""
    spec, policy = along(2)
    known: list[Verification] = []
    context = Context()
    context.learned = lambda found: known.append(cast("Verification", found))
    answer = verify(policy_from_rows(spec, {**policy, (3,): frozenset()}), spec, prover="walk", context=context)
    assert [[each.verdict for each in found.properties] for found in known[:5]] == [
        [each.verdict for each in answer.properties[:done]] + ["undecided"] * (4 - done) for done in range(5)
    ]
    assert [found.verdict for found in known[:4]] == ["undecided", "undecided", "undecided", "refuted"]
    assert [found.certificate.status for found in known[:5]] == ["unneeded"] * 3 + ["absent"] * 2


def test_nothing_asked_is_an_error_of_the_caller() -> None:
    """An answer about no property would be a proof of nothing."""
    spec, policy = along(2)
    with pytest.raises(ValueError, match="properties must be some of"):
        verify(policy_from_rows(spec, policy), spec, properties=[])


@pytest.mark.parametrize("cases", [0, 128])
def test_a_run_ends_where_nominal_effects_disagree(prover: Name, cases: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever one of the two would lead to: there is no next state, and a run that comes there misses its goal."""
    monkeypatch.setattr(import_module("tumato_symbolic.verify.by_diagrams.cases"), "MOST_CASES", cases)
    build = Build({"x": "abcd"})
    first = build.action("x=b", when=[build.atom("x=a")])
    one, two = build.action("x=c"), build.action("x=d")
    for goal in "cd":
        build._bodies.clear()
        spec = build.spec(constraint(build.goal(build.atom(f"x={goal}"))))
        for pair in (chosen(one, two), None):
            rows = {(0,): chosen(first), (1,): pair, (2,): chosen(two), (3,): chosen(one)}
            policy = policy_from_rows(spec, {state: each for state, each in rows.items() if each is not None})
            answer = verify(policy, spec, prover=prover, properties=["goals"])
            refutation = answer.properties[0].refutation
            assert refutation is not None
            assert (refutation.state, refutation.run and refutation.run.end) == ((0,), "undefined")


@pytest.mark.parametrize("name", [*PROVERS, "auto"])
def test_the_best_set_is_that_of_the_state_that_is_named(name: ProverName) -> None:
    """Where it takes two actions, one action that would do in a later state is not mistaken for it."""
    build = Build({"x": "abc", "y": "ab"})
    here, later = build.atom("x=b"), build.atom("x=c")
    one, two = build.action("x=a", when=[here], duration=1), build.action("x=a y=a", when=[here], duration=1)
    build.action("x=a", when=[later], duration=2)
    dear = build.action("x=a", duration=9)
    spec = build.spec(constraint(), [build.atom("x=a")], [Iff(one, two)])
    rows = {state: chosen() if state[0] == 0 else chosen(dear) for state in all_states(spec)}
    answer = verify(policy_from_rows(spec, rows), spec, prover=name, properties=["minimal"])
    refutation = answer.properties[0].refutation
    assert refutation is not None
    assert (refutation.state, refutation.cheaper) == ((1, 0), chosen(one, two))
