"""A bug in the engine, wherever it is, is caught by every judge; so is a wrong rank beside a right policy."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

import pytest
from msgspec.structs import replace

from tests.checker.standalone import ask
from tests.export.compiler import COQC, Case, Library
from tests.mutants.planted import BUGS, Bug, example
from tumato_symbolic import Realizable, parse, synthesize
from tumato_symbolic.policy import Table, dumps
from tumato_symbolic.semantics import all_states, is_valid, judge
from tumato_symbolic.verify import verify

bugs = pytest.mark.parametrize("bug", BUGS, ids=lambda bug: bug.name.replace(" ", "-"))


def _is_right(bug: Bug) -> bool:
    policy = bug.spoilt()
    assert isinstance(policy.decisions, Table)
    judgement = judge(bug.spec, policy.decisions.rows, "any")
    return judgement.sound_and_complete and judgement.minimal


@bugs
def test_the_bug_spoils_the_policy(bug: Bug) -> None:
    """With the bug the policy is wrong by the explicit meaning; without it, it is right."""
    assert not _is_right(bug)
    assert _is_right(replace(bug, plant=lambda _: None))


@bugs
@pytest.mark.parametrize("prover", ["z3", "walk"])
def test_verify_catches_the_bug(bug: Bug, prover: Literal["z3", "walk"]) -> None:
    """Z3 and the walk refute the policy, with a witness."""
    answer = verify(bug.spoilt(), bug.spec, prover=prover)
    assert answer.verdict == "refuted"
    assert any(result.refutation is not None for result in answer.properties)


@bugs
def test_the_stand_alone_checker_catches_the_bug(bug: Bug, tmp_path: Path) -> None:
    """The stand-alone checker says no, and where."""
    answer = ask(tmp_path, dumps(bug.spoilt()), bug.text)
    assert answer.code == 1
    assert answer.failing


@pytest.mark.skipif(COQC is None, reason="coqc is not installed: the theorem is not compiled here")
def test_the_theorem_catches_the_bugs() -> None:
    """What Coq computes is `true` where nothing is planted, and not of any spoilt policy, so that its theorem fails.

    What such a policy says of a valid state that it leaves undecided is made nothing, for a theorem needs a decision.
    """
    library, cases = Library.shared(), []
    for bug in (*BUGS, *(replace(bug, plant=lambda _: None) for bug in BUGS)):
        policy, spec = bug.spoilt(), bug.spec
        assert isinstance(policy.decisions, Table)
        rows = policy.decisions.rows
        total = {state: rows.get(state, frozenset()) for state in all_states(spec) if is_valid(spec, state)}
        cases.append(Case(spec, total, "any"))
    assert library.checks(cases) == [False] * len(BUGS) + [True] * len(BUGS)
    assert library.compile(cases[0].text).returncode != 0


@pytest.mark.parametrize("prover", ["z3", "walk"])
def test_a_wrong_rank_beside_a_right_policy(prover: Literal["z3", "walk"], tmp_path: Path) -> None:
    """One rank that is too small: the policy is proved, and its certificate is wrong, for every prover."""
    text = example("amr")
    outcome = synthesize(parse(text))
    assert isinstance(outcome, Realizable)
    certificate = outcome.policy.certificate
    assert certificate is not None
    leaves = tuple(1 if leaf == 2 else 2 if leaf == 1 else leaf for leaf in certificate.ranks.leaves)
    wrong = replace(outcome.policy, certificate=replace(certificate, ranks=replace(certificate.ranks, leaves=leaves)))
    answer = verify(wrong, parse(text), prover=prover)
    assert (answer.verdict, answer.certificate.status) == ("proved", "wrong")
    checked = ask(tmp_path, dumps(wrong), text, "--strict")
    assert (checked.code, checked.failing) == (1, {})
    assert json.loads(dumps(wrong))["SpecificationDigest"] == outcome.policy.digest
