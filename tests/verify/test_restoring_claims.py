"""Certificates about restoring safety in several steps: right ones are used, wrong ones are found out."""

from collections import Counter
from random import Random

import pytest
from msgspec.structs import replace

from tests.semantics.test_restoration import OVERRIDE
from tests.verify.several_steps import RESTORATIONS, Efforts, Said, certified, detours, exact, near, stepwise_spec
from tests.verify.test_several_steps import PROVERS, judged_by
from tumato_symbolic import parse
from tumato_symbolic.policy import Deviation, Policy
from tumato_symbolic.semantics import ActionSet, State, all_states, allowed_sets, judge
from tumato_symbolic.spec import Restoration, Spec
from tumato_symbolic.verify import ProverName, verify

S, T, X, Y = (0,), (1,), (2,), (3,)
ROWS: dict[State, ActionSet] = {S: frozenset((0,)), T: frozenset((2,)), X: frozenset[int](), Y: frozenset[int]()}
LISTED = [Deviation(T, frozenset((1,)), S)]


def override() -> Spec:
    """The specification, bounded."""
    return replace(parse(OVERRIDE), restoration="bounded")


def override_policy(worst: Efforts | None = None, deviations: list[Deviation] | None = None) -> Policy:
    """The policy with its certificate, or one with other efforts or deviations."""
    spec = override()
    ranks, efforts, nominal, _ = exact(spec, ROWS, "any")
    listed = LISTED if deviations is None else deviations
    return certified(spec, ROWS, (ranks, efforts if worst is None else worst, nominal, listed))


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize(
    ("deviations", "status"),
    [
        (LISTED, "used"),
        ([], "incomplete"),
        ([Deviation(T, frozenset((1,)), T)], "wrong"),
        ([Deviation(T, frozenset((2,)), S)], "wrong"),
        ([Deviation(X, frozenset((1,)), S)], "wrong"),
        ([*LISTED, Deviation(T, frozenset((1,)), X)], "wrong"),
    ],
)
def test_deviations(prover: ProverName, deviations: list[Deviation], status: str) -> None:
    """The better set is proved to take a run its goal whatever is said of it; what is said falsely is found out."""
    spec = override()
    assert judge(spec, ROWS, "any").minimal
    assert exact(spec, ROWS, "any")[-1] == LISTED
    answer = judged_by(spec, ROWS, "any", override_policy(deviations=deviations), prover)
    assert (answer.verdict, answer.certificate.status) == ("proved", status)


@pytest.mark.parametrize("prover", PROVERS)
@pytest.mark.parametrize(
    ("worst", "status"),
    [
        ({S: (3, 2), T: (2, 1)}, "used"),
        ({S: (4, 2), T: (2, 1)}, "incomplete"),
        ({S: (3, 3), T: (2, 1)}, "incomplete"),
        ({S: (4, 3), T: (3, 2)}, "incomplete"),
        ({T: (2, 1)}, "incomplete"),
        ({}, "incomplete"),
        ({S: (2, 2), T: (2, 1)}, "wrong"),
        ({S: (3, 1), T: (2, 1)}, "wrong"),
        ({S: (3, 2), T: (1, 1)}, "wrong"),
        ({S: (3, 2), T: (2, 0)}, "wrong"),
        ({S: (3, 2), T: (3, 1)}, "wrong"),
        ({S: (3, 2)}, "wrong"),
    ],
)
def test_efforts(prover: ProverName, worst: Efforts, status: str) -> None:
    """An effort is at least that of every outcome and the step; more is no mistake, but no proof of *minimal*."""
    answer = judged_by(override(), ROWS, "any", override_policy(worst), prover)
    assert (answer.verdict, answer.certificate.status) == ("proved", status)


@pytest.mark.parametrize("prover", PROVERS)
def test_a_policy_that_takes_a_run_its_goal(prover: ProverName) -> None:
    """The cheap way in the middle, and the dear one where nothing needs it."""
    spec = override()
    rows = {**ROWS, T: frozenset((1,))}
    answer = judged_by(spec, rows, "any", certified(spec, rows, exact(spec, rows, "any")), prover)
    assert answer.verdict == "refuted"
    free = replace(spec, goals=None)
    answer = judged_by(free, ROWS, "any", certified(free, ROWS, exact(free, ROWS, "any")), prover)
    assert [each.name for each in answer.properties if each.verdict == "refuted"] == ["minimal"]


@pytest.mark.parametrize("restoration", RESTORATIONS)
def test_a_certificate_changes_no_verdict(restoration: Restoration) -> None:
    """Right ones are used where safety is restored and every run reaches its goal; wrong ones are set aside.

    `make mutants` tries thousands.
    """
    met: dict[ProverName, set[str]] = {prover: set() for prover in PROVERS}
    for seed in range(6):
        spec, random = stepwise_spec(seed, restoration, 1 + seed % 3), Random(seed)
        if not spec.restores_stepwise:
            continue
        for rows in near(spec, "any", random, count=1):
            judged = judge(spec, rows, "any")
            if judged.not_allowed:
                continue
            said = exact(spec, rows, "any")
            right, wrong = certified(spec, rows, said), certified(spec, rows, changed(said, spec, random))
            for prover in PROVERS:
                answer = judged_by(spec, rows, "any", right, prover, judged=judged)
                assert (answer.certificate.status == "used") == (not judged.goal_missed and not judged.not_restored)
                answer = judged_by(spec, rows, "any", wrong, prover, judged=judged)
                met[prover].add(answer.certificate.status)
    assert all(statuses >= {"wrong", "incomplete"} for statuses in met.values()), met


@pytest.mark.parametrize("restoration", ["bounded", "fair"])
def test_runs_that_need_a_detour(restoration: Restoration) -> None:
    """Better sets that take another run its goal, and such as only seem to."""
    met = Counter[tuple[str, bool]]()
    for seed in range(12):
        spec, random = detours(seed, restoration), Random(seed)
        options = {state: list(allowed_sets(spec, state, "any")) for state in all_states(spec)}
        for number in range(12):
            rows = {state: random.choice(sets[len(sets) > 1 :]) for state, sets in options.items()}
            judged = judge(spec, rows, "any")
            if number and not judged.sound_and_complete:
                continue
            said = exact(spec, rows, "any")
            if number and not said[3]:
                continue
            silent = (*said[:3], list[Deviation]())
            for prover in PROVERS:
                answer = judged_by(spec, rows, "any", certified(spec, rows, said), prover, judged=judged)
                met[answer.verdict, bool(said[3])] += 1
                assert (answer.certificate.status == "used") == (not judged.goal_missed and not judged.not_restored)
                if said[3] and answer.verdict == "proved":
                    answer = judged_by(spec, rows, "any", certified(spec, rows, silent), prover, judged=judged)
                    assert answer.certificate.status == "incomplete"
    assert met["proved", True] > 5, met
    assert len(met) == 4, met


def changed(said: Said, spec: Spec, random: Random) -> Said:
    """One number changed, dropped or added, or a deviation made up."""
    ranks, worst, nominal, deviations = said
    along_runs = bool(nominal) and random.random() < 0.5
    efforts = nominal if along_runs else worst
    state = random.choice(list(efforts)) if efforts else _any_state(spec, random)
    takes, steps = efforts.get(state, (0, 1))
    match random.randrange(5):
        case 0:
            efforts = {**efforts, state: (max(0, takes + random.choice((-1, 1))), steps)}
        case 1:
            efforts = {**efforts, state: (takes, max(0, steps + random.choice((-1, 1))))}
        case 2:
            efforts = {other: effort for other, effort in efforts.items() if other != state}
        case 3:
            efforts = {**efforts, _any_state(spec, random): (1, 1)}
        case _:
            chosen = frozenset((random.randrange(len(spec.actions)),))
            deviations = [*deviations, Deviation(state, chosen, _any_state(spec, random))]
    return (ranks, worst, efforts, deviations) if along_runs else (ranks, efforts, nominal, deviations)


def _any_state(spec: Spec, random: Random) -> State:
    return tuple(random.randrange(len(variable.values)) for variable in spec.variables)


@pytest.mark.parametrize("prover", PROVERS)
def test_a_certificate_for_one_step(prover: ProverName) -> None:
    """It says nothing of unsafe states, whatever its ranks say there, and nothing of how they are left."""
    spec, policy = override(), override_policy()
    assert policy.certificate is not None
    bare = replace(policy, certificate=replace(policy.certificate, restoring=None))
    answer = verify(bare, spec, prover=prover)
    assert (answer.verdict, answer.certificate.status) == ("proved", "incomplete")
    assert answer.certificate.reason == "it does not say how safety is restored in several steps"
