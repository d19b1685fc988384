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
from tests.checker.stepwise import Claims, Rows, claiming, policies, rivals, true_claims, ways
from tests.checker.test_stepwise import MODES
from tests.printing import print_spec
from tumato_symbolic.policy import dumps
from tumato_symbolic.semantics import ActionSet, State, is_safe, judge, nominal_agrees
from tumato_symbolic.spec import Ordering, Restoration, Spec

ORDERINGS: tuple[Ordering, ...] = ("any", "first")


def status(answer: Answer) -> str:
    """What is said of the certificate."""
    return re.findall(r"^certificate: (\w+)", answer.out, re.MULTILINE)[0].lower()


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
        if min(met["right"], met["wrong"]) >= 8:
            break
    assert min(met["right"], met["wrong"]) >= 8, met


def judged(spec: Spec, rows: Rows, claims: Claims, truth: Claims, ordering: Ordering) -> str:
    """What docs/certificate.md says of claims of which the ranks are true."""
    unsafe = [state for state in rows if not is_safe(spec, state)]
    fair = spec.restoration == "fair"
    efforts = all(claims.worst.get(state) == truth.worst.get(state) for state in unsafe) and all(
        claims.nominal.get(state) == truth.nominal.get(state) for state in unsafe if fair and state not in truth.worst
    )
    better = rivals(spec, rows, ordering)
    true = all(missed in better.get((state, chosen), ()) for state, chosen, missed in claims.deviations)
    if not (efforts and true):
        return "wrong"
    return "right" if better.keys() == {(state, chosen) for state, chosen, _ in claims.deviations} else "incomplete"


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
    for seed in range(200, 203):
        spec, random = ways(seed, restoration, tiers), Random(seed)
        text = print_spec(spec, random)
        for rows in policies(spec, "any", random, 2):
            truth = true_claims(spec, rows, "any")
            forms = [claiming(spec, rows, claims, "any") for claims in (truth, changed(spec, rows, truth, random))]
            answers = [ask(tmp_path, dumps(form), text, "--effect-ordering", "any") for form in forms]
            assert len({(answer.code, answer.out.partition("certificate")[0]) for answer in answers}) == 1
            if all(nominal_agrees(spec, chosen) for chosen in rows.values()) and spec.max_plan_length is None:
                assert status(answers[0]) in ("right", "incomplete"), answers[0]
