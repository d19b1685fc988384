"""`export-proof`: the command line around `tumato_symbolic.export.coq`."""

from __future__ import annotations

from pathlib import Path

from tests.cli.conftest import Cli


def test_the_theorem_goes_where_it_is_asked_for(cli: Cli, tmp_path: Path) -> None:
    """To the standard output, or to a file, with the same text."""
    ran = cli("export-proof", "amr.json", "amr.tum")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.endswith("Print Assumptions policy_is_right.\n")
    filed = cli("export-proof", "amr.json", "amr.tum", "-o", "amr.v")
    assert (filed.code, filed.out) == (0, "")
    assert "amr.v is written" in filed.err
    assert (tmp_path / "amr.v").read_text(encoding="utf-8") == ran.out


def test_the_ordering_is_that_of_the_specification(cli: Cli, tmp_path: Path) -> None:
    """The command line's, else what the specification means, whatever the policy records."""
    policy = (tmp_path / "amr.json").read_text().replace('"EffectOrdering": "any"', '"EffectOrdering": "first"')
    (tmp_path / "first.json").write_text(policy)
    spec = (tmp_path / "amr.tum").read_text()
    (tmp_path / "writes.tum").write_text(spec.replace("BEGIN CONFIG", "BEGIN CONFIG\neffect_ordering: any"))
    (tmp_path / "weaker.tum").write_text(spec.replace("BEGIN CONFIG", "BEGIN CONFIG\neffect_ordering: first"))
    for arguments, wanted in (
        (("first.json", "amr.tum", "--effect-ordering", "any"), "Any"),
        (("first.json", "writes.tum", "--effect-ordering", "first"), "First"),
        (("first.json", "weaker.tum"), "First"),
        (("amr.json", "weaker.tum"), "First"),
        (("amr.json", "amr.tum"), "Any"),
    ):
        assert f"minimal spec {wanted} " in cli("export-proof", *arguments).out
    for meant in ("amr.tum", "writes.tum"):
        refused = cli("export-proof", "first.json", meant)
        assert (refused.code, refused.out) == (2, "")
        assert "TUM511" in refused.err


def test_a_policy_for_a_weaker_restoration(cli: Cli, tmp_path: Path) -> None:
    """It is refused, unless the command line says by which one the theorem judges it."""
    policy = (tmp_path / "amr.json").read_text()
    weaker = policy.replace('"EffectOrdering": "any"', '"EffectOrdering": "any", "Restoration": "fair"')
    (tmp_path / "fair.json").write_text(weaker)
    refused = cli("export-proof", "fair.json", "amr.tum")
    assert (refused.code, refused.out) == (2, "")
    assert "TUM511" in refused.err
    assert "was made for `restoration: fair`, but the specification means one_step" in refused.err
    assert cli("export-proof", "fair.json", "amr.tum", "--restoration", "one_step").code == 0


def test_what_cannot_be_exported_is_2(cli: Cli) -> None:
    """Wrong input, another specification, a file that cannot be written."""
    for arguments in (
        ("missing.json", "amr.tum"),
        ("amr.json", "typo.tum"),
        ("amr.json", "warned.tum"),
        ("amr.json", "amr.tum", "-o", "nowhere/amr.v"),
        ("amr.json", "amr.tum", "-o", ""),
    ):
        ran = cli("export-proof", *arguments)
        assert (ran.code, ran.out) == (2, "")
        assert "Traceback" not in ran.err
