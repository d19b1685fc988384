"""Certificates of unrealizability, part by part, on specifications made by hand."""

from collections.abc import Sequence
from random import Random
from typing import Any

import pytest
from msgspec.structs import replace

from tests.oracle import World
from tests.policy.mutations import mutations
from tests.semantics.build import Build, priority, rules, when
from tests.unrealizability import (
    assert_never_wrong,
    certified,
    changed,
    unrealizable,
)
from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.policy.unrealizability import (
    Conflict,
    Cube,
    Cut,
    NoAllowedSet,
    NoPlan,
    Violation,
    bind,
    dumps,
    loads,
)
from tumato_symbolic.semantics import allowed
from tumato_symbolic.spec import And, Formula, Not, Or, Spec
from tumato_symbolic.verify import verify_unrealizable


def conflicting() -> Spec:
    """Two sides that pass through one place, each to the other's goal; unbounded, and with the bound."""
    build = Build({"x": "lmrLR"})
    for here, there in ("lm", "rm", "mL", "mR", "LL", "RR"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    goals = priority(
        when(build.atom("x=l"), build.goal(build.atom("x=R"))),
        when(build.atom("x=r"), build.goal(build.atom("x=L"))),
    )
    return build.spec(goals)


def self_conflicting() -> Spec:
    """A run that would have to pass one state twice and decide differently."""
    build = Build({"x": "stg"})
    start, goal = build.atom("x=s"), build.atom("x=g")
    away = build.action("x=t", when=[start])
    build.action("x=s", when=[build.atom("x=t")])
    build.action("x=g", when=[start])
    return build.spec(priority(when(start, build.goal(And((away, goal))))))


def line(bound: int | None = None) -> Spec:
    """Four places in a row, one step at a time; the goal is the last one."""
    build = Build({"x": "abcd"})
    for here, there in ("ab", "bc", "cd"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    return build.spec(priority(build.goal(build.atom("x=d"))), bound=bound)


def stuck(actions: int = 3, reaction_rules: Sequence[Formula] = ()) -> tuple[Build, Spec]:
    """Nothing is allowed in the only unsafe state: the first action breaks a rule, the others do not leave it."""
    build = Build({"x": "abc", "y": "ab"}, ["arm"])
    build.action("x=b", when=[build.atom("x=a")], needs=["arm"])
    for _ in range(actions - 1):
        build.action("y=b", ["x=c"], needs=["arm"] if actions < 4 else [])
    rules: list[Formula] = [Not(build.atom("x=a")), Or((Not(build.atom("x=b")), build.atom("y=b")))]
    return build, build.spec(state_rules=rules, reaction_rules=reaction_rules)


@pytest.mark.parametrize("spec", [conflicting(), replace(conflicting(), max_plan_length=3), self_conflicting()])
def test_conflicts_by_hand(spec: Spec) -> None:
    """Both kinds of cut, with and without a plan bound; every change of one part is judged by what is true."""
    certificate, _ = unrealizable(spec, Conflict)
    assert verify_unrealizable(certificate, spec).verdict == "proved"
    world = World(spec, "any")
    for seed in range(40):
        assert_never_wrong(world, changed(certificate, Random(seed)))


def test_every_part_of_a_conflict_is_needed() -> None:
    """Without an option, with a distance too large, without a cut, or with another start, the proof fails there."""
    spec = conflicting()
    certificate, reason = unrealizable(spec, Conflict)

    def refuted(**parts: Any) -> str:
        verdict = verify_unrealizable(replace(certificate, reason=replace(reason, **parts)), spec)
        assert verdict.verdict == "refuted"
        return str(verdict.reason)

    for place, choice in enumerate(reason.choices):
        fewer = replace(choice, options=choice.options[1:])
        assert "which is no option there" in refuted(
            choices=(*reason.choices[:place], fewer, *reason.choices[place + 1 :])
        )
    leaves = reason.distances.leaves
    larger = tuple(None if leaf is None else leaf + 1 for leaf in leaves)
    assert "its distance is not 0" in refuted(distances=replace(reason.distances, leaves=larger))
    jump = tuple(leaf if leaf is None or leaf == 0 else leaf + 5 for leaf in leaves)
    assert "nearer by more than one step" in refuted(distances=replace(reason.distances, leaves=jump))
    for place in range(len(reason.cuts)):
        assert "respects all cuts" in refuted(cuts=(*reason.cuts[:place], *reason.cuts[place + 1 :]))
    assert "not among the starts" in refuted(starts=reason.starts[1:])
    first = reason.cuts[0]
    reachable = Cut("path", first.goal, first.states[:1], reason.choices[first.states[0]].options[0][0])
    assert "from where the goal may be reached" in refuted(cuts=(reachable, *reason.cuts[1:]))


@pytest.mark.parametrize(("bound", "layers"), [(2, 2), (1, 1)])
def test_layers_end_at_the_bound(bound: int, layers: int) -> None:
    """As many layers as the bound allows are a proof, one less is none, and neither is one with a state less."""
    spec = line(bound)
    certificate, reason = unrealizable(spec, NoPlan)
    goal = reason.goals[0]
    assert len(goal.roots) == layers
    assert verify_unrealizable(certificate, spec).verdict == "proved"
    empty = replace(goal, roots=(*goal.roots[:-1], 0))
    verdict = verify_unrealizable(replace(certificate, reason=replace(reason, goals=(empty,))), spec)
    assert verdict.verdict == "refuted"
    assert verdict.state in [(0,), (1,)]
    assert verdict.chosen is not None
    assert allowed(spec, verdict.state, verdict.chosen, "any")
    longer = verify_unrealizable(certificate, line(3))
    assert (longer.verdict, longer.stale) == ("refuted", True)


def test_a_run_that_meets_the_goal_is_found() -> None:
    """A layer with a state that meets the goal is named with the state."""
    spec = line(2)
    certificate, reason = unrealizable(spec, NoPlan)
    everything = replace(reason.goals[0], roots=(1, 1))
    verdict = verify_unrealizable(replace(certificate, reason=replace(reason, goals=(everything,))), spec)
    assert "the state x=d of layer 1 meets" in str(verdict.reason)
    nothing = replace(certificate, reason=replace(reason, goals=()))
    assert "which is not listed" in str(verify_unrealizable(nothing, spec).reason)


BAD = [
    (Violation("precondition", (0,)), "all preconditions hold"),
    (Violation("precondition", (1,)), "names no action"),
    (Violation("resource", (0, 1)), "names no two actions"),
    (Violation("nominal-conflict", (0, 1)), "names no two actions"),
    (Violation("reaction-rule", rule="executing nobody"), "no such rule"),
    (Violation("unsafe"), "names no effects"),
    (Violation("unsafe", outcome=((1, ((1, 1),)),)), "names no effects"),
    (Violation("unsafe", outcome=((0, ((0, 1),)), (0, ((0, 1),)))), "takes effect twice"),
    (Violation("unsafe", outcome=((0, ((0, 2),)),)), "does not have the effect"),
    (Violation("idle"), "execute an action"),
    (Violation("nominal-unsafe"), "leaves actions open"),
]


@pytest.mark.parametrize(("violation", "why"), BAD, ids=[f"{bad.kind}: {why}" for bad, why in BAD])
def test_violations_are_checked_by_their_meaning(violation: Violation, why: str) -> None:
    """A cube whose violation is none refutes the certificate, with the reason."""
    _, spec = stuck()
    certificate, reason = unrealizable(spec, NoAllowedSet)
    assert verify_unrealizable(certificate, spec).verdict == "proved"
    cubes = reason.cubes
    assert cubes is not None
    place = next(n for n, cube in enumerate(cubes) if cube.executed == {0} and len(cube.idle) < 2)
    wrong = (*cubes[:place], replace(cubes[place], violation=violation), *cubes[place + 1 :])
    verdict = verify_unrealizable(replace(certificate, reason=replace(reason, cubes=wrong)), spec)
    assert verdict.verdict == "refuted"
    assert why in str(verdict.reason)


def test_cubes_must_hold_every_set_once() -> None:
    """A cube too few, one too many, and one that contradicts itself are told apart."""
    _, spec = stuck()
    certificate, reason = unrealizable(spec, NoAllowedSet)
    cubes = reason.cubes
    assert cubes is not None

    def why(*changed: Cube) -> str:
        verdict = verify_unrealizable(replace(certificate, reason=replace(reason, cubes=changed)), spec)
        assert verdict.verdict == "refuted"
        return str(verdict.reason)

    assert "of 8 sets" in why(*cubes[1:])
    assert "have sets in common" in why(*cubes, cubes[0])
    assert "leaves idle" in why(*cubes, Cube(frozenset((0,)), frozenset((0,)), cubes[0].violation))


def test_many_actions_are_left_to_the_prover() -> None:
    """Where there are too many cubes, Z3 proves that no set is allowed, and refutes it with a set that is."""
    build = Build({"x": "ab", "y": "ab", "z": "ab"})
    for _ in range(12):
        build.action("y=b", ["z=b"])
        build.action("z=b", ["y=b"])
    bad, loud = build.atom("x=a"), And((build.atom("y=b"), build.atom("z=b")))
    spec = build.spec(state_rules=[Not(bad), Not(loud)])
    certificate = replace(unrealizable(spec, NoAllowedSet)[0], reason=NoAllowedSet(build.state("aaa"), None))
    assert verify_unrealizable(certificate, spec).verdict == "proved"
    fine = replace(certificate, reason=NoAllowedSet(build.state("baa"), None))
    verdict = verify_unrealizable(fine, spec)
    assert (verdict.verdict, verdict.state) == ("refuted", build.state("baa"))


def test_an_open_action_may_keep_a_reaction_rule() -> None:
    """A reaction rule must be false for every choice of the open actions, also where that takes a proof."""
    build, _ = stuck()
    build = Build({"x": "ab"})
    first, second = build.action("x=b"), build.action("x=b")
    never = And((Or((first, second)), Or((first, Not(second))), Or((Not(first), second)), Not(And((first, second)))))
    spec = build.spec(state_rules=[Not(build.atom("x=a"))], reaction_rules=[never])
    certificate, reason = unrealizable(spec, NoAllowedSet)
    assert reason.cubes is not None
    rule = next(cube.violation.rule for cube in reason.cubes if cube.violation.rule)
    whole = NoAllowedSet(reason.state, (Cube(frozenset(), frozenset(), Violation("reaction-rule", rule=rule)),))
    assert verify_unrealizable(replace(certificate, reason=whole), spec).verdict == "proved"
    easier = replace(spec, reaction_rules=(replace(spec.reaction_rules[0], formula=Or((first, second))),))
    assert verify_unrealizable(replace(certificate, reason=whole), easier).verdict == "refuted"


def test_a_state_that_is_not_valid_proves_nothing() -> None:
    """Certificates about states outside the assumptions are refuted, whatever their kind."""
    spec = line(1)
    excluded = replace(spec, assumptions=rules(Not(Build({"x": "abcd"}).atom("x=a"))))
    certificate, no_plan = unrealizable(spec, NoPlan)
    for reason in (no_plan, NoAllowedSet((0,), None)):
        assert reason.state == (0,)
        verdict = verify_unrealizable(replace(certificate, reason=reason), excluded)
        assert (verdict.verdict, verdict.stale) == ("refuted", True)
        assert "not valid" in str(verdict.reason)
    conflict, _ = unrealizable(conflicting(), Conflict)
    left = Not(Build({"x": "lmrLR"}).atom("x=l"))
    verdict = verify_unrealizable(conflict, replace(conflicting(), assumptions=rules(left)))
    assert "not valid" in str(verdict.reason)


def test_the_ordering_that_counts() -> None:
    """The certificate's ordering, unless another is asked for; `any` proves nothing where `first` is written."""
    spec = line(1)
    certificate, _ = unrealizable(spec, NoPlan)
    assert verify_unrealizable(certificate, spec).ordering_source == "certificate"
    writes_first = replace(spec, effect_ordering="first")
    verdict = verify_unrealizable(certificate, writes_first)
    assert verdict.verdict == "refuted"
    assert "writes first" in str(verdict.reason)
    asked = verify_unrealizable(certificate, writes_first, ordering="first")
    assert (asked.verdict, asked.ordering, asked.ordering_source) == ("proved", "first", "command line")
    first = replace(certificate, ordering="first")
    assert verify_unrealizable(first, replace(spec, effect_ordering="any")).verdict == "proved"


@pytest.mark.parametrize("spec", [line(1), conflicting()])
def test_time_that_runs_out_is_no_verdict(spec: Spec) -> None:
    """What is not proved in time is undecided, with the claim that is open."""
    certificate = certified(spec, "any")
    assert certificate is not None
    verdict = verify_unrealizable(certificate, spec, timeout=0.0)
    assert verdict.verdict == "undecided"
    assert verdict.reason


def test_names_that_do_not_fit_are_an_error() -> None:
    """A certificate about another vocabulary is unreadable for this specification, not refuted."""
    with pytest.raises(UserError, match="TUM503"):
        verify_unrealizable(unrealizable(line(1), NoPlan)[0], stuck()[1])


@pytest.mark.parametrize("spec", [stuck()[1], line(2), conflicting()])
def test_broken_files_end_in_a_verdict_or_a_coded_error(spec: Spec) -> None:
    """However a file is broken, it is refused, or judged: nothing false is proved, and nothing crashes."""
    whole = certified(spec, "any")
    assert whole is not None
    text = dumps(whole)
    world = World(spec, "any")
    verdicts = set()
    for seed in range(150):
        try:
            certificate = bind(loads(mutations(text, seed).decode(errors="replace")), spec)
        except UserError:
            continue
        verdicts.add(assert_never_wrong(world, certificate))
    assert "refuted" in verdicts
