"""`--prover`: who proves a policy, and what the report says of it."""

import json

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.semantics import State
from tumato_symbolic.verify import PropertyResult, Refutation
from tumato_symbolic.verify.by_diagrams.prover import WalkProver


@pytest.mark.parametrize(
    ("prover", "proved_by", "told"),
    [("z3", "z3", "by Z3,"), ("walk", "walk", "by the walk,"), ("both", "z3+walk", "by Z3 and the walk,")],
)
def test_the_report_names_the_prover(cli: Cli, prover: str, proved_by: str, told: str) -> None:
    """For a program `proved_by`, for a person the head of the report."""
    ran = cli("verify", "amr.json", "amr.tum", "--prover", prover, "--output-format", "json")
    properties = json.loads(ran.out)["properties"]
    assert (ran.code, {found["proved_by"] for found in properties.values()}) == (0, {proved_by})
    assert told in cli("verify", "amr.json", "amr.tum", "--prover", prover).out


@pytest.mark.parametrize("policy", ["slower.json", "unsafe.json"])
def test_every_prover_refutes(cli: Cli, policy: str) -> None:
    """The same property is refuted in the same state, whoever looks."""
    reports = [
        json.loads(cli("verify", policy, "amr.tum", "--prover", prover, "--output-format", "json").out)
        for prover in ("z3", "walk", "both", "auto")
    ]
    states = [
        {
            name: (found["verdict"], (found["refutation"] or {}).get("state"))
            for name, found in each["properties"].items()
        }
        for each in reports
    ]
    assert states == [states[0]] * 4
    assert reports[0]["verdict"] == "refuted"


def test_synth_proves_by_the_walk(cli: Cli) -> None:
    """`synth` writes a policy that the walk has proved."""
    ran = cli("synth", "amr.tum", "--prover", "walk", "--output-format", "json")
    proof = json.loads(ran.out)["proof"]
    assert (ran.code, {found["proved_by"] for found in proof["properties"].values()}) == (0, {"walk"})


def test_portfolio_that_disagree_exit_as_a_bug(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """A proof against a refutation is no verdict: exit code 70."""
    start: State = (0, 0, 0, 0)
    wrong = PropertyResult("total", "refuted", refutation=Refutation("missing", start))
    monkeypatch.setattr(WalkProver, "prove", lambda *_: wrong)
    assert cli("verify", "amr.json", "amr.tum", "--prover", "both").code == 70


def test_an_open_answer_is_no_verdict(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the walk gives up is undecided: exit code 3."""
    monkeypatch.setattr(WalkProver, "prove", lambda _, name: PropertyResult(name, "undecided", reason="it is tired"))
    ran = cli("verify", "amr.json", "amr.tum", "--prover", "walk")
    assert ran.code == 3
    assert "it is tired" in ran.out
