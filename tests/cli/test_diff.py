"""`diff`: two policies, or two specifications with their policies."""

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from msgspec.structs import replace

from tests.cli.conftest import Cli
from tests.policy.strategies import amr_like
from tests.repo.documents import ROOT
from tumato_symbolic.policy import dumps

SCHEMA = json.loads((ROOT / "tumato_symbolic" / "report" / "diff.schema.json").read_text())


def as_json(cli: Cli, *words: str) -> dict[str, Any]:
    """The report for a program, which the schema describes."""
    report: dict[str, Any] = json.loads(cli("diff", *words, "--output-format", "json").out)
    jsonschema.Draft202012Validator(SCHEMA).validate(report)
    return report


@pytest.fixture
def other(tmp_path: Path) -> str:
    """The AMR with another duration, a further rule and without one of its goals."""
    text = (ROOT / "examples" / "amr.tum").read_text()
    text = text.replace("duration: 50", "duration: 40").replace("when S_Load is loaded then goal: S_Load is free\n", "")
    text = text.replace("BEGIN STATE RULES\n", "BEGIN STATE RULES\nrule: NOT (S_Battery is low AND S_Conveyor is on)\n")
    (tmp_path / "other.tum").write_text(text)
    return "other.tum"


def test_the_schema_is_a_schema() -> None:
    """2020-12."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_a_policy_is_the_same_as_itself(cli: Cli) -> None:
    """Exit 0, also as a diagram and with its specification."""
    cli("synth", "amr.tum", "-o", "diagram.json", "--policy-format", "diagram")
    ran = cli("diff", "amr.json", "diagram.json")
    assert (ran.code, ran.out) == (0, "amr.json → diagram.json: 32 states decided, all alike.\n")
    assert cli("diff", "amr.json", "diagram.json", "amr.tum").code == 0
    assert as_json(cli, "amr.json", "amr.json")["verdict"] == "same"
    assert cli("diff", "amr.json", "amr.json", "--output-format", "github").out.startswith("::notice file=amr.json")


def test_a_decision_that_changed(cli: Cli) -> None:
    """Where, before and after; exit 1, and an annotation."""
    ran = cli("diff", "amr.json", "lazy.json")
    assert ran.code == 1
    assert ran.out == (
        "amr.json → lazy.json: 1 of 32 states decided otherwise.\n\n"
        "in 1 state: {move_to_workstation_1} → {}\n"
        "  where S_Location is corridor and S_Battery is ok and S_Load is free and S_Conveyor is off\n"
    )
    (change,) = as_json(cli, "amr.json", "lazy.json")["policy"]["changes"]
    assert (change["states"], change["before"]["actions"], change["after"]["actions"]) == (
        1,
        ["move_to_workstation_1"],
        [],
    )
    told = cli("diff", "amr.json", "lazy.json", "--output-format", "github").out
    assert "::warning file=lazy.json,title=decision changed::in 1 state: {move_to_workstation_1} → {}%0A" in told


def test_names_that_one_policy_has(cli: Cli, tmp_path: Path) -> None:
    """Variables, values and actions are named, and what comparing means then."""
    old = amr_like()
    place, _ = old.vocabulary.variables
    variables = (place, ("S_Load", ("free", "full", "even")), ("S_Door", ("open", "shut")))
    rows = {(*state, value): chosen for state, chosen in amr_like().decisions.rows.items() for value in (0, 1)}  # type: ignore[union-attr]
    vocabulary = replace(old.vocabulary, variables=variables, actions=("go", "load", "halt"))
    new = replace(old, vocabulary=vocabulary, decisions=replace(old.decisions, rows=rows), certificate=None)
    (tmp_path / "old.json").write_text(dumps(old))
    (tmp_path / "new.json").write_text(dumps(new))
    out = cli("diff", "old.json", "new.json").out
    assert out.startswith("old.json → new.json: 2 of 8 states decided otherwise.\n")
    assert "+ variable S_Door (open, shut): an old decision counts for each of its values\n" in out
    assert "+ value even of S_Load, of which the old policy knows no state\n" in out
    assert "- value odd of S_Load, of which the new policy knows no state\n" in out
    assert "+ action halt\n- action stop\n" in out
    assert "in 2 states: {go, stop} → {go, halt}\n" in out
    names = as_json(cli, "old.json", "new.json")["policy"]["names"]
    assert names["added_variables"] == {"S_Door": ["open", "shut"]}


def test_specifications(cli: Cli, other: str) -> None:
    """Elements with their lines, counts of states, and what the policies do otherwise."""
    ran = cli("diff", "amr.tum", other)
    assert ran.code == 1
    assert "  ~ action charge  (other.tum:59)\n      duration: 50 → 40\n" in ran.out
    assert "  + state rule: NOT (S_Battery is low AND S_Conveyor is on)  (other.tum:80)\n" in ran.out
    assert "  - when S_Load is loaded then goal: S_Load is free  (amr.tum:86)\n" in ran.out
    assert "safe states: 24 → 20\npolicy: realizable, as before\n" in ran.out
    report = as_json(cli, "amr.tum", other)
    assert [element["kind"] for element in report["elements"]] == ["action", "state rule", "goal"]
    assert report["policy"]["changed"] > 0
    told = cli("diff", "amr.tum", other, "--output-format", "github").out
    assert "::warning file=other.tum,line=80," in told
    assert "::warning file=amr.tum,line=86," in told


def test_what_does_not_matter(cli: Cli, tmp_path: Path) -> None:
    """Comments, layout and the order of rules and declarations."""
    text = (ROOT / "examples" / "amr.tum").read_text()
    block = text[text.index("BEGIN STATE RULES") : text.index("BEGIN GOALS")]
    (tmp_path / "moved.tum").write_text(f"// moved\n{block}\n{text.replace(block, '')}")
    ran = cli("diff", "amr.tum", "moved.tum")
    assert (ran.code, ran.out.splitlines()[0]) == (0, "amr.tum → moved.tum: the same meaning.")


def test_a_specification_without_a_policy(cli: Cli) -> None:
    """Its elements are compared all the same."""
    report = as_json(cli, "warned.tum", "no_plan.tum")
    assert [each["verdict"] for each in report["outcomes"]] == ["realizable", "unrealizable"]
    assert (report["verdict"], report["policy"]) == ("different", None)
    assert "policy: realizable → not realizable (no-plan)" in cli("diff", "warned.tum", "no_plan.tum").out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("amr.json amr.tum", "`amr.json` is a policy, and is compared with a specification"),
        ("amr.tum warned.tum amr.tum", "two specifications are compared without a third file"),
        ("amr.json missing.json", "cannot be read"),
        ("amr.tum missing.tum", "there is no file `missing.tum`"),
        ("amr.json lazy.json warned.tum", "which the specification does not have"),
        ("amr.json holed.unrealizable.json", "TUM50"),
        ("amr.tum typo.tum", "did you mean"),
    ],
)
def test_mistakes(cli: Cli, words: str, said: str) -> None:
    """Each ends with 2 and a way out."""
    ran = cli("diff", *words.split())
    assert (ran.code, said in ran.err) == (2, True), ran.err
