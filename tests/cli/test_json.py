"""JSON for programs: one object on the standard output, always."""

import json
from collections.abc import Iterator
from itertools import product
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tests.cli.inputs import state
from tumato_symbolic.policy import Policy, Table, Vocabulary, dumps


def test_a_policy(cli: Cli) -> None:
    """`synth` on a realizable specification: verdict, exact counts, longest run, where the policy is."""
    report = json.loads(cli("synth", "amr.tum", "--output-format", "json").out)
    assert report["verdict"] == "realizable"
    assert report["states"] == {"total": 32, "valid": 32, "safe": 24, "unsafe": 8}
    assert (report["longest_run"], report["policy"]) == (4, "policy.json")
    assert (report["failing_states"], report["failures"]) == (0, [])
    assert report["proof"]["verdict"] == "proved"


def test_no_policy(cli: Cli) -> None:
    """`synth` on an unrealizable one: how many states fail, each kind with an example; no run, no policy."""
    ran = cli("synth", "two_robots.tum", "--output-format", "json")
    report = json.loads(ran.out)
    assert (ran.code, report["verdict"], report["failing_states"]) == (1, "unrealizable", 112)
    assert (report["longest_run"], report["policy"]) == (None, None)
    assert report["certificate"] == "policy.unrealizable.json"
    assert (report["proof"]["verdict"], report["proof"]["kind"]) == ("proved", "no-allowed-set")
    (failure,) = report["failures"]
    assert (failure["kind"], failure["count"]) == ("no-allowed-set", 112)
    assert set(failure["example"]) == {f"S_{name}{robot}" for name in ("Loc", "Bat", "Load", "Conv") for robot in "01"}


def test_a_conflict(cli: Cli) -> None:
    """Goals that conflict: no state fails, and the failure lists states that no policy serves together."""
    report = json.loads(cli("synth", "conflict.tum", "--output-format", "json").out)
    assert (report["verdict"], report["failing_states"]) == ("unrealizable", 0)
    (failure,) = report["failures"]
    assert failure["kind"] == "conflict"
    assert failure["states"] == [{"S_Place": "left"}, {"S_Place": "right"}]


@pytest.mark.parametrize(
    "command",
    [
        ("synth", "typo.tum"),
        ("verify", "amr.json", "typo.tum"),
        ("check", "typo.tum"),
        ("verify", "typo.tum", "amr.tum"),
        ("synth", "missing.tum"),
        ("check", "missing.tum"),
        ("synth", "amr.tum", "-o", "missing/policy.json"),
    ],
    ids=" ".join,
)
def test_errors_are_one_object_too(cli: Cli, command: tuple[str, ...]) -> None:
    """Input that cannot be used: exit 2, `verdict` is `error`, and `diagnostics` say why."""
    ran = cli(*command, "--output-format", "json")
    report = json.loads(ran.out)
    assert (ran.code, report["verdict"], ran.err) == (2, "error", "")
    assert report["diagnostics"]
    assert all(found["code"].startswith("TUM") and found["message"] for found in report["diagnostics"])


def test_places_of_diagnostics(cli: Cli) -> None:
    """A diagnostic has its file, its 1-based place and its way out."""
    report = json.loads(cli("check", "typo.tum", "--output-format", "json").out)
    first = report["diagnostics"][0]
    assert (first["file"], first["line"], first["column"], first["severity"]) == ("typo.tum", 7, 16, "error")
    assert "S_Battery" in first["help"]


def test_a_proof(cli: Cli) -> None:
    """`verify` on a good policy: every property proved, by whom, and whether the certificate was of use."""
    report = json.loads(cli("verify", "amr.json", "amr.tum", "--output-format", "json").out)
    assert report["verdict"] == "proved"
    assert list(report["properties"])[:4] == ["total", "safe", "goals", "minimal"]
    assert all(found["verdict"] == "proved" and found["proved_by"] for found in report["properties"].values())
    assert report["certificate"]["status"] == "used"


def test_a_refutation(cli: Cli) -> None:
    """`verify` on a policy that restores too slowly: the state, the decision, the cheaper set, both durations."""
    ran = cli("verify", "slower.json", "amr.tum", "--output-format", "json")
    report = json.loads(ran.out)
    assert (ran.code, report["verdict"]) == (1, "refuted")
    verdicts = {name: found["verdict"] for name, found in report["properties"].items()}
    assert verdicts == {"total": "proved", "safe": "proved", "goals": "proved", "minimal": "refuted"}
    refutation = report["properties"]["minimal"]["refutation"]
    assert refutation["state"] == state("corridor", "ok", "loaded", "on")
    assert (refutation["decision"], refutation["cheaper"]) == (["move_to_workstation_2"], ["stop_conveyor"])
    assert refutation["durations"] == {"decision": 10, "cheaper": 1}


def test_the_policy_and_the_report_do_not_mix(cli: Cli) -> None:
    """`-o - --output-format json`: the policy is on the standard output, the report beside it; each is one object."""
    ran = cli("synth", "amr.tum", "-o", "-", "--output-format", "json")
    assert json.loads(ran.out)["Type"] == "policy"
    assert json.loads(ran.err)["policy"] == "-"


def test_check_of_several_files(cli: Cli, tmp_path: Path) -> None:
    """`check` looks at every file, also after one that cannot be read."""
    (tmp_path / "empty.tum").write_text("")
    report = json.loads(cli("check", "missing.tum", "amr.tum", "empty.tum", "--output-format", "json").out)
    assert [file["verdict"] for file in report["files"]] == ["error", "ok", "error"]


def _pump(**variables: str) -> str:
    """The file of a policy that fills in the first states, over such values."""
    known = tuple((name, tuple(values.split())) for name, values in variables.items())
    states = list(product(*(range(len(values)) for _, values in known)))
    rows = {state: frozenset({0} if number < 3 else ()) for number, state in enumerate(states)}
    return dumps(Policy(Vocabulary(known, ("fill",)), Table(rows)))


def _texts(value: object) -> Iterator[str]:
    """Every text in JSON, but for names of keys."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)


def test_values_that_are_numbers(cli: Cli, tmp_path: Path) -> None:
    """`show` and `diff` write them as numbers wherever they give values."""
    (tmp_path / "pump.json").write_text(_pump(S_Tank="0 1 2 3", S_Valve="open 7"))
    (tmp_path / "more.json").write_text(_pump(S_Tank="1 0 2 3 4", S_Valve="open 8"))
    (tmp_path / "valveless.json").write_text(_pump(S_Tank="0 1 2 3"))
    reports = {
        words: json.loads(cli(*words.split(), "--output-format", "json").out)
        for words in (
            "show pump.json S_Tank=0,1,3",
            "show pump.json --format rules",
            "diff pump.json more.json",
            "diff pump.json valveless.json",
            "diff valveless.json pump.json",
        )
    }
    for words, report in reports.items():
        assert not [text for text in _texts(report) if text.isdigit()], words
    assert reports["show pump.json S_Tank=0,1,3"]["where"] == {"S_Tank": [0, 1, 3]}
    assert reports["show pump.json --format rules"]["rules"][0]["condition"]["S_Tank"][0] == 0
    names = reports["diff pump.json more.json"]["policy"]["names"]
    assert (names["added_values"], names["removed_values"]) == ({"S_Tank": [4], "S_Valve": [8]}, {"S_Valve": [7]})
    assert reports["diff valveless.json pump.json"]["policy"]["names"]["added_variables"] == {"S_Valve": ["open", 7]}
    (change, *_) = reports["diff pump.json more.json"]["policy"]["changes"]
    assert type(change["example"]["S_Tank"]) is int
