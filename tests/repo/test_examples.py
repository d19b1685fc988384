"""The examples and the committed proofs of their policies."""

from pathlib import Path

import pytest

from tests.repo.documents import ROOT
from tests.repo.examples import (
    EXAMPLES,
    README,
    certificate_path,
    certificate_text,
    proof_path,
    proof_text,
    solved,
    with_table,
)
from tumato_symbolic import Policy, Realizable, verify
from tumato_symbolic.diagnostics import Source
from tumato_symbolic.editor.format import format_text
from tumato_symbolic.policy.unrealizability import load as load_certificate
from tumato_symbolic.spec import load
from tumato_symbolic.verify import verify_unrealizable

_names = pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)


@_names
def test_an_example_has_no_findings(example: Path) -> None:
    """`check` finds nothing to complain about in an example; what is worth knowing is remarked."""
    found = load(Source(example.name, example.read_text())).diagnostics
    assert [each for each in found if each.severity != "remark"] == []


@_names
def test_an_example_is_laid_out_as_format_does_it(example: Path) -> None:
    """`format --check` has nothing to change."""
    source = Source(example.name, example.read_text())
    assert format_text(source) == source.text


@_names
def test_the_committed_policy_is_regenerated_identically(example: Path) -> None:
    """`synth` gives the policy in proofs/, byte for byte, or the certificate there that there is none."""
    for committed, text in (
        (proof_path(example), proof_text(example)),
        (certificate_path(example), certificate_text(example)),
    ):
        assert (committed.read_text() if committed.exists() else None) == text


@_names
def test_the_committed_policy_is_proved(example: Path) -> None:
    """`verify` proves every property of the policy in proofs/, or by the certificate there that there is none."""
    spec, outcome = solved(example)
    if isinstance(outcome, Realizable):
        verification = verify(Policy.load(proof_path(example)), spec)
        assert verification.verdict == "proved"
        assert verification.certificate.status == "used"
    else:
        verdict = verify_unrealizable(load_certificate(str(certificate_path(example))), spec)
        assert (verdict.verdict, verdict.stale) == ("proved", False)


def test_no_proof_without_an_example() -> None:
    """Everything in proofs/ belongs to an example."""
    kept = {path.name for path in (ROOT / "proofs").glob("*.json")}
    assert kept <= {path(example).name for example in EXAMPLES for path in (proof_path, certificate_path)}


def test_the_table_of_examples_is_current() -> None:
    """The table in examples/README.md says what `synth` says (`make regenerate` writes it)."""
    assert README.read_text() == with_table(README.read_text())


def test_every_example_is_described() -> None:
    """examples/README.md says of every example what it shows."""
    for example in EXAMPLES:
        assert f"**{example.name}**" in README.read_text()
