"""`explain` and `why` from the outside: exit codes, streams, formats."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Cli

STATE = ("S_Location=corridor", "S_Battery=low", "S_Load=free", "S_Conveyor=on")


def test_exit_codes(cli: Cli) -> None:
    """No policy: 1; a policy, so that there is nothing to explain: 0; a specification with errors: 2."""
    assert cli("explain", "no_plan.tum").code == 1
    assert cli("explain", "amr.tum").code == 0
    assert cli("explain", "typo.tum").code == 2
    for format_ in ("json", "github", "sarif"):
        assert cli("explain", "no_plan.tum", "--output-format", format_).code == 1
        assert cli("explain", "typo.tum", "--output-format", format_).code == 2


def test_usage(cli: Cli) -> None:
    """Numbers that make no sense are refused."""
    for wrong in (("--max-cubes", "0"), ("--cores", "x"), ("--repairs", "-1"), ("--max-cubes", "²")):
        assert cli("explain", "no_plan.tum", *wrong).code == 2


def test_json_has_what_it_promises(cli: Cli) -> None:
    """The keys that scripts rely on."""
    report = json.loads(cli("explain", "two_robots.tum", "--output-format", "json").out)
    assert report["verdict"] == "unrealizable"
    assert report["failing_states"] == 112
    assert {"kind", "count", "cubes", "example", "core"} <= set(report["failures"][0])
    assert {"kind", "text", "line"} <= set(report["failures"][0]["core"][0])
    assert all(repair["verified"] and {"add", "drop", "edit"} & set(repair) for repair in report["repairs"])
    assert not any(repair["gives_up_safety"] for repair in report["repairs"])
    assert {"states", "assumption"} <= set(report["realizable_part"])


def test_all_repairs_are_a_word_of_the_command_line(cli: Cli) -> None:
    """`--repairs all` lists what gives up safety as well, marked; other words are refused."""
    report = json.loads(cli("explain", "no_plan.tum", "--repairs", "all", "--output-format", "json").out)
    given_up = [repair["gives_up_safety"] for repair in report["repairs"]]
    assert given_up == sorted(given_up)
    assert cli("explain", "no_plan.tum", "--repairs", "every").code == 2


def test_nothing_remains_and_nothing_is_written(cli: Cli, tmp_path: Path) -> None:
    """Where no part is realizable, the assumption is null and `--write` writes nothing."""
    ran = cli("explain", "rule_too_strong.tum", "--write", "new.tum", "--output-format", "json")
    report = json.loads(ran.out)
    assert report["realizable_part"]["assumption"] is None
    assert report["written"] is None
    assert not (tmp_path / "new.tum").exists()


def test_the_written_specification_is_realizable(cli: Cli) -> None:
    """`--write FILE`, then `synth FILE`."""
    assert cli("explain", "two_robots.tum", "--write", "new.tum", "--repairs", "0").code == 1
    assert cli("synth", "new.tum").code == 0


def test_a_file_that_cannot_be_written_is_2(cli: Cli) -> None:
    """`--write` into a folder that does not exist."""
    ran = cli("explain", "no_plan.tum", "--write", "nowhere/new.tum")
    assert ran.code == 2
    assert "nowhere" in ran.err


SARIF = {
    "explain two_robots.tum": True,
    "explain conflict.tum": True,
    "explain no_plan.tum": True,
    "explain conflicting_goals.tum": True,
    "explain amr.tum": False,
    "synth two_robots.tum": True,
    "synth amr.tum": False,
    "check typo.tum warned.tum amr.tum": True,
    "verify unsafe.json amr.tum": True,
    "verify amr.json amr.tum": False,
    "verify .": True,
    "synth missing.tum": True,
}
"""Commands, and whether something is wrong."""


@pytest.mark.parametrize("command", SARIF)
def test_sarif_names_rules_and_places(cli: Cli, command: str) -> None:
    """Every result has a declared rule, a message and a place; columns are 1-based; related places are numbered."""
    log = json.loads(cli(*command.split(), "--output-format", "sarif").out)
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    rules = {rule["id"] for rule in run["tool"]["driver"]["rules"]}
    assert bool(run["results"]) == SARIF[command]
    for result in run["results"]:
        assert result["ruleId"] in rules
        assert result["level"] in ("error", "warning")
        assert result["message"]["text"]
        assert result["locations"] or "missing" in command
        for place in (*result["locations"], *result.get("relatedLocations", ())):
            region = place["physicalLocation"].get("region")
            if region is not None:
                assert (region["endLine"], region["endColumn"]) > (region["startLine"], region["startColumn"]) >= (1, 1)


def test_why_answers_for_a_state(cli: Cli) -> None:
    """0 with the decision; the JSON names what was asked with `--not`."""
    ran = cli("why", "amr.json", "amr.tum", *STATE)
    assert (ran.code, ran.err) == (0, "")
    assert "{stop_conveyor}" in ran.out
    asked = cli("why", "amr.json", "amr.tum", *STATE, "--not", "move_to_charger", "--output-format", "json")
    (other,) = json.loads(asked.out)["others"]
    assert (other["actions"], other["verdict"]) == (["move_to_charger"], "forbidden")


def test_why_refuses_what_it_does_not_know(cli: Cli) -> None:
    """An unknown action, a missing variable, a value that does not exist: 2, with a way out."""
    wrong = cli("why", "amr.json", "amr.tum", *STATE, "--not", "stop_conveyer")
    assert wrong.code == 2
    assert "stop_conveyor" in wrong.err
    assert cli("why", "amr.json", "amr.tum", *STATE[:3]).code == 2
    assert cli("why", "amr.json", "amr.tum", *STATE[:3], "S_Conveyor=broken").code == 2
