"""*No plan*: any layers that hold the runs and avoid the goal are a proof, whoever made or checks them."""

from functools import lru_cache
from itertools import pairwise
from random import Random

import pytest
from msgspec.structs import replace

from tests.generate import PROFILES
from tests.oracle import World
from tests.semantics.build import Build, constraint, priority
from tests.unrealizability import assert_never_wrong, certified, changed, unrealizable, unrealizable_specs
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.policy.unrealizability import Layers, NoPlan, Unrealizability, dumps, loads
from tumato_symbolic.semantics import Residual, State
from tumato_symbolic.spec import And, Or, Ordering, Spec
from tumato_symbolic.synthesis import unrealizability
from tumato_symbolic.synthesis.certificate import goal_names
from tumato_symbolic.verify import verify_unrealizable
from tumato_symbolic.verify.by_diagrams.functions import BudgetError
from tumato_symbolic.verify.unrealizability import no_plan

ORDERINGS = pytest.mark.parametrize("ordering", ["any", "first"])
TARGETS = tuple(f"t{number}" for number in range(14))
Sets = dict[Residual, list[set[State]]]


@lru_cache(maxsize=1)
def some_certificate(spec: Spec, ordering: Ordering) -> Unrealizability | None:
    """One for a specification of which several tests in a row put another reason into it."""
    return certified(spec, ordering)


def certificate_of(spec: Spec, ordering: Ordering, state: State, sets: Sets) -> Unrealizability:
    """A certificate with these sets of states as layers."""
    certificate, vocabulary = some_certificate(spec, ordering), Vocabulary.of(spec)
    assert certificate is not None
    builder = DiagramBuilder(range(len(vocabulary.sizes)), (False, True))
    goals = [
        Layers(
            *goal_names(spec, goal),
            tuple(builder.from_table(vocabulary.sizes, dict.fromkeys(sorted(layer), True), False) for layer in layers),
        )
        for goal, layers in sets.items()
    ]
    return replace(certificate, reason=NoPlan(state, builder.finish(), tuple(goals)))


def reached(world: World, state: State) -> Sets:
    """What the runs from a state reach first with their first, second, … step, up to the bound."""
    found: Sets = {}
    for goal in dict.fromkeys(option.goal for option in world.options[state]):
        layer = {option.after for option in world.options[state] if option.goal == goal}
        layers, seen = [layer], set(layer)
        while world.spec.max_plan_length is None or len(layers) < world.spec.max_plan_length:
            layer = {option.after for here in layer for option in world.options[here]} - seen
            if not layer:
                break
            layers.append(layer)
            seen |= layer
        found[goal] = layers
    return found


def too_far(world: World, state: State) -> Sets:
    """The safe states that are too far away after every step; without a bound, those from where there is no way."""
    found: Sets = {}
    for goal in dict.fromkeys(option.goal for option in world.options[state]):
        far, last = world.distances(goal), world.spec.max_plan_length or 1
        never = len(world.valid) + 1
        nearest = [last - number for number in range(1, last + 1)] if world.spec.max_plan_length else [never]
        found[goal] = [{s for s in world.safe if far.get(s, never + 1) > least} for least in nearest]
    return found


def without_plan(profile: str, count: int, ordering: Ordering) -> list[tuple[Spec, Unrealizability, State]]:
    """Generated specifications in which a state has no plan, with their certificates and such a state."""
    found = unrealizable_specs(profile, range(count), ordering)
    reasons = [(spec, certificate, certificate.reason) for spec, certificate in found]
    return [(spec, each, reason.state) for spec, each, reason in reasons if isinstance(reason, NoPlan)]


def walk_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the walk check all layers, whatever their size."""
    monkeypatch.setattr(no_plan, "MANY_NODES", -1)


@ORDERINGS
@pytest.mark.parametrize("profile", PROFILES)
def test_several_proofs_by_both_provers(profile: str, ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """What `synth` writes, what the runs reach, and the states that are too far: each is proved by Z3 and the walk."""
    bounds = set()
    for spec, certificate, state in without_plan(profile, 16, ordering):
        world = World(spec, ordering)
        layers = certificate_of(spec, ordering, state, reached(world, state))
        distances = certificate_of(spec, ordering, state, too_far(world, state))
        bounds.add(spec.max_plan_length is None)
        for each in (certificate, layers, distances):
            with monkeypatch.context() as patch:
                by_z3 = verify_unrealizable(loads(dumps(each)), spec, ordering=ordering)
                walk_first(patch)
                walked = verify_unrealizable(loads(dumps(each)), spec, ordering=ordering)
            assert (by_z3.verdict, by_z3.by_solver, by_z3.by_diagrams) == ("proved", True, False)
            assert (walked.verdict, walked.by_diagrams) == ("proved", True)
            assert by_z3.obligations == walked.obligations
    assert bounds == {True, False}


@ORDERINGS
@pytest.mark.parametrize("profile", PROFILES)
def test_the_walk_and_z3_refute_the_same(profile: str, ordering: Ordering, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of changed layers both say the same, and neither proves what is false."""
    met = set()
    for spec, certificate, state in without_plan(profile, 7, ordering):
        world = World(spec, ordering)
        layers = certificate_of(spec, ordering, state, reached(world, state))
        for seed in range(8):
            other = changed((certificate, layers)[seed % 2], Random(seed))
            with monkeypatch.context() as patch:
                by_z3 = assert_never_wrong(world, other)
                walk_first(patch)
                assert assert_never_wrong(world, other) == by_z3
            met.add(by_z3)
    assert met == {"proved", "refuted"}


def dead_end(bound: int | None = None) -> tuple[Build, Spec]:
    """A ring `a`, `b`, `c` where `b` may also step into `d`, from where there is only `e` and back; the goal is `c`."""
    build = Build({"x": "abcde"})
    for here, there in ("ab", "bc", "ca", "bd", "de", "ed"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    return build, build.spec(priority(build.goal(build.atom("x=c"))), bound=bound)


@pytest.mark.parametrize("bound", [None, 7])
def test_one_closed_set_is_enough_where_no_run_is_long_enough(bound: int | None) -> None:
    """Where no run of any length reaches the goal there is one layer, with a bound as without."""
    _, spec = dead_end(bound)
    certificate, reason = unrealizable(spec, NoPlan)
    (goal,) = reason.goals
    assert [reason.diagram.evaluate(goal.roots[0], (x,)) for x in range(5)] == [False] * 3 + [True] * 2
    assert len(goal.roots) == 1
    assert verify_unrealizable(certificate, spec).verdict == "proved"


@pytest.mark.parametrize("walking", [False, True])
def test_a_closed_set_must_be_closed(walking: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A set that a step leaves, lacks a first successor or meets the goal is refuted, with the step or the state."""
    build, spec = dead_end()
    if walking:
        walk_first(monkeypatch)

    def refuted(start: str, *layers: str) -> str:
        sets = [{build.state(letter) for letter in layer} for layer in layers]
        goal = World(spec, "any").options[build.state("d")][0].goal
        verdict = verify_unrealizable(certificate_of(spec, "any", build.state(start), {goal: sets}), spec)
        assert verdict.verdict == "refuted"
        return verdict.reason or ""

    step = "from layer 1, in x=b, {act1} is allowed, leads to x=c, which is not in"
    assert f"{step} any layer, and the plan bound is not met" in refuted("e", "abde")
    assert f"{step} layers 1 to 2" in refuted("a", "ab", "abd", "abde")
    assert "which is not in layer 1" in refuted("d", "d")
    assert "the state x=c of layer 1 meets" in refuted("e", "abcde")


@pytest.mark.parametrize("walking", [False, True])
def test_layers_come_one_after_the_other(walking: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against a plan of three steps, layers that a step skips prove nothing, nor do those that meet the goal."""
    if walking:
        walk_first(monkeypatch)
    build = Build({"x": "abcd"})
    for here, there in ("ab", "bc", "cd"):
        build.action(f"x={there}", when=[build.atom(f"x={here}")])
    goals = priority(build.goal(build.atom("x=d")))
    harder, spec = build.spec(goals, bound=2), build.spec(goals, bound=3)
    goal = World(spec, "any").options[(0,)][0].goal

    def refuted(*layers: str) -> str:
        sets = [{build.state(letter) for letter in layer} for layer in layers]
        verdict = verify_unrealizable(certificate_of(harder, "any", (0,), {goal: sets}), spec)
        assert verdict.verdict == "refuted"
        return verdict.reason or ""

    assert "from layer 1, in x=b, {act1} is allowed, leads to x=c, which is not in layers 1 to 2" in refuted(
        "ab", "ab", "abc"
    )
    assert "the state x=d of layer 3 meets" in refuted("ab", "abc", "abcd")


@pytest.mark.parametrize("walking", [False, True])
def test_what_layers_say_of_unsafe_states_means_nothing(walking: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """A layer may hold an unsafe state from where a step reaches the goal; so the diagram need not tell it apart."""
    if walking:
        walk_first(monkeypatch)
    build = Build({"x": "ab", "y": "ny"})
    build.action("x=b y=n", when=[build.atom("y=y")])
    spec = build.spec(priority(build.goal(build.atom("x=b"))), state_rules=[build.atom("y=n")])
    certificate, reason = unrealizable(spec, NoPlan)
    (goal,) = reason.goals
    assert len(reason.diagram.nodes) == 1
    assert reason.diagram.evaluate(goal.roots[0], build.state("ay"))
    assert verify_unrealizable(certificate, spec).verdict == "proved"


@pytest.mark.parametrize("bound", [None, 2])
@pytest.mark.parametrize("walking", [False, True])
def test_a_state_with_several_residual_goals(bound: int | None, walking: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the first set decides which goal is pending, each goal has its own layers, and all are needed."""
    if walking:
        walk_first(monkeypatch)
    build = Build({"x": "abcd", "y": "abc"})
    left, right = build.action("x=b"), build.action("x=c")
    build.action("y=b")
    wanted = Or((And((left, build.atom("x=d"))), And((right, build.atom("y=c"))), And((build.atom("x=d"),))))
    spec = build.spec(constraint(build.goal(wanted)), bound=bound)
    certificate, reason = unrealizable(spec, NoPlan)
    goals = reason.goals
    assert {goal.executed for goal in goals} >= {("act0",), ("act1",)}
    assert verify_unrealizable(certificate, spec).verdict == "proved"
    for place in range(len(goals)):
        fewer = replace(reason, goals=(*goals[:place], *goals[place + 1 :]))
        verdict = verify_unrealizable(replace(certificate, reason=fewer), spec)
        assert "which is not listed" in (verdict.reason or "")


def targets(count: int, bound: int, stranded: str = "") -> Spec:
    """A robot visits `count` places, each from `a`: two steps for each. `stranded` ones only lead on to the next."""
    places = stranded + "abcdefghijklmno"[: count + 1]
    build = Build({"x": places, **dict.fromkeys(TARGETS[:count], "nd")}, ["body"])
    for n, target in enumerate(TARGETS[:count]):
        place = f"x={chr(98 + n)}"
        build.action(place, when=[build.atom("x=a")], needs=["body"])
        build.action(f"{target}=d x=a", when=[build.atom(place)], needs=["body"])
    for here, there in pairwise(stranded):
        build.action(f"x={there}", when=[build.atom(f"x={here}")], needs=["body"])
    done = tuple(build.atom(f"{target}=d") for target in TARGETS[:count])
    return build.spec(priority(build.goal(And((build.atom("x=a"), *done)))), bound=bound)


def test_layers_that_count_are_left_to_the_walk(monkeypatch: pytest.MonkeyPatch) -> None:
    """A plan that is one step too long among many targets: the walk is asked, and one step more would be a plan."""
    monkeypatch.setattr(no_plan, "MANY_NODES", 100)
    count = 14
    certificate, reason = unrealizable(targets(count, 2 * count - 1), NoPlan)
    assert len(reason.goals[0].roots) == 2 * count - 1
    assert len(reason.diagram.nodes) > no_plan.MANY_NODES
    verdict = verify_unrealizable(certificate, targets(count, 2 * count - 1))
    assert (verdict.verdict, verdict.by_solver, verdict.by_diagrams) == ("proved", True, True)
    longer = verify_unrealizable(certificate, targets(count, 2 * count))
    assert (longer.verdict, longer.stale) == ("refuted", True)
    assert "the plan bound is not met" in (longer.reason or "")


def test_what_the_runs_reach_is_written_where_it_is_smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """From where only three states can be reached, these are enough, whatever the way to the goal is elsewhere."""
    monkeypatch.setattr(unrealizability, "FEW_NODES", 50)
    spec = targets(10, 19, "zyx")
    certificate, reason = unrealizable(spec, NoPlan)
    assert (reason.state, len(reason.goals[0].roots)) == ((0,) * 11, 1)
    monkeypatch.undo()
    other, larger = unrealizable(spec, NoPlan)
    assert len(larger.diagram.nodes) > 20 * len(reason.diagram.nodes)
    for each in (certificate, other):
        assert verify_unrealizable(each, spec).verdict == "proved"


@pytest.mark.parametrize("over", [BudgetError("tired"), RecursionError()])
def test_z3_has_the_last_word(over: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    """The walk is asked where Z3 does not answer soon, and Z3 again where the walk gives up."""
    spec = targets(3, 5)
    certificate, asked = unrealizable(spec, NoPlan)[0], list[bool]()

    def given_up(*_: object) -> None:
        asked.append(True)
        raise over

    monkeypatch.setattr(no_plan, "SOON", -1.0)
    walked = verify_unrealizable(certificate, spec)
    assert (walked.verdict, walked.by_diagrams) == ("proved", True)
    monkeypatch.setattr(no_plan, "first_left", given_up)
    verdict = verify_unrealizable(certificate, spec)
    assert (verdict.verdict, verdict.by_diagrams, asked) == ("proved", False, [True])


def test_a_state_that_only_the_walk_finds_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where Z3 cannot follow the walk, there is no verdict."""
    spec = targets(3, 5)
    walk_first(monkeypatch)
    monkeypatch.setattr(no_plan, "first_left", lambda *_: (0, 0, 0, 0))
    with pytest.raises(RuntimeError, match="against the walk"):
        verify_unrealizable(unrealizable(spec, NoPlan)[0], spec)
