"""What `verify` is asked, whose ordering counts, and what it does when it cannot tell."""

from typing import Any

import pytest
import z3
from msgspec.structs import replace

from tests.semantics.build import Build, chosen, constraint, priority, when
from tests.verify.policies import certified, exact_ranks
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.limits import Context, Limits
from tumato_symbolic.policy import Policy, as_diagram, policy_from_rows
from tumato_symbolic.semantics import State, all_states
from tumato_symbolic.spec import FALSE, And, Executing, Iff, Not, Ordering, Spec
from tumato_symbolic.verify import PROPERTIES, ProverName, decisions, verify


def _ring(length: int = 4, bound: int | None = None) -> tuple[Spec, dict[State, frozenset[int]]]:
    """One variable that goes round; the goal is its first value."""
    letters = "abcdefgh"[:length]
    build = Build({"x": letters})
    steps = [
        build.action(f"x={after}", when=[build.atom(f"x={letter}")])
        for letter, after in zip(letters, letters[1:] + letters[0], strict=True)
    ]
    spec = build.spec(goals=constraint(build.goal(build.atom("x=a"))), bound=bound)
    return spec, {(number,): chosen(step) for number, step in enumerate(steps)}


def _restoring(*durations: int) -> tuple[Build, Spec]:
    """One unsafe state `b`; every action leads out of it and has one of these durations."""
    build = Build({"x": "ab"})
    for duration in durations:
        build.action("x=a", duration=duration)
    return build, build.spec(state_rules=[Not(build.atom("x=b"))])


@pytest.mark.parametrize(
    ("argument", "recorded", "written", "expected"),
    [
        ("first", "any", "any", ("first", "command line")),
        ("first", "first", None, ("first", "command line")),
        ("any", "first", None, ("any", "command line")),
        (None, "any", "first", ("first", "specification")),
        (None, "first", "first", ("first", "specification")),
        (None, None, "first", ("first", "specification")),
        (None, "any", "any", ("any", "specification")),
        (None, "any", None, ("any", "default")),
        (None, None, None, ("any", "default")),
    ],
)
def test_whose_ordering_counts(
    argument: Ordering | None, recorded: Ordering | None, written: Ordering | None, expected: tuple[str, str]
) -> None:
    """The argument, else what the specification writes, else `any`; what the policy records does not count."""
    spec, rows = _ring()
    spec = replace(spec, effect_ordering=written)
    answer = verify(policy_from_rows(spec, rows, recorded), spec, ordering=argument)
    assert (answer.ordering, answer.ordering_source) == expected
    assert answer.verdict == "proved"


@pytest.mark.parametrize("prover", ["auto", "z3", "walk", "explicit", "both"])
@pytest.mark.parametrize("written", ["any", None])
def test_a_policy_for_first_where_any_is_meant(written: Ordering | None, prover: ProverName) -> None:
    """Recording `first` where the specification means `any` is refuted, unless the argument says what to judge by."""
    spec, rows = _ring()
    spec = replace(spec, effect_ordering=written)
    policy = policy_from_rows(spec, rows, "first")
    answer = verify(policy, spec, prover=prover)
    assert (answer.verdict, answer.ordering) == ("refuted", "any")
    refutation = answer.properties[0].refutation
    assert (answer.properties[0].name, refutation and refutation.kind) == ("ordering", "ordering")
    assert [result.verdict for result in answer.properties[1:]] == ["proved"] * 4
    assert verify(policy, spec, ordering="first", prover=prover).verdict == "proved"
    assert verify(policy, spec, ordering="any", prover=prover).verdict == "proved"


def _late_effects(ordering: Ordering | None) -> tuple[Spec, dict[State, frozenset[int]]]:
    """Two actions, each of which may break nothing alone; one after the other, they do."""
    build = Build({"x": "ab", "y": "ab"})
    p, q = build.action(alternatives=["x=b"]), build.action(alternatives=["y=b"])
    apart = Not(And((build.atom("x=b"), build.atom("y=b"))))
    spec = replace(build.spec(assumptions=[apart]), effect_ordering=ordering)
    return spec, {(0, 0): chosen(p, q), (0, 1): chosen(), (1, 0): chosen()}


@pytest.mark.parametrize("prover", ["auto", "z3", "walk", "explicit", "both"])
def test_a_policy_does_not_choose_a_weaker_meaning(prover: ProverName) -> None:
    """Silence means `any`: a policy that is safe under `first` alone is refuted for that as well."""
    spec, rows = _late_effects(None)
    policy = policy_from_rows(spec, rows, "first")
    verdicts = {result.name: result.verdict for result in verify(policy, spec, prover=prover).properties}
    assert (verdicts["ordering"], verdicts["safe"]) == ("refuted", "refuted")
    assert verify(policy, spec, ordering="first", prover=prover).verdict == "proved"
    assert verify(policy, replace(spec, effect_ordering="first"), prover=prover).verdict == "proved"


@pytest.mark.parametrize("prover", ["auto", "z3", "walk", "explicit", "both"])
def test_any_is_the_weaker_meaning_of_minimal(prover: ProverName) -> None:
    """Under `first` more sets are allowed, and one of them may be cheaper: recording `any` does not rule it out."""
    build = Build({"x": "abc", "y": "ab"})
    one, other = build.action("x=a", duration=1), build.action("x=a", alternatives=["x=c y=b"], duration=1)
    slow = build.action("x=a y=a", duration=5)
    crossed = And((build.atom("x=a"), build.atom("y=b")))
    spec = build.spec(state_rules=[Not(build.atom("x=b")), Not(crossed)], reaction_rules=[Iff(one, other)])
    unsafe = {build.state(text) for text in ("ba", "bb", "ab")}
    rows = {state: chosen(slow) if state in unsafe else chosen() for state in all_states(spec)}
    policy = policy_from_rows(spec, rows, "any")
    assert verify(policy, spec, prover=prover).verdict == "proved"
    answer = verify(policy, replace(spec, effect_ordering="first"), prover=prover)
    assert [result.verdict for result in answer.properties] == ["proved", "proved", "proved", "refuted"]
    refutation = answer.properties[-1].refutation
    assert refutation is not None
    assert refutation.cheaper == chosen(one, other)


def test_only_what_is_asked_is_answered() -> None:
    """`properties` restricts the answer; the order is fixed; unknown names are an error of the caller."""
    spec, rows = _ring()
    policy = policy_from_rows(spec, {**rows, (1,): frozenset()})
    assert verify(policy, spec, properties=["safe", "total"]).verdict == "proved"
    answer = verify(policy, spec, properties=["goals", "total"])
    assert [(result.name, result.verdict) for result in answer.properties] == [
        ("total", "proved"),
        ("goals", "refuted"),
    ]
    with pytest.raises(ValueError, match="alive"):
        verify(policy, spec, properties=["alive"])


def test_no_valid_state_is_an_error_of_the_specification() -> None:
    """An empty `V` is never a proof."""
    build = Build({"x": "ab"})
    spec = build.spec(assumptions=[FALSE])
    with pytest.raises(UserError, match="TUM312"):
        verify(policy_from_rows(spec, {}), spec)


@pytest.mark.parametrize(("bound", "verdict"), [(2, "refuted"), (3, "proved"), (None, "proved")])
def test_the_plan_bound(bound: int | None, verdict: str) -> None:
    """A run of exactly `L` steps is long enough, one more is not."""
    spec, rows = _ring(4, bound)
    rows = {**rows, (0,): frozenset()}
    for policy in (policy_from_rows(spec, rows), certified(spec, rows, exact_ranks(spec, rows, "any"))):
        answer = verify(policy, spec)
        assert answer.verdict == verdict
        refutation = answer.properties[2].refutation
        assert refutation is None or (refutation.run is not None and refutation.run.end == "bound")


def test_the_goal_is_reached_after_at_least_one_step() -> None:
    """A state that satisfies its goal must come back to it: leaving it for good is refuted."""
    build = Build({"x": "ab"})
    leave = build.action("x=b")
    spec = build.spec(goals=constraint(build.goal(build.atom("x=a"))))
    answer = verify(policy_from_rows(spec, {(0,): chosen(leave), (1,): frozenset()}), spec)
    refutation = answer.properties[2].refutation
    assert refutation is not None
    assert refutation.state == (0,)


def test_executing_in_goals_is_settled_by_the_first_set() -> None:
    """A body that asks for an action holds or fails with the first decision, not with later ones."""
    build = Build({"x": "ab"})
    act = build.action("x=b")
    spec = build.spec(goals=priority(when(build.atom("x=a"), build.goal(Executing(act.action)))))
    assert verify(policy_from_rows(spec, {(0,): chosen(act), (1,): frozenset()}), spec).verdict == "proved"
    assert verify(policy_from_rows(spec, {(0,): frozenset(), (1,): chosen(act)}), spec).verdict == "refuted"


@pytest.mark.parametrize("large", [10**6 + 1, 2**31 + 1, 10**30 + 1])
def test_durations_are_exact(large: int) -> None:
    """A difference of one decides, however long the actions take; durations of zero count as zero."""
    build, spec = _restoring(large, large - 1, 0)
    rows = {build.state("a"): frozenset[int]()}
    for decision, cheaper in (({0}, {2}), ({1}, {2}), ({2}, None)):
        answer = verify(policy_from_rows(spec, {**rows, build.state("b"): frozenset(decision)}), spec)
        refutation = answer.properties[3].refutation
        assert (refutation and refutation.cheaper) == (cheaper and frozenset(cheaper))
    spec = replace(spec, actions=spec.actions[:2])
    answer = verify(policy_from_rows(spec, {**rows, build.state("b"): frozenset({0})}), spec)
    assert answer.verdict == "refuted"
    answer = verify(policy_from_rows(spec, {**rows, build.state("b"): frozenset({1})}), spec)
    assert answer.verdict == "proved"


def test_no_time_is_undecided() -> None:
    """What is not proved in time is undecided with a reason, never proved."""
    spec, rows = _ring()
    answer = verify(policy_from_rows(spec, rows), spec, timeout=0.0, prover="z3")
    assert answer.verdict == "undecided"
    assert all(result.verdict != "proved" or result.name == "total" for result in answer.properties)
    assert all(result.reason for result in answer.properties if result.verdict == "undecided")


def test_too_many_states_without_ranks_are_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """For Z3, a policy that is too large to follow needs a certificate; with one, it is proved."""
    monkeypatch.setattr(decisions, "LARGEST_TABLE", 3)
    spec, rows = _ring()
    answer = verify(policy_from_rows(spec, rows), spec, properties=["goals"], prover="z3")
    assert answer.verdict == "undecided"
    assert "certificate" in str(answer.properties[0].reason)
    right = certified(spec, rows, exact_ranks(spec, rows, "any"))
    assert verify(right, spec, prover="z3").verdict == "proved"
    assert verify(policy_from_rows(spec, rows), spec, properties=["goals"], prover="walk").verdict == "proved"


def test_certificates_of_others_are_set_aside() -> None:
    """No digest or another one is stale; the right one with unknown goals or false ranks is wrong: same verdict."""
    spec, rows = _ring()
    ranks = exact_ranks(spec, rows, "any")
    right = certified(spec, rows, ranks)
    (goal,) = ranks
    low = certified(spec, rows, {goal: {**ranks[goal], (1,): 1}})
    assert right.certificate is not None
    (ranked,) = right.certificate.goals
    stranger = replace(right.certificate, goals=(replace(ranked, bodies=("nonsense",)),))
    cases: list[tuple[Policy, Any]] = [
        (right, "used"),
        (replace(right, digest=None), "stale"),
        (replace(right, digest="0" * 64), "stale"),
        (low, "wrong"),
        (replace(right, certificate=stranger), "wrong"),
        (replace(right, certificate=None, certificate_problem="it is broken"), "wrong"),
        (certified(spec, rows, {}), "incomplete"),
    ]
    for policy, status in cases:
        answer = verify(policy, spec)
        assert (answer.verdict, answer.certificate.status) == ("proved", status)
        assert (answer.certificate.reason is None) == (status == "used")


def test_progress_names_what_is_proved() -> None:
    """The caller hears of every property."""
    spec, rows = _ring()
    told: list[str] = []
    verify(policy_from_rows(spec, rows), spec, context=Context(progress=told.append))
    proofs = [f"proving {name}" for name in PROPERTIES if name != "restoring"]
    assert told == ["looking for a valid state", *proofs, "counting the valid states"]


def test_a_limit_leaves_what_is_proved_by_then() -> None:
    """A limit that is met during the second property leaves the verdict on the first, and says so of the others."""
    spec, rows = _ring()

    class Expiring(Context):
        """Ends when `safe` is to be proved."""

        def tell(self, stage: str) -> None:
            super().tell(stage)
            if stage == "proving safe":
                self.deadline = 0.0

    answer = verify(policy_from_rows(spec, rows), spec, context=Expiring(Limits(seconds=1000.0)))
    assert [each.verdict for each in answer.properties] == ["proved", "undecided", "undecided", "undecided"]
    assert answer.verdict == "undecided"
    assert {each.reason for each in answer.properties[1:]} == {"the time limit of 1000 s was met while proving safe"}


def test_a_diagram_is_judged_like_its_table() -> None:
    """A state that is missing from a diagram is named, and valid states are counted."""
    spec, rows = _ring()
    policy = policy_from_rows(spec, rows)
    whole = verify(replace(policy, decisions=as_diagram(policy)), spec)
    assert (whole.verdict, whole.valid_states) == ("proved", 4)
    del rows[(2,)]
    part = policy_from_rows(spec, rows)
    refutation = verify(replace(part, decisions=as_diagram(part)), spec).properties[0].refutation
    assert refutation is not None
    assert (refutation.kind, refutation.state) == ("missing", (2,))


def test_ctrl_c_stops_the_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    """Z3 takes the signal and answers unknown; that is an interrupt, not an undecided obligation."""
    monkeypatch.setattr(z3.Solver, "check", lambda _: z3.unknown)
    monkeypatch.setattr(z3.Solver, "reason_unknown", lambda _: "interrupted from keyboard")
    spec, rows = _ring()
    with pytest.raises(KeyboardInterrupt):
        verify(policy_from_rows(spec, rows), spec)
