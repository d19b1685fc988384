"""What is said of a certificate of unrealizability beside its verdict, and states and goals that it leaves out."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from tests.semantics.build import Build, priority, when
from tests.unrealizability import certified, unrealizable
from tests.verify.test_unrealizable_by_hand import conflicting, line, self_conflicting, stuck
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.limits import Context
from tumato_symbolic.policy.unrealizability import (
    Conflict,
    Cube,
    NoAllowedSet,
    NoPlan,
    Unrealizability,
    Violation,
    ViolationKind,
)
from tumato_symbolic.semantics import allowed
from tumato_symbolic.spec import And, Not, Or, Spec
from tumato_symbolic.verify import UnrealizabilityVerdict, verify_unrealizable
from tumato_symbolic.verify.by_diagrams.functions import BudgetError
from tumato_symbolic.verify.unrealizability import no_plan

# conflict: states and cuts; for each class of goals, 0 at the goal and no drop; options of each state; no choice
# no plan: the state; no other goal; first layer, no goal met, next layers
# no allowed set: the state, the disjoint cubes, the cover, and each cube; or the state and what Z3 is asked
COUNTED = [
    (conflicting(), 3 + 3 + 2 * 3 + 3 + 1, True),
    (self_conflicting(), 2 + 2 + 2 * 3 + 2 + 1, True),
    (line(2), 1 + 1 + 3, True),
    (stuck()[1], 3 + 4, False),
]


def certificate_of(spec: Spec) -> Unrealizability:
    """The certificate that there is no policy."""
    found = certified(spec, "any")
    assert found is not None
    return found


@pytest.mark.parametrize(("spec", "count", "by_solver"), COUNTED)
def test_claims_are_counted(spec: Spec, count: int, by_solver: bool) -> None:
    """As many as were checked; a certificate that is refuted or undecided has proved none."""
    certificate = certificate_of(spec)
    found = verify_unrealizable(certificate, spec)
    assert (found.verdict, found.obligations) == ("proved", count)
    assert (found.by_solver, found.by_diagrams) == (by_solver, False)
    if by_solver:
        late = verify_unrealizable(certificate, spec, timeout=0.0)
        assert (late.verdict, late.obligations, late.by_solver) == ("undecided", 0, False)


def test_sets_that_z3_looks_at_are_counted() -> None:
    """The state, and that no set is allowed in it."""
    spec = stuck()[1]
    certificate, reason = unrealizable(spec, NoAllowedSet)
    asked = replace(certificate, reason=replace(reason, cubes=None))
    found = verify_unrealizable(asked, spec)
    assert (found.verdict, found.obligations, found.by_solver) == ("proved", 2, True)


def test_layers_that_the_walk_has_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """One claim of five is the walk's where there are many nodes, with the same answers."""
    spec = line(2)
    certificate = certificate_of(spec)
    monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    found = verify_unrealizable(certificate, spec)
    assert (found.verdict, found.obligations, found.by_solver, found.by_diagrams) == ("proved", 5, True, True)
    longer = verify_unrealizable(certificate, replace(spec, max_plan_length=3))
    assert (longer.verdict, longer.obligations, longer.state) == ("refuted", 0, (2,))
    assert longer.reason is not None
    assert longer.reason.startswith("from layer 2, in x=c, {act2} is allowed, leads to x=d")
    assert longer.reason.endswith("which is not in any layer, and the plan bound is not met")


def test_what_layers_say_of_unsafe_states_means_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """No run comes there: a layer may hold one that meets the goal, and one from where a step leads out."""
    build = Build({"x": "abuv"})
    build.action("x=b", when=[Or((build.atom("x=u"), build.atom("x=v")))])
    goal = Or((build.atom("x=b"), build.atom("x=v")))
    spec = build.spec(
        priority(when(build.atom("x=a"), build.goal(goal))), [Not(build.atom("x=u")), Not(build.atom("x=v"))]
    )
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, NoPlan) and reason.state == (0,)
    builder = DiagramBuilder((0,), (False, True))
    asked = []

    def gives_up(*_: object) -> None:
        asked.append(True)
        raise BudgetError("tired")

    for many, walk in ((1000, None), (-1, None), (-1, gives_up)):
        monkeypatch.setattr(no_plan, "MANY_NODES", many)
        if walk is not None:
            monkeypatch.setattr(no_plan, "first_left", walk)
        for held in ((1, 0, 0, 0), (1, 0, 1, 0), (1, 0, 0, 1), (1, 0, 1, 1)):
            layers = tuple(replace(each, roots=(builder.node(0, held),)) for each in reason.goals)
            forged = replace(certificate, reason=replace(reason, diagram=builder.finish(), goals=layers))
            found = verify_unrealizable(forged, spec)
            assert (found.verdict, found.reason) == ("proved", None), (many, held)
    assert len(asked) == 4, "Z3 was asked after all"


def test_what_distances_say_of_unsafe_states_means_nothing() -> None:
    """One that meets a goal and leads away from it may be as far from it as it likes."""
    build = Build({"x": "lmrLRu"})
    for here, there in ("lm", "rm", "mL", "mR", "ul"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    left, right, unsafe = (build.atom(f"x={place}") for place in "LRu")
    goals = priority(
        when(build.atom("x=l"), build.goal(Or((right, unsafe)))),
        when(build.atom("x=r"), build.goal(Or((left, unsafe)))),
    )
    spec = build.spec(goals, state_rules=[Not(unsafe)])
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, Conflict)
    builder = DiagramBuilder[int | None]((0,), (0, 1, 2, None))
    one, two, never = 1, 2, 3
    roots = {
        "x is R": builder.node(0, (two, one, two, never, 0, never)),
        "x is L": builder.node(0, (two, one, two, 0, never, never)),
    }
    named = [next((root for text, root in roots.items() if text in "".join(goal.bodies)), 0) for goal in reason.goals]
    assert len(set(named)) > 2
    far = replace(
        reason,
        distances=builder.finish(),
        goals=tuple(replace(goal, root=root) for goal, root in zip(reason.goals, named, strict=True)),
    )
    found = verify_unrealizable(replace(certificate, reason=far), spec)
    assert found.verdict == "proved", found


def test_layers_are_named_by_their_numbers() -> None:
    """A state that meets the goal is in the first layer that holds it."""
    spec = line(2)
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, NoPlan)
    builder = DiagramBuilder((0,), (False, True))
    roots = tuple(builder.node(0, held) for held in ((1, 1, 0, 0), (1, 1, 1, 1)))
    forged = replace(reason, diagram=builder.finish(), goals=(replace(reason.goals[0], roots=roots),))
    told = verify_unrealizable(replace(certificate, reason=forged), spec).reason or ""
    assert told == f"the state x=d of layer 2 meets ({spec.bodies[0].text})"


def test_the_first_state_that_leaves_is_named_by_the_walk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where steps lead out of the layers from several states; it has to be one of them."""
    build = Build({"x": "abcdefgh"})
    for here, there in ("ab", "bc", "dc", "ec", "fc"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    spec = build.spec(priority(build.goal(build.atom("x=g"))))
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, NoPlan)
    builder = DiagramBuilder((0,), (False, True))
    monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    for held, first in (((1, 1, 0, 1, 1, 1, 0, 0), 1), ((1, 1, 1, 1, 1, 1, 0, 0), None)):
        layers = replace(reason.goals[0], roots=(builder.node(0, held),))
        forged = replace(reason, state=(0,), diagram=builder.finish(), goals=(layers,))
        found = verify_unrealizable(replace(certificate, reason=forged), spec)
        assert found.state == (None if first is None else (first,))
        with monkeypatch.context() as patched, pytest.raises(RuntimeError, match="against the walk"):
            patched.setattr(no_plan, "first_left", lambda *_: (0,))
            verify_unrealizable(replace(certificate, reason=forged), spec)


def test_a_state_that_the_walk_names_falsely_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """Z3 has to find the step that leads out of the layers; otherwise it is no refutation, and no proof either."""
    spec = line(2)
    monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    monkeypatch.setattr(no_plan, "first_left", lambda *_: (0,))
    with pytest.raises(RuntimeError, match="against the walk"):
        verify_unrealizable(certificate_of(spec), spec)


def test_cubes_come_in_any_order() -> None:
    """A proof backwards is the same proof."""
    spec = stuck()[1]
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, NoAllowedSet) and reason.cubes is not None
    backwards = replace(reason, cubes=reason.cubes[::-1])
    assert verify_unrealizable(replace(certificate, reason=backwards), spec).verdict == "proved"


def test_goals_are_named_in_words() -> None:
    """The goal that is pending: its bodies, the actions that it mentions, or no goal at all."""
    build = Build({"x": "ab"})
    act = build.action("x=a")
    goal = And((build.atom("x=b"), act))
    spec = build.spec(priority(when(build.atom("x=a"), build.goal(goal))))
    certificate = certificate_of(spec)
    reason = certificate.reason
    assert isinstance(reason, NoPlan)
    text = spec.bodies[0].text
    for kept, told in ((0, f"({text}) while executing act0"), (1, f"({text})")):
        some = tuple(each for each in reason.goals if bool(each.executed) == bool(kept))
        found = verify_unrealizable(replace(certificate, reason=replace(reason, goals=some)), spec)
        assert (found.reason or "").endswith(f"and leaves {told} pending, which is not listed")
    nowhere = replace(reason, state=(1,))
    found = verify_unrealizable(replace(certificate, reason=nowhere), spec)
    assert (found.reason or "").endswith("and leaves no goal pending, which is not listed")


def test_what_is_known_before_the_proof() -> None:
    """Whoever ends the proof from outside is told that there is no verdict, of which certificate."""
    spec, context = line(1), Context()
    assert verify_unrealizable(certificate_of(spec), spec, context=context).verdict == "proved"
    known = context.known
    assert isinstance(known, UnrealizabilityVerdict)
    assert (known.verdict, known.kind, known.obligations, known.stale) == ("undecided", "no-plan", 0, False)


def test_the_ordering_that_is_asked_for_counts() -> None:
    """Whoever asks for `any` is answered for `any`, also where the specification writes `first`."""
    spec = replace(line(1), effect_ordering="first")
    found = verify_unrealizable(certificate_of(line(1)), spec, ordering="any")
    assert (found.verdict, found.ordering, found.ordering_source) == ("proved", "any", "command line")


def test_a_violation_names_as_many_actions_as_it_has() -> None:
    """One action whose precondition fails, two that exclude each other: not none, and not one more."""
    build = Build({"x": "ab", "y": "ab"}, ["arm"])
    one = build.action("x=b", when=[build.atom("y=b")], needs=["arm"])
    two = build.action("x=b", when=[build.atom("y=b")], needs=["arm"])
    spec = build.spec(state_rules=[Not(build.atom("x=a"))])
    everything = frozenset((one.action, two.action))
    claims: list[tuple[ViolationKind, tuple[int, ...], bool]] = [
        ("precondition", (0,), True),
        ("precondition", (1,), True),
        ("precondition", (0, 1), False),
        ("precondition", (), False),
        ("resource", (0, 1), True),
        ("resource", (0,), False),
        ("resource", (0, 0), False),
    ]
    for kind, named, fine in claims:
        cubes = (
            Cube(everything, frozenset(), Violation(kind, named)),
            *(Cube(frozenset((a,)), everything - {a}, Violation("precondition", (a,))) for a in range(2)),
            Cube(frozenset(), everything, Violation("idle")),
        )
        reason = NoAllowedSet((0, 0), cubes)
        certificate = replace(certificate_of(spec), reason=reason)
        found = verify_unrealizable(certificate, spec)
        assert (found.verdict == "proved") == fine, (kind, named, found)
    assert not allowed(spec, (0, 0), everything, "any")


def test_a_precondition_that_fails_is_that_of_the_named_action() -> None:
    """Of two actions, one may be executed and the other may not."""
    build = Build({"x": "abc"})
    build.action("x=b", when=[build.atom("x=a")])
    build.action("x=b", when=[build.atom("x=c")])
    build.action("x=b", when=[build.atom("x=a")])
    spec = build.spec(state_rules=[Not(build.atom("x=a")), Not(build.atom("x=b"))])
    certificate = certificate_of(spec)
    everything = frozenset(range(3))
    rest = [
        Cube(frozenset((0, 2)), frozenset((1,)), Violation("unsafe", outcome=((0, ((0, 1),)),))),
        Cube(frozenset((0,)), frozenset((1, 2)), Violation("unsafe", outcome=((0, ((0, 1),)),))),
        Cube(frozenset((2,)), frozenset((0, 1)), Violation("unsafe", outcome=((2, ((0, 1),)),))),
        Cube(frozenset(), everything, Violation("idle")),
    ]
    for action, fine in enumerate((False, True, False)):
        named = Cube(frozenset((1,)), frozenset(), Violation("precondition", (action,)))
        reason = NoAllowedSet((0,), (named, *rest))
        found = verify_unrealizable(replace(certificate, reason=reason), spec)
        assert (found.verdict == "proved") == fine
