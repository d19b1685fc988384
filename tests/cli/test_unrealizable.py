"""Unrealizable specifications, from `synth` to `verify`."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.verify.unrealizability import no_plan, verdict


def files(folder: Path) -> set[str]:
    """What is there beside the inputs."""
    return {path.name for path in folder.glob("*.unrealizable.json")} - {"holed.unrealizable.json"}


@pytest.mark.parametrize(
    ("output", "name"),
    [
        ((), "policy.unrealizable.json"),
        (("-o", "foo.json"), "foo.unrealizable.json"),
        (("-o", "foo"), "foo.unrealizable.json"),
        (("-o", "foo.policy.json"), "foo.unrealizable.json"),
    ],
)
@pytest.mark.parametrize("spec", ["no_plan.tum", "conflict.tum", "two_robots.tum"])
def test_synth_leaves_a_certificate_that_verify_proves(
    cli: Cli, tmp_path: Path, spec: str, output: tuple[str, ...], name: str
) -> None:
    """The certificate is written beside the policy that there is not, and proves the answer: exit 1, then exit 0."""
    ran = cli("synth", spec, *output)
    assert (ran.code, files(tmp_path)) == (1, {name})
    assert f"{name} is written" in ran.out
    checked = cli("verify", name, spec)
    assert (checked.code, checked.err) == (0, "")
    assert f"{spec} is proved unrealizable by {name}." in checked.out


@pytest.mark.parametrize("output", ["-", "/dev/null"])
def test_no_file_no_certificate(cli: Cli, tmp_path: Path, output: str) -> None:
    """Where the policy would not be a file, no certificate is written; the answer is proved all the same."""
    ran = cli("synth", "conflict.tum", "-o", output)
    assert (ran.code, files(tmp_path)) == (1, set())
    assert "Proved: " in ran.out + ran.err
    assert not Path("/dev/null.unrealizable.json").exists()


def test_a_realizable_specification_removes_nothing(cli: Cli, tmp_path: Path) -> None:
    """A certificate of an earlier run stays, and is refuted as what it is: made for another specification."""
    assert cli("synth", "no_plan.tum").code == 1
    assert cli("synth", "warned.tum").code == 0
    assert files(tmp_path) == {"policy.unrealizable.json"}
    checked = cli("verify", "policy.unrealizable.json", "warned.tum", "--output-format", "json")
    report = json.loads(checked.out)
    assert (checked.code, report["verdict"], report["stale"]) == (1, "refuted", True)
    assert report["witness"] == {"state": {"S_Battery": "low"}, "actions": ["charge"]}


def test_without_a_proof_the_report_says_so(cli: Cli, tmp_path: Path) -> None:
    """`--no-verify` writes the certificate and says that it is not proved."""
    ran = cli("synth", "conflict.tum", "--no-verify")
    assert (ran.code, files(tmp_path)) == (1, {"policy.unrealizable.json"})
    assert "is not proved: --no-verify was given" in ran.out
    assert "Z3" not in ran.out


def test_time_that_runs_out_is_3(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """A certificate that is not proved in time is undecided; `synth` says so, and answers no all the same."""
    assert cli("synth", "conflict.tum").code == 1
    defaults = verdict.verify_unrealizable.__kwdefaults__
    assert defaults is not None
    monkeypatch.setitem(defaults, "timeout", 0.0)
    checked = cli("verify", "policy.unrealizable.json", "conflict.tum")
    assert checked.code == 3
    assert "undecided" in checked.out
    again = cli("synth", "conflict.tum")
    assert again.code == 1
    assert "could not be proved" in again.out


def test_the_report_names_whoever_was_needed(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """Z3 alone, with the walk where layers were left to it, or direct evaluation."""

    def proved_by(spec: str) -> tuple[str, str]:
        cli("synth", spec)
        told = cli("verify", "policy.unrealizable.json", spec)
        asked = cli("verify", "policy.unrealizable.json", spec, "--output-format", "json")
        return told.out.strip().rpartition("obligations ")[2], json.loads(asked.out)["proved_by"]

    assert proved_by("two_robots.tum") == ("checked by direct evaluation", "meaning")
    assert proved_by("no_plan.tum") == ("proved by Z3", "z3")
    monkeypatch.setattr(no_plan, "MANY_NODES", -1)
    assert proved_by("no_plan.tum") == ("proved by Z3 and the walk", "z3, walk")


def test_another_ordering_than_the_written_one(cli: Cli, tmp_path: Path) -> None:
    """A certificate for `any` proves nothing of a specification that writes `first`, unless that is asked for."""
    written = (tmp_path / "conflict.tum").read_text().replace("max_plan_length: 2", "effect_ordering: first")
    (tmp_path / "first.tum").write_text(written)
    ran = cli("synth", "first.tum", "--effect-ordering", "any")
    assert ran.code == 1
    assert "tumato-sym verify policy.unrealizable.json first.tum --effect-ordering any" in ran.out
    assert cli("verify", "policy.unrealizable.json", "first.tum", "--effect-ordering", "any").code == 0
    assert cli("verify", "policy.unrealizable.json", "first.tum").code == 1


def test_unreadable_certificates_are_2(cli: Cli, tmp_path: Path) -> None:
    """Names that do not fit, and text that is no certificate."""
    assert cli("synth", "no_plan.tum").code == 1
    assert cli("verify", "policy.unrealizable.json", "amr.tum").code == 2
    (tmp_path / "broken.json").write_text('{"Type": "unrealizable"}')
    broken = cli("verify", "broken.json", "no_plan.tum")
    assert broken.code == 2
    assert "the certificate has no `SpecificationDigest`" in broken.err


def test_github_shows_one_command(cli: Cli) -> None:
    """A notice for a certificate that is proved, an error for one that is refuted."""
    cli("synth", "no_plan.tum")
    proved = cli("verify", "policy.unrealizable.json", "no_plan.tum", "--output-format", "github")
    assert proved.out.startswith("::notice file=policy.unrealizable.json::no_plan.tum is proved unrealizable")
    refuted = cli("verify", "holed.unrealizable.json", "two_robots.tum", "--output-format", "github")
    assert refuted.out.startswith("::error file=holed.unrealizable.json")
