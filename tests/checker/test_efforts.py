"""Certificates of policies that restore safety in several steps: what the checker says of true and false claims."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from random import Random

import pytest

from tests.checker.standalone import Answer, ask
from tests.checker.stepwise import MODES, Claims, Rows, claiming, losers, policies, true_claims, ways
from tests.printing import print_spec
from tumato_symbolic import Realizable, synthesize
from tumato_symbolic.policy import dumps
from tumato_symbolic.semantics import (
    ActionSet,
    State,
    duration,
    follow,
    is_safe,
    judge,
    nominal_agrees,
    restored,
    successor,
)
from tumato_symbolic.semantics.step import next_states
from tumato_symbolic.spec import Ordering, Restoration, Spec
from tumato_symbolic.verify import verify

pytestmark = pytest.mark.usefixtures("read_once")

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


def status(answer: Answer) -> str:
    """What is said of the certificate."""
    found = re.search(r"^certificate: (\w+)", answer.out, re.MULTILINE)
    assert found is not None
    return found.group(1).lower()


def served(spec: Spec, seed: int, ordering: Ordering) -> Iterator[Rows]:
    """Sound and complete policies."""
    for rows in policies(spec, ordering, Random(seed), 0, 12):
        if judge(spec, rows, ordering).sound_and_complete:
            yield rows


@pytest.mark.parametrize(("restoration", "tiers"), MODES)
def test_true_claims_are_right_and_others_are_wrong(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """Right is what is true and complete, whatever it says where it claims nothing."""
    met = Counter[str]()
    for seed in range(100, 140):
        spec, random = ways(seed, restoration, tiers), Random(seed)
        text = print_spec(spec, random)
        for ordering in ORDERINGS:
            for rows in served(spec, seed, ordering):
                truth, minimal = true_claims(spec, rows, ordering), judge(spec, rows, ordering).minimal
                for claims in (truth, *(changed(spec, rows, truth, random) for _ in range(3))):
                    policy = dumps(claiming(spec, rows, claims, ordering))
                    answer = ask(tmp_path, policy, text, "--effect-ordering", ordering, "--strict")
                    wanted = judged(spec, rows, claims, truth, ordering)
                    assert status(answer) == wanted, (seed, rows, claims, truth, answer)
                    assert answer.code == int(not minimal or wanted == "wrong")
                    met[wanted] += 1
        if min(met["right"], met["wrong"]) >= 5:
            break
    assert min(met["right"], met["wrong"]) >= 5, met


def judged(spec: Spec, rows: Rows, claims: Claims, truth: Claims, ordering: Ordering) -> str:
    """What docs/certificate.md says of claims of which the ranks are true, about a policy that restores safety."""
    unsafe = [state for state in rows if not is_safe(spec, state)]
    worst = {state: effort for state, effort in claims.worst.items() if not is_safe(spec, state)}
    read = claims.nominal.items() if spec.restoration == "fair" else ()
    nominal = {state: effort for state, effort in read if state in unsafe and state not in worst}
    for state, effort in (*worst.items(), *nominal.items()):
        step, after = (duration(spec, rows[state]), 1), successor(spec, state, rows[state])
        about = next_states(spec, state, rows[state], ordering) if state in worst else {after} - worst.keys()
        efforts = [(worst if state in worst else nominal).get(t) for t in about if not restored(spec, state, t)]
        if any(each is None or effort < (step[0] + each[0], step[1] + each[1]) for each in [(0, 0), *efforts]):
            return "wrong"
    for state, better, missed in claims.deviations:
        if is_safe(spec, state) or not nominal_agrees(spec, better):
            return "wrong"
        spoiled = follow(spec, {**rows, state: better}, state, better).end != "goal"
        if not (spoiled if missed == state else missed in losers(spec, rows, state, better)):
            return "wrong"
    exact = all(
        (worst.get(state), nominal.get(state)) == (truth.worst.get(state), truth.nominal.get(state))
        for state in unsafe
        if spec.restoration == "fair" or state in truth.worst
    )
    listed = {(state, better) for state, better, _ in claims.deviations}
    needed = {(state, better) for state, better, _ in truth.deviations}
    return "right" if exact and needed <= listed else "incomplete"


def changed(spec: Spec, rows: Rows, truth: Claims, random: Random) -> Claims:
    """One effort, anywhere, or one deviation changed, dropped or added."""
    claims = deepcopy(truth)
    state = random.choice(list(rows))
    other: State = random.choice(list(rows))
    table = random.choice((claims.worst, claims.worst, claims.nominal))
    match random.randrange(6):
        case 0:
            table.pop(state, None)
        case 1:
            time, steps = table.get(state, (1, 1))
            table[state] = random.choice(((time + 1, steps), (max(0, time - 1), steps), (time, steps + 1), (time, 0)))
        case 2:
            table[state] = random.choice((*claims.worst.values(), (1, 1)))
        case 3 if claims.deviations:
            claims.deviations.pop()
        case 4 if claims.deviations:
            here, better, _ = claims.deviations[0]
            claims.deviations[0] = (here, better, other)
        case _:
            chosen: ActionSet = frozenset(random.sample(range(len(spec.actions)), random.randint(0, 1)))
            claims.deviations.append((state, chosen, other))
    return claims


@pytest.mark.parametrize(("restoration", "tiers"), MODES)
def test_no_certificate_changes_a_verdict(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """Of policies right and wrong, the same is said with true claims, with false ones, and with none."""
    for seed in range(200, 202):
        spec, random = ways(seed, restoration, tiers), Random(seed)
        text = print_spec(spec, random)
        for rows in policies(spec, "any", random, 2):
            truth = true_claims(spec, rows, "any")
            forms = [claiming(spec, rows, claims, "any") for claims in (truth, changed(spec, rows, truth, random))]
            answers = [ask(tmp_path, dumps(form), text, "--effect-ordering", "any") for form in forms]
            assert len({(answer.code, answer.out.partition("certificate")[0]) for answer in answers}) == 1
            if all(nominal_agrees(spec, chosen) for chosen in rows.values()) and spec.max_plan_length is None:
                assert status(answers[0]) in ("right", "incomplete"), answers[0]


@pytest.mark.parametrize(("restoration", "tiers"), MODES)
def test_the_package_says_the_same(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """Of the policy and of its certificate, by explicit-state checking."""
    met = Counter[str]()
    for seed in range(300, 330):
        spec, random = ways(seed, restoration, tiers), Random(seed)
        text = print_spec(spec, random)
        for rows in served(spec, seed, "any"):
            truth = true_claims(spec, rows, "any")
            for claims in (truth, *(changed(spec, rows, truth, random) for _ in range(3))):
                policy = claiming(spec, rows, claims, "any")
                answer, found = ask(tmp_path, dumps(policy), text, "--strict"), verify(policy, spec, prover="explicit")
                said = {"used": "right"}.get(found.certificate.status, found.certificate.status)
                refuted = {each.name for each in found.properties if each.verdict == "refuted"}
                assert set(answer.failing) == refuted, (seed, answer)
                assert status(answer) == said or refuted, (seed, claims, found.certificate, answer)
                met[said] += 1
        if sum(met.values()) >= 24:
            break
    assert {"right", "wrong"} <= met.keys(), met


@pytest.mark.parametrize(("restoration", "tiers"), MODES)
def test_what_is_synthesized_is_right(restoration: Restoration, tiers: int, tmp_path: Path) -> None:
    """Policies of `synthesize` pass with their certificates."""
    passed = 0
    for seed in range(400, 460):
        spec = ways(seed, restoration, tiers)
        for ordering in ORDERINGS:
            outcome = synthesize(spec, ordering=ordering)
            if isinstance(outcome, Realizable):
                text = print_spec(spec, Random(seed))
                answer = ask(tmp_path, dumps(outcome.policy), text, "--effect-ordering", ordering, "--strict")
                assert (answer.code, status(answer)) == (0, "right"), (seed, ordering, answer)
                passed += 1
        if passed >= 8:
            break
    assert passed >= 8
