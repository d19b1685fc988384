"""`verify --strict`, and folders of policies."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Cli
from tests.cli.inputs import AMR, TWO_ROBOTS, changed_policy, state
from tests.repo.documents import ROOT
from tests.semantics.test_restoration import VALVES

Document = dict[str, Any]


def _document(folder: Path, change: Callable[[Document], object]) -> None:
    document = json.loads((folder / "amr.json").read_text())
    change(document)
    (folder / "changed.json").write_text(json.dumps(document))


def _certificate(document: Document) -> Document:
    certificate: Document = document["Certificate"]
    return certificate


def _swapped_ranks(document: Document) -> None:
    leaves = _certificate(document)["Leaves"]
    one, two = leaves.index(1), leaves.index(2)
    leaves[one], leaves[two] = 2, 1


FAILING: dict[str, tuple[str, Callable[[Document], object]]] = {
    "another digest": ("stale", lambda document: document.update(SpecificationDigest="sha256:0")),
    "no digest": ("stale", lambda document: document.pop("SpecificationDigest")),
    "false ranks": ("wrong", _swapped_ranks),
    "no certificate at all": ("wrong", lambda document: document.update(Certificate=None)),
    "a goal twice": ("wrong", lambda d: _certificate(d)["Goals"].append(_certificate(d)["Goals"][0])),
    "an action that the goal never mentions": (
        "wrong",
        lambda document: _certificate(document)["Goals"][0].update(Executed=["charge"]),
    ),
    "a goal that nobody has": (
        "wrong",
        lambda document: _certificate(document)["Goals"].append({"Bodies": ["true"], "Executed": [], "Root": 0}),
    ),
    "false ranks of a goal that is not needed": (
        "wrong",
        lambda document: _certificate(document)["Goals"].append(
            {"Bodies": ["S_Battery is ok", "S_Load is free"], "Executed": [], "Root": 1}
        ),
    ),
    "ranks beyond the bound": (
        "wrong",
        lambda document: _certificate(document).update(
            Leaves=[rank and 3 * rank for rank in _certificate(document)["Leaves"]]
        ),
    ),
}

PASSING: dict[str, tuple[str, Callable[[Document], object]]] = {
    "nothing changed": ("used", lambda document: None),
    "no certificate": ("absent", lambda document: document.pop("Certificate")),
    "a goal is missing": ("incomplete", lambda document: _certificate(document)["Goals"].pop()),
    "no rank": ("incomplete", lambda document: _certificate(document)["Goals"][0].update(Root=0)),
}


@pytest.mark.parametrize("prover", ["z3", "walk", "auto", "both"])
@pytest.mark.parametrize("name", FAILING)
def test_every_prover_finds_what_is_stale_or_wrong(cli: Cli, tmp_path: Path, name: str, prover: str) -> None:
    """The policy is proved all the same, and not accepted."""
    status, change = FAILING[name]
    _document(tmp_path, change)
    ran = cli("verify", "changed.json", "amr.tum", "--prover", prover, "--strict", "--output-format", "json")
    found = json.loads(ran.out)
    assert (ran.code, found["verdict"], found["accepted"]) == (1, "proved", False)
    assert found["certificate"]["status"] == status


@pytest.mark.parametrize("name", FAILING)
def test_strict_fails_what_is_stale_or_wrong(cli: Cli, tmp_path: Path, name: str) -> None:
    """With `--strict` the exit code is 1, without it 0, and the report says why, in every format."""
    status, change = FAILING[name]
    _document(tmp_path, change)
    command = ("verify", "changed.json", "amr.tum", "--prover", "walk")
    assert cli(*command).code == 0
    assert "::warning file=changed.json,title=TUM507::certificate: " in cli(*command, "--output-format", "github").out
    ran = cli(*command, "--strict")
    assert ran.code == 1
    assert f"Not accepted (--strict): the certificate is {status}." in ran.out
    found = json.loads(cli(*command, "--strict", "--output-format", "json").out)
    (warning,) = found["warnings"]
    assert (warning["code"], warning["severity"], warning["file"]) == ("TUM507", "warning", "changed.json")
    assert f"title={status}::certificate: " in cli(*command, "--strict", "--output-format", "github").out


@pytest.mark.parametrize("prover", ["z3", "walk", "auto", "both"])
@pytest.mark.parametrize("name", PASSING)
def test_strict_passes_what_claims_nothing_false(cli: Cli, tmp_path: Path, name: str, prover: str) -> None:
    """A certificate that is absent or incomplete is no reason to fail."""
    status, change = PASSING[name]
    _document(tmp_path, change)
    ran = cli("verify", "changed.json", "amr.tum", "--strict", "--prover", prover, "--output-format", "json")
    assert (ran.code, json.loads(ran.out)["certificate"]["status"]) == (0, status)


@pytest.mark.parametrize(
    "arguments",
    [
        ["verify", "amr.json", "amr.tum", "--strict", "--properties", "total"],
        ["verify", "amr.json", "amr.tum", "--specs", "."],
        ["verify", "amr.json", "amr.tum", "coin.tum"],
        ["verify", "amr.json"],
        ["verify", "nowhere"],
    ],
)
def test_usage(cli: Cli, arguments: list[str]) -> None:
    """What does not fit together is exit 2."""
    assert cli(*arguments).code == 2


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two policies and a certificate of unrealizability in `policies`, their specifications in `examples`."""
    (tmp_path / "policies").mkdir()
    (tmp_path / "examples").mkdir()
    for name in ("amr.policy.json", "coin.policy.json", "two_robots.unrealizable.json"):
        (tmp_path / "policies" / name).write_text((ROOT / "proofs" / name).read_text())
    for path in (AMR, TWO_ROBOTS, AMR.with_name("coin.tum")):
        (tmp_path / "examples" / path.name).write_text(path.read_text())
    return tmp_path


def test_a_folder_is_verified_file_by_file(cli: Cli, folder: Path) -> None:
    """A line for every file and a summary; unrealizable counts as proved, too."""
    ran = cli("verify", "policies", "--strict")
    assert ran.code == 0
    first, second, third, last = ran.out.splitlines()
    assert " ".join(first.split()).endswith(" proved examples/amr.tum, 32 valid states, certificate used")
    assert second.startswith("policies/coin.policy.json ")
    assert "unrealizable: no-allowed-set" in third
    assert last.startswith("3 files: 3 proved. In ")


def test_the_worst_file_decides(cli: Cli, folder: Path) -> None:
    """The exit code is 2 before 1 before 0, and every file is looked at."""
    where = state("corridor", "ok", "free", "off")
    (folder / "policies" / "amr.policy.json").write_text(json.dumps(changed_policy(where, [])))
    ran = cli("verify", "policies")
    assert ran.code == 1
    assert "3 files: 2 proved, 1 refuted." in ran.out
    assert "policies/amr.policy.json is refuted against examples/amr.tum" in ran.out
    (folder / "policies" / "coin.policy.json").write_text("{")
    ran = cli("verify", "policies", "--output-format", "json")
    found = json.loads(ran.out)
    assert (ran.code, found["verdict"]) == (2, "error")
    assert found["counts"] == {"error": 1, "refuted": 1, "proved": 1}
    assert [each["verdict"] for each in found["files"]] == ["refuted", "error", "proved"]
    assert [each["accepted"] for each in found["files"]] == [False, False, True]
    assert cli("verify", "policies", "--output-format", "github").out.count("::error") == 2


def test_strict_holds_for_folders(cli: Cli, folder: Path) -> None:
    """A stale certificate fails the folder, and is told apart from a refuted policy."""
    path = folder / "policies" / "coin.policy.json"
    path.write_text(path.read_text().replace("sha256:", "sha257:"))
    assert cli("verify", "policies").code == 0
    ran = cli("verify", "policies", "--strict")
    assert ran.code == 1
    assert "2 proved, 1 not accepted" in ran.out


def test_where_specifications_are_looked_for(cli: Cli, folder: Path) -> None:
    """First in the folders of `--specs`, then beside the policy, then in ../examples."""
    broken = "BEGIN"
    (folder / "policies" / "coin.tum").write_text(broken)
    assert cli("verify", "policies").code == 2
    assert cli("verify", "policies", "--specs", "examples").code == 0
    (folder / "policies" / "coin.tum").unlink()
    (folder / "examples" / "coin.tum").rename(folder / "coin.tum")
    ran = cli("verify", "policies")
    assert ran.code == 2
    assert "there is no specification coin.tum for this file in policies, examples" in ran.out
    assert cli("verify", "policies", "--specs", "nowhere", "--specs", ".").code == 0


def test_an_empty_folder_proves_nothing(cli: Cli, folder: Path) -> None:
    """A folder without policies is an error, not a success."""
    ran = cli("verify", "examples")
    assert ran.code == 2
    assert "there is nothing to verify in the folder examples" in ran.err


def test_specifications_are_found_by_what_they_mean(cli: Cli, folder: Path) -> None:
    """Whatever `synth -o` was called with: a file without a namesake belongs to the specification with its digest."""
    for output in ("left.policy.json", "right.json", "sub.policy"):
        assert cli("synth", "examples/two_robots.tum", "-o", f"policies/{output}").code == 1
    assert cli("synth", "examples/coin.tum", "-o", "policies/heads.policy.json").code == 0
    ran = cli("verify", "policies", "--strict")
    assert ran.code == 0
    found = dict(line.split()[::2][:2] for line in ran.out.splitlines()[:-1])
    assert found["policies/left.unrealizable.json"] == "examples/two_robots.tum,"
    assert found["policies/right.unrealizable.json"] == "examples/two_robots.tum,"
    assert found["policies/sub.unrealizable.json"] == "examples/two_robots.tum,"
    assert found["policies/heads.policy.json"] == "examples/coin.tum,"


def test_a_namesake_comes_before_the_digest(cli: Cli, folder: Path) -> None:
    """A copy of the old specification does not keep a policy from going stale."""
    spec = folder / "examples" / "amr.tum"
    (folder / "examples" / "old.tum").write_text(spec.read_text())
    spec.write_text(spec.read_text().replace("max_plan_length: 5", "max_plan_length: 6"))
    assert cli("verify", "policies", "--strict").code == 1


def test_a_reason_is_given_once(cli: Cli, tmp_path: Path) -> None:
    """A certificate that is stale is said to be made for another specification, or for none, but not twice."""
    for change, reason in (
        (lambda document: document.update(SpecificationDigest="sha256:0"), "another specification"),
        (lambda document: document.pop("SpecificationDigest"), "no specification in particular"),
    ):
        _document(tmp_path, change)
        ran = cli("verify", "changed.json", "amr.tum")
        assert f"  certificate: stale, and ignored (it was made for {reason})\n" in ran.out


def test_certificates_with_a_policy_in_their_name(cli: Cli, folder: Path) -> None:
    """`NAME.policy.unrealizable.json` is about NAME."""
    certificate = folder / "policies" / "two_robots.unrealizable.json"
    text = certificate.read_text().replace("sha256:", "sha257:")
    certificate.with_name("two_robots.policy.unrealizable.json").write_text(text)
    assert "two_robots.tum, unrealizable: no-allowed-set, certificate stale" in cli("verify", "policies").out


def test_every_specification_may_be_required(cli: Cli, folder: Path) -> None:
    """`--require-all`: a specification with neither policy nor certificate fails, one that means the same does not."""
    (folder / "examples" / "copy.tmt").write_text(
        f"// another comment\n{(folder / 'examples' / 'coin.tum').read_text()}"
    )
    (folder / "robots").mkdir()
    assert cli("verify", "policies", "--require-all").code == 0
    (folder / "policies" / "coin.policy.json").write_text("{")
    (folder / "policies" / "amr.policy.json").unlink()
    (folder / "examples" / "broken.tmt").write_text("BEGIN")
    ran = cli("verify", "policies", "--require-all", "--output-format", "json")
    found = json.loads(ran.out)
    assert (ran.code, found["verdict"]) == (2, "error")
    missing = {each["file"] for each in found["files"] if each["verdict"] == "missing"}
    assert missing == {"examples/amr.tum", "examples/broken.tmt"}
    (folder / "policies" / "coin.policy.json").unlink()
    ran = cli("verify", "policies", "--require-all")
    assert ran.code == 1
    assert "5 files: 1 proved, 4 missing" in ran.out
    assert cli("verify", "policies", "--require-all", "--specs", "robots").code == 0
    assert cli("verify", "policies").code == 0
    assert cli("verify", "amr.json", "amr.tum", "--require-all").code == 2


def test_efforts_are_judged_whatever_is_asked(cli: Cli, tmp_path: Path) -> None:
    """A certificate that promises too short a way to safety fails, also where *restoring* is not asked for."""
    (tmp_path / "valves.tum").write_text(VALVES)
    assert cli("synth", "valves.tum", "--restoration", "bounded", "-o", "valves.json").code == 0
    asked = ("--restoration", "bounded", "--strict", "--properties", "safe,goals")
    assert cli("verify", "valves.json", "valves.tum", *asked).code == 0
    policy = json.loads((tmp_path / "valves.json").read_text())
    leaves = _certificate(policy)["Restoring"]["Leaves"]
    leaves[leaves.index([2, 2])] = [2, 1]
    (tmp_path / "valves.json").write_text(json.dumps(policy))
    ran = cli("verify", "valves.json", "valves.tum", *asked)
    assert ran.code == 1
    assert "Not accepted (--strict): the certificate is wrong." in ran.out
