"""Certificates of guarantees: the stand-alone checker accepts what is right, and nothing that is one number off."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import jsonschema
import pytest
from msgspec.structs import replace

from tests.checker.standalone import Answer, ask
from tests.generate import random_spec, random_text
from tests.profiles import PROFILES
from tests.repo.documents import ROOT
from tests.repo.examples import solved
from tests.verify.policies import near_policies
from tumato_symbolic import Realizable
from tumato_symbolic.diagrams import DiagramBuilder
from tumato_symbolic.policy import Policy, as_table, dumps, policy_from_rows
from tumato_symbolic.policy.formats.kinds import Names
from tumato_symbolic.policy.guarantees import FILE, CertifiedRanks, GuaranteesCertificate
from tumato_symbolic.policy.guarantees import dumps as written
from tumato_symbolic.policy.records import canonical
from tumato_symbolic.semantics import State, all_states, is_valid, judge
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.verify.guarantees.analyse import guarantees

Document = dict[str, Any]


def _judged(folder: Path, policy: Policy, text: str, certificate: str, *options: str) -> Answer:
    (folder / "guarantees.json").write_text(certificate)
    return ask(folder, dumps(policy), text, "--guarantees", str(folder / "guarantees.json"), *options)


def _certificate(policy: Policy, spec: Spec, ordering: Ordering = "any") -> GuaranteesCertificate:
    found = guarantees(policy, spec, ordering, certify=True).certificate
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("amr", "16 guaranteed (at most 4 steps), 16 fair"),
        ("coin", "9 guaranteed (at most 2 steps)"),
        ("concurrent", "8 guaranteed (at most 3 steps)"),
        ("grid3", "1 guaranteed (at most 1 step), 8 fair"),
    ],
)
def test_the_examples(name: str, said: str, tmp_path: Path) -> None:
    """The stated numbers, by another judge."""
    path = ROOT / "examples" / f"{name}.tum"
    spec, outcome = solved(path)
    assert isinstance(outcome, Realizable)
    answer = _judged(tmp_path, outcome.policy, path.read_text(), written(_certificate(outcome.policy, spec)))
    assert (answer.code, answer.out.splitlines()[-1]) == (0, f"guarantees hold: {said}")


def _generated(ordering: Ordering, count: int) -> Iterator[tuple[Spec, str, Policy]]:
    for seed in range(count):
        profile = PROFILES[("restoring", "interacting")[seed % 2]]
        spec = random_spec(seed, profile)
        for rows in near_policies(spec, ordering, Random(seed), count=0):
            judged = judge(spec, rows, ordering)
            if judged.sound_and_complete and judged.minimal:
                yield spec, random_text(seed, profile), policy_from_rows(spec, rows, ordering)
                break


def _renumbered(spec: Spec, certificate: GuaranteesCertificate, random: Random) -> GuaranteesCertificate:
    """One number of one goal is another in one valid state."""
    sizes = [len(variable.values) for variable in spec.variables]
    ranks, goals = certificate.ranks.diagram, certificate.ranks.goals
    place = random.randrange(len(goals))
    roots = [*goals[place].surviving, goals[place].forced]
    tables: list[dict[State, int | None]] = [
        {state: ranks.evaluate(root, state) for state in all_states(spec)}
        for goal in goals
        for root in (*goal.surviving, goal.forced)
    ]
    changed = sum(1 + len(goal.surviving) for goal in goals[:place]) + random.randrange(len(roots))
    state = random.choice([state for state in all_states(spec) if is_valid(spec, state)])
    numbers = [None, *range(max(filter(None, ranks.leaves), default=0) + 3)]
    tables[changed][state] = random.choice([each for each in numbers if each != tables[changed][state]])
    builder = DiagramBuilder[int | None](range(len(sizes)), numbers)
    taken = iter([builder.from_table(sizes, table, None) for table in tables])
    renewed = tuple(
        replace(goal, surviving=tuple([next(taken) for _ in goal.surviving]), forced=next(taken)) for goal in goals
    )
    return replace(certificate, ranks=CertifiedRanks(builder.finish(), renewed))


def test_the_schema_describes_them() -> None:
    """What is written is valid, and says what was meant; without one of its keys it is not."""
    spec, outcome = solved(ROOT / "examples" / "amr.tum")
    assert isinstance(outcome, Realizable)
    schema = json.loads((ROOT / "tumato_symbolic" / "policy" / "guarantees.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    certificate = _certificate(outcome.policy, spec)
    document = json.loads(written(certificate))
    assert validator.is_valid(document)
    assert FILE.read(document, "the certificate", Names(certificate.vocabulary)) == replace(
        certificate, ranks=canonical(certificate.ranks)
    )
    del document["Ranks"]["Goals"][0]["Forced"]
    assert not validator.is_valid(document)


@pytest.mark.parametrize("ordering", ["any", "first"])
def test_right_ones_are_accepted_and_no_number_may_be_another(ordering: Ordering, tmp_path: Path) -> None:
    """Ranks are the fixpoints exactly."""
    judged = 0
    for spec, text, policy in _generated(ordering, 16):
        right, random = _certificate(policy, spec, ordering), Random(judged)
        options = ("--effect-ordering", ordering)
        answer = _judged(tmp_path, policy, text, written(right), *options)
        assert answer.code == 0, answer
        for _ in range(4):
            answer = _judged(tmp_path, policy, text, written(_renumbered(spec, right, random)), *options)
            assert (answer.code, "guarantees FAIL: the ranks of" in answer.out) == (1, True), answer
        judged += 1
    assert judged >= 5


def _goal(document: Document) -> Document:
    found: Document = document["Ranks"]["Goals"][0]
    return found


CHANGES: dict[str, Callable[[Document], object]] = {
    "fewer states": lambda d: d["Levels"][0].update(States=15),
    "fewer steps": lambda d: d["Levels"][0].update(Steps=3),
    "more steps": lambda d: d["Levels"][0].update(Steps=5),
    "no steps": lambda d: d["Levels"][0].update(Steps=None),
    "a stronger level": lambda d: d["Levels"][1].update(Level="guaranteed", Steps=7),
    "a weaker level": lambda d: d["Levels"][1].update(Level="nominal"),
    "deviations": lambda d: d["Levels"][1].update(Deviations=1),
    "other cubes": lambda d: d["Levels"][0].update(Cubes=d["Levels"][1]["Cubes"]),
    "too few cubes": lambda d: d["Levels"][0].update(Cubes=[]),
    "too much in a cube": lambda d: d["Levels"][0].update(Cubes=[{}]),
    "a level twice": lambda d: d["Levels"].append(d["Levels"][0]),
    "a level left out": lambda d: d["Levels"].pop(),
    "a goal left out": lambda d: d["Ranks"]["Goals"].pop(),
    "fair ranks for forced ones": lambda d: _goal(d).update(Forced=_goal(d)["Surviving"][0]),
    "forced ranks for fair ones": lambda d: _goal(d).update(Surviving=[_goal(d)["Forced"]]),
    "another ordering": lambda d: d.update(EffectOrdering="first"),
    "another specification": lambda d: d.update(SpecificationDigest="sha256:0"),
}


@pytest.mark.parametrize("change", CHANGES)
def test_false_claims_are_refuted(change: str, tmp_path: Path) -> None:
    """Each claim is judged: what is told of a level, which goals there are, and what it was made for."""
    path = ROOT / "examples" / "amr.tum"
    spec, outcome = solved(path)
    assert isinstance(outcome, Realizable)
    document = json.loads(written(_certificate(outcome.policy, spec)))
    CHANGES[change](document)
    answer = _judged(tmp_path, outcome.policy, path.read_text(), json.dumps(document))
    assert (answer.code, answer.out.splitlines()[-1].startswith("guarantees FAIL: ")) == (1, True), answer


UNREADABLE: dict[str, Callable[[Document], object]] = {
    "another type": lambda d: d.update(Type="policy"),
    "no ranks": lambda d: d.pop("Ranks"),
    "no fixpoint": lambda d: _goal(d).update(Surviving=[]),
    "a goal twice": lambda d: d["Ranks"]["Goals"].append(_goal(d)),
    "an unknown level": lambda d: d["Levels"][0].update(Level="always"),
    "a truth value for a number": lambda d: d["Levels"][0].update(States=True),
    "an unknown variable": lambda d: d["Levels"][0].update(Cubes=[{"S_Colour": []}]),
    "an unknown value": lambda d: d["Levels"][0].update(Cubes=[{"S_Battery": ["flat"]}]),
    "an action of which no goal speaks": lambda d: _goal(d).update(Executed=["charge"]),
}


@pytest.mark.parametrize("change", UNREADABLE)
def test_what_is_no_certificate_is_2(change: str, tmp_path: Path) -> None:
    """Anything doubtful is refused."""
    path = ROOT / "examples" / "amr.tum"
    spec, outcome = solved(path)
    assert isinstance(outcome, Realizable)
    document = json.loads(written(_certificate(outcome.policy, spec)))
    UNREADABLE[change](document)
    answer = _judged(tmp_path, outcome.policy, path.read_text(), json.dumps(document))
    assert (answer.code, "cannot be judged" in answer.err) == (2, True), answer


def test_nothing_is_guaranteed_of_a_policy_that_fails(tmp_path: Path) -> None:
    """The levels build on total, safe and goals."""
    path = ROOT / "examples" / "coin.tum"
    spec, outcome = solved(path)
    assert isinstance(outcome, Realizable)
    right = written(_certificate(outcome.policy, spec))
    table = as_table(outcome.policy, 9)
    assert table is not None
    rows = dict(table.rows)
    rows.popitem()
    answer = _judged(tmp_path, policy_from_rows(spec, rows), path.read_text(), right)
    assert answer.code == 1
    assert "guarantees FAIL: the policy is not total and safe" in answer.out
