"""The examples and the committed proofs of their policies."""

from pathlib import Path

import pytest

from tests.repo.documents import ROOT
from tests.repo.examples import EXAMPLES, README, proof_path, proof_text, solved, with_table
from tumato_symbolic import Policy, Realizable, verify
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.spec import load

_names = pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)


@_names
def test_an_example_has_no_findings(example: Path) -> None:
    """`check` finds nothing to complain about in an example."""
    assert load(Source(example.name, example.read_text())).diagnostics == ()


@_names
def test_the_committed_policy_is_regenerated_identically(example: Path) -> None:
    """`synth` gives the policy in proofs/, byte for byte; an unrealizable example has none there."""
    committed = proof_path(example)
    assert (committed.read_text() if committed.exists() else None) == proof_text(example)


@_names
def test_the_committed_policy_is_proved(example: Path) -> None:
    """`verify` proves every property of the policy in proofs/."""
    spec, outcome = solved(example)
    if isinstance(outcome, Realizable):
        verification = verify(Policy.load(proof_path(example)), spec)
        assert verification.verdict == "proved"
        assert verification.certificate.status == "used"


def test_no_proof_without_an_example() -> None:
    """Everything in proofs/ belongs to an example."""
    kept = {path.name for path in (ROOT / "proofs").glob("*.json")}
    assert kept <= {proof_path(example).name for example in EXAMPLES}


def test_the_table_of_examples_is_current() -> None:
    """The table in examples/README.md says what `synth` says (`make regenerate` writes it)."""
    assert README.read_text() == with_table(README.read_text())


def test_every_example_is_described() -> None:
    """examples/README.md says of every example what it shows."""
    for example in EXAMPLES:
        assert f"**{example.name}**" in README.read_text()
