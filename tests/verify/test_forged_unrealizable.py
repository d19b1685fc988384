"""Forged certificates of unrealizability: each is proved exactly where every claim of it holds, state by state."""

from __future__ import annotations

from random import Random

import pytest
from msgspec.structs import replace

from tests.semantics import literal
from tests.semantics.build import Build, constraint, priority, when
from tests.unrealizability import certified
from tests.verify.forgeries import cuts, forged, violations
from tests.verify.literal_unrealizable import Meaning, distance, is_proof, violated
from tests.verify.literal_unrealizable import clause as literal_clause
from tests.verify.test_unrealizable_by_hand import conflicting, line, self_conflicting, stuck
from tumato_symbolic.limits import Budget
from tumato_symbolic.policy.unrealizability import Conflict, Cut, NoAllowedSet, NoPlan, Unrealizability, bind
from tumato_symbolic.spec import And, Executing, Formula, Iff, Not, Or, Ordering, Spec, canonical_text
from tumato_symbolic.verify import verify_unrealizable
from tumato_symbolic.verify.unrealizability import no_plan
from tumato_symbolic.verify.unrealizability.allowed_step import AllowedStep
from tumato_symbolic.verify.unrealizability.conflict import clause
from tumato_symbolic.verify.unrealizability.distances import Distances
from tumato_symbolic.verify.unrealizability.false_claim import FalseClaimError
from tumato_symbolic.verify.unrealizability.no_allowed_set import _unproved


def crossing(bound: int | None = None) -> Spec:
    """Two ways of three places cross in one, each to its own end; what the first step says is part of one goal."""
    build = Build({"x": "lmrLRk", "y": "ab"})
    steps = {
        pair: build.action(f"x={pair[1]}", when=[build.atom(f"x={pair[0]}")])
        for pair in ("lm", "rm", "mk", "kL", "kR", "LL", "RR")
    }
    left = And((build.atom("x=R"), Or((steps["lm"], build.atom("y=b")))))
    goals = priority(
        when(build.atom("x=l"), build.goal(left)),
        when(build.atom("x=r"), build.goal(build.atom("x=L"))),
        when(build.atom("x=m"), constraint(build.goal(Or((build.atom("x=L"), build.atom("x=R")))))),
    )
    return build.spec(goals, bound=bound)


def proofs() -> dict[str, tuple[Spec, Unrealizability]]:
    """Right certificates with cuts of both kinds, with and without a bound, by name."""
    specs = {
        "conflicting": conflicting(),
        "conflicting, 3": replace(conflicting(), max_plan_length=3),
        "conflicting, 2": replace(conflicting(), max_plan_length=2),
        "self": self_conflicting(),
        "crossing": crossing(),
        "crossing, 4": crossing(4),
    }
    found = {}
    for name, spec in specs.items():
        certificate = certified(spec, "any")
        assert certificate is not None
        found[name] = spec, certificate
    return found


PROOFS = proofs()
CONFLICTS = {name: proof for name, proof in PROOFS.items() if isinstance(proof[1].reason, Conflict)}


def test_there_are_conflicts_of_both_kinds() -> None:
    """Paths and loops, bounded and not, goals that share a root, and all of them proofs."""
    reasons = [(spec, each.reason) for spec, each in PROOFS.values() if isinstance(each.reason, Conflict)]
    kinds = {(cut.kind, spec.max_plan_length) for spec, reason in reasons for cut in reason.cuts}
    assert {kind for kind, _ in kinds} == {"path", "loop"}
    assert len(CONFLICTS) >= 4
    for spec, certificate in PROOFS.values():
        assert is_proof(Meaning(spec, "any"), bind(certificate, spec))
        assert verify_unrealizable(certificate, spec).verdict == "proved"


@pytest.mark.parametrize("name", CONFLICTS)
def test_the_clause_of_every_cut(name: str) -> None:
    """Which options a cut leaves, and whether it is one: at the turn, at the end, with the goal on the path."""
    spec, certificate = CONFLICTS[name]
    reason = bind(certificate, spec).reason
    assert isinstance(reason, Conflict)
    met = {"cut": 0, "none": 0}
    for bound in {spec.max_plan_length, None, 1, 2, 3, 5}:
        bounded = replace(spec, max_plan_length=bound)
        distances = Distances(reason.distances, bound)
        for number, cut in enumerate(cuts(reason, literal.states(spec))):
            wanted = literal_clause(bounded, reason, cut)
            try:
                found = clause(reason, distances, cut, number, bounded)
            except FalseClaimError:
                assert wanted is None
                met["none"] += 1
            else:
                assert set(found) == wanted
                met["cut"] += 1
    assert all(met.values())


def test_distances_are_cut_off_at_the_bound() -> None:
    """Null and what is beyond the bound is the bound; near enough is what the steps and the distance leave room for."""
    spec, certificate = CONFLICTS["conflicting"]
    reason = bind(certificate, spec).reason
    assert isinstance(reason, Conflict)
    for bound in (None, 1, 2, 3, 4):
        bounded = replace(spec, max_plan_length=bound)
        distances = Distances(reason.distances, bound)
        for goal in reason.goals:
            for state in literal.states(spec):
                far = distance(bounded, reason, goal.root, state)
                assert distances.of(goal.root, state) == far
                for steps in range(1, 6):
                    near = far < float("inf") if bound is None else steps + far <= bound
                    assert distances.near(goal.root, state, steps) == near
    negative = replace(reason.distances, leaves=(-1, *reason.distances.leaves[1:]))
    with pytest.raises(FalseClaimError, match="negative"):
        Distances(negative, None)


def _judged(spec: Spec, certificate: Unrealizability, count: int) -> tuple[int, int]:
    """How many are proofs of how many, sampled; each is judged as it should be, and told why not."""
    everything = list(forged(certificate, literal.states(spec)))
    meanings = {each: Meaning(spec, each) for each in ("any", "first")}
    chosen = [certificate, *Random(len(everything)).sample(everything, min(count, len(everything)))]
    right = 0
    for each in chosen:
        answer = verify_unrealizable(each, spec, ordering=each.ordering)
        wanted = is_proof(meanings[each.ordering], bind(each, spec))
        assert (answer.verdict == "proved") == wanted, (each.reason, answer.reason)
        assert answer.verdict in ("proved", "refuted")
        if answer.state is not None and answer.chosen is not None:
            assert answer.chosen in literal.allowed(spec, answer.state, each.ordering)
        right += wanted
    return right, len(chosen)


@pytest.mark.parametrize("name", CONFLICTS)
def test_forged_conflicts(name: str) -> None:
    """Options, distances, starts, cuts and shared roots, each changed by one."""
    spec, certificate = CONFLICTS[name]
    right, judged = _judged(spec, certificate, 24)
    assert 0 < right < judged


def test_two_goals_with_one_root_are_one() -> None:
    """Where two goals get one root, the distance is that to both, and an option may have either."""
    spec, certificate = CONFLICTS["conflicting"]
    reason = certificate.reason
    assert isinstance(reason, Conflict)
    merged = [
        replace(certificate, reason=replace(reason, goals=tuple(replace(goal, root=root) for goal in reason.goals)))
        for root in sorted({goal.root for goal in reason.goals})
    ]
    zero = replace(reason.distances, leaves=tuple(0 for _ in reason.distances.leaves), nodes=())
    nowhere = replace(
        reason, distances=replace(zero, leaves=(0,)), goals=tuple(replace(g, root=0) for g in reason.goals)
    )
    merged.append(replace(certificate, reason=nowhere))
    for each in merged:
        assert verify_unrealizable(each, spec).verdict == "refuted"
        assert not is_proof(Meaning(spec, "any"), bind(each, spec))


@pytest.mark.parametrize("walk", [False, True], ids=["Z3", "walk"])
@pytest.mark.parametrize("bound", [1, 2, None])
def test_forged_layers(bound: int | None, walk: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Layers one too few or too many, one state more or less: proved exactly where they hold all runs."""
    if walk:
        monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    spec = line(bound)
    if bound is None:
        spec = replace(spec, actions=spec.actions[:2])
    certificate = certified(spec, "any")
    assert certificate is not None and isinstance(certificate.reason, NoPlan)
    right, judged = _judged(spec, certificate, 24)
    assert 0 < right < judged


def test_layers_that_fit_a_nearer_bound() -> None:
    """As many layers as the bound are enough; the same layers prove nothing where the bound is one more."""
    certificate = certified(line(2), "any")
    assert certificate is not None
    for bound, verdict in ((1, "proved"), (2, "proved"), (3, "refuted"), (None, "refuted")):
        assert verify_unrealizable(certificate, line(bound)).verdict == verdict
        assert is_proof(Meaning(line(bound), "any"), bind(certificate, line(bound))) == (verdict == "proved")


def knotted() -> Spec:
    """Nothing is allowed in the only unsafe state, for as many reasons as there are."""
    build = Build({"x": "abc", "y": "ab"}, ["arm"])
    one = build.action("x=b", ["x=c"], needs=["arm"])
    two = build.action("y=b", ["x=c", "x=b"], needs=["arm"])
    three = build.action("x=c", when=[build.atom("y=b")])
    four = build.action("x=b y=b", ["x=c"])
    rules: list[Formula] = [Iff(And((four, Not(one))), Or((two, three))), Or((Not(four), two, And((one, Not(three)))))]
    return build.spec(
        state_rules=[Not(build.atom("x=a")), Not(And((build.atom("x=c"), build.atom("y=b"))))], reaction_rules=rules
    )


@pytest.mark.parametrize("ordering", ["any", "first"])
@pytest.mark.parametrize("number", [0, 1, 2])
def test_forged_cubes(number: int, ordering: Ordering) -> None:
    """Cubes that overlap, leave sets out, or name a condition that is met: none is a proof, and what is right is."""
    spec = [stuck()[1], stuck(3, [Not(Iff(*_two(stuck()[0])))])[1], knotted()][number]
    certificate = certified(spec, ordering)
    assert certificate is not None and isinstance(certificate.reason, NoAllowedSet)
    right, judged = _judged(spec, certificate, 60)
    assert 0 < right < judged


def _two(build: Build) -> tuple[Executing, Executing]:
    assert build.atom("x=a")
    return Executing(0), Executing(1)


def forced() -> Spec:
    """In every state two actions are forced, of which one may take effect after the other, and then it is too much."""
    build = Build({"x": "ab", "y": "ab"})
    one, two = build.action("x=b"), build.action("", ["y=b"])
    return build.spec(state_rules=[Not(And((build.atom("x=b"), build.atom("y=b"))))], reaction_rules=[one, two])


def test_two_effects_count_under_any_alone() -> None:
    """Nothing is allowed under `any`, where both effects happen; the same certificate is no proof under `first`."""
    certificate = certified(forced(), "any")
    assert certificate is not None and isinstance(certificate.reason, NoAllowedSet)
    assert max(len(cube.violation.outcome) for cube in certificate.reason.cubes or ()) == 2
    assert verify_unrealizable(certificate, forced()).verdict == "proved"
    assert verify_unrealizable(certificate, forced(), ordering="first").verdict == "refuted"
    assert certified(forced(), "first") is None or literal.allowed(forced(), certificate.reason.state, "first")


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_every_violation_of_every_cube(ordering: Ordering) -> None:
    """A condition that a cube names is violated by all its sets, or is none: all conditions, of each cube."""
    for spec in (stuck()[1], stuck(3, [Not(Iff(*_two(stuck()[0])))])[1], knotted(), forced()):
        certificate = certified(spec, "any")
        assert certificate is not None and isinstance(certificate.reason, NoAllowedSet)
        reason, meaning = certificate.reason, Meaning(spec, ordering)
        step = AllowedStep(spec, ordering, Budget())
        rules = [canonical_text(spec, rule.formula) for rule in spec.reaction_rules]
        for cube in reason.cubes or ():
            for violation in (cube.violation, *violations(cube.violation, len(spec.actions), rules)):
                each = replace(cube, violation=violation)
                given = _unproved(step, spec, reason.state, each, ordering)
                assert (given is None) == violated(meaning, reason.state, each), (each, given)


def test_a_cut_without_an_end_is_none() -> None:
    """A path has an end; where it is missing the certificate is refuted, not misread."""
    spec, certificate = CONFLICTS["conflicting"]
    reason = certificate.reason
    assert isinstance(reason, Conflict)
    endless = Cut("path", reason.cuts[0].goal, reason.cuts[0].states, None)
    answer = verify_unrealizable(replace(certificate, reason=replace(reason, cuts=(endless, *reason.cuts[1:]))), spec)
    assert (answer.verdict, "has no end" in (answer.reason or "")) == ("refuted", True)


@pytest.mark.parametrize("walk", [False, True], ids=["Z3", "walk"])
def test_claims_are_counted(walk: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every claim that was checked, once, and who was needed: Z3, or the walk too.

    No plan: the state, its goals, and for the one goal its first layer, that no layer meets it, and what follows. A
    conflict: choices and cuts, evaluated; for both goals 0 where they hold, and how they fall; options; no choice.
    """
    if walk:
        monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    certificate = certified(line(2), "any")
    assert certificate is not None
    answer = verify_unrealizable(certificate, line(2))
    assert (answer.obligations, answer.by_solver, answer.by_diagrams) == (5, True, walk)
    spec, conflict = CONFLICTS["conflicting"]
    reason = conflict.reason
    assert isinstance(reason, Conflict)
    answer = verify_unrealizable(conflict, spec)
    checked = 2 * len(reason.choices) + len(reason.cuts) + 2 * len({goal.root for goal in reason.goals}) + 1
    assert (answer.obligations, answer.by_solver, answer.by_diagrams) == (checked, True, False)
    cubes = certified(stuck()[1], "any")
    assert cubes is not None and isinstance(cubes.reason, NoAllowedSet) and cubes.reason.cubes is not None
    answer = verify_unrealizable(cubes, stuck()[1])
    assert (answer.obligations, answer.by_solver, answer.by_diagrams) == (3 + len(cubes.reason.cubes), False, False)
