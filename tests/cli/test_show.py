"""`show`: a policy, or a part of it, in every format."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tests.policy.strategies import amr_like
from tumato_symbolic.policy import Policy, Table, Vocabulary, dumps

AMR = "amr.json"
ODD = Policy(
    Vocabulary((('a "b" \\ <c>', ("x\ny", "{z}")),), ("go|", "[stop]")),
    Table({(0,): frozenset({0}), (1,): frozenset({1})}),
)
"""Names that mean something in the languages of graphs."""


def test_a_part(cli: Cli) -> None:
    """How many states it has, and what is done there; the specification marks unsafe states."""
    ran = cli("show", AMR, "S_Conveyor=on", "S_Location=corridor,charger")
    assert ran.code == 0
    assert ran.out == (
        "amr.json decides all 8 states where S_Location in {corridor, charger} and S_Conveyor is on.\n\n"
        "always    stop_conveyor\n"
    )
    ran = cli("show", AMR, "amr.tum", "S_Conveyor=on", "S_Location=corridor,charger")
    assert "all 8 valid states where" in ran.out
    assert "always  ! stop_conveyor\n\n! marks states that break a state rule." in ran.out


def test_where_an_action_is_executed(cli: Cli) -> None:
    """All conditions are shown, although outside of them something else is done."""
    ran = cli("show", AMR, "--executing", "charge", "--format", "table")
    assert ran.out.startswith("amr.json executes charge in 2 states.\n")
    assert ran.out.splitlines()[-1].split() == ["2", "charger", "low", "off", "charge"]
    assert cli("show", AMR, "S_Battery=ok", "--executing", "charge").out == (
        "amr.json executes charge in no state where S_Battery is ok.\n\nalways    –\n"
    )
    said = cli("show", AMR, "--executing", "charge", "--format", "rules").out
    assert said.endswith(
        "S_Location is charger AND S_Battery is low AND S_Conveyor is off\n     charge\n2  otherwise\n     –\n"
    )


def test_what_is_left_out_comes_with_the_command_that_shows_it(cli: Cli) -> None:
    """It can be typed as it stands, and shows as many states as the line stands for."""
    ran = cli("show", AMR, "--limit", "4")
    *_, command = ran.out.splitlines()
    name, *words = command.split()
    assert name == "tumato-sym"
    assert "2 lines stand for 24 states" in ran.out
    assert cli(*words).out.startswith("amr.json decides all 16 states where S_Battery is")


def test_rules_are_a_format(cli: Cli) -> None:
    """With the number of states; as JSON the rules are there."""
    assert "8 rules decide the same" in cli("show", AMR, "--format", "rules").out
    report = json.loads(cli("show", AMR, "--format", "rules", "--output-format", "json").out)
    assert (report["verdict"], report["states"], len(report["rules"])) == ("ok", 32, 8)


def test_rows_for_a_program(cli: Cli) -> None:
    """Disjoint, with their states and whether they are unsafe; where decisions differ, how many there are."""
    report = json.loads(cli("show", AMR, "amr.tum", "--format", "table", "--output-format", "json").out)
    assert sum(row["states"] for row in report["rows"]) == report["states"] == 32
    assert sum(row["states"] for row in report["rows"] if row["unsafe"]) == 8
    short = json.loads(cli("show", AMR, "--format", "table", "--limit", "2", "--output-format", "json").out)
    assert [sorted(row) for row in short["rows"]] == [["condition", "decisions", "states"]] * 2


def test_undecided_states_are_shown(cli: Cli, tmp_path: Path) -> None:
    """As such; where the specification excludes them they are left out."""
    (tmp_path / "part.json").write_text(dumps(amr_like()))
    ran = cli("show", "part.json")
    assert ran.out.startswith("part.json decides 4 of 6 states; the other 2 are undecided.\n")
    assert "S_Load odd        (undecided)" in ran.out
    ran = cli("show", "part.json", "S_Load=odd")
    assert ran.out.startswith("part.json decides none of 2 states where S_Load is odd.\n")


def test_a_graph_is_drawn(cli: Cli) -> None:
    """Each box once, each answer an arrow; what is left out is said beside it."""
    ran = cli("show", AMR, "amr.tum", "--format", "dot")
    assert ran.out.startswith("digraph policy {")
    assert ran.out.count('label="stop_conveyor"') == 2, "safe and unsafe"
    assert ran.err == ""
    assert "23 arrows" if ran.out.count("->") == 23 else ran.out.count("->")
    short = cli("show", AMR, "--format", "dot", "--limit", "3")
    assert (
        short.err == "tumato-sym: 2 boxes stand for different decisions; --limit N shows more, VARIABLE=VALUE a part\n"
    )


def test_a_flowchart_names_what_it_uses(cli: Cli) -> None:
    """Every box has a class that is defined, and every arrow ends at boxes."""
    lines = cli("show", AMR, "--format", "mermaid", "--executing", "charge").out.splitlines()
    assert lines[:2] == ["---", 'title: "amr.json executes charge in 2 states."']
    boxes = {line.split("{")[0].split("[")[0].strip() for line in lines if ":::" in line}
    classes = {line.rsplit(":::", 1)[1] for line in lines if ":::" in line}
    assert (
        classes == {line.split()[1] for line in lines if line.startswith("  classDef")} == {"question", "other", "done"}
    )
    for line in lines:
        if "-->" in line:
            assert {line.split()[0], line.split()[-1]} <= boxes


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
def test_graphviz_reads_it(cli: Cli, tmp_path: Path) -> None:
    """A name may be any text; the nodes are those that were written."""
    (tmp_path / "odd.json").write_text(dumps(ODD))
    text = cli("show", "odd.json", "--format", "dot").out
    done = subprocess.run(["dot", "-Tplain"], input=text, capture_output=True, text=True, check=True, timeout=60)
    nodes = [line.split()[1] for line in done.stdout.splitlines() if line.startswith("node ")]
    assert nodes == [f"n{number}" for number in range(3)]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("show amr.json S_Batery=low", "did you mean `S_Battery`?"),
        ("show amr.json S_Battery=lw", "did you mean `low`?"),
        ("show amr.json --executing chrge", "did you mean `charge`?"),
        ("show", "the following arguments are required: POLICY\n"),
        ("show amr.json --executing ,", "--executing names no action"),
        ("show amr.json missing.tum", "there is no file `missing.tum`"),
        ("show amr.json amr.tum warned.tum", "there is one specification, not 2: amr.tum, warned.tum"),
        ("show amr.tum", "is a specification, but a policy belongs here"),
        ("show amr.tum amr.json", "swap them"),
        ("show amr.json warned.tum", "which the specification does not have"),
        ("show holed.unrealizable.json", "TUM50"),
        ("show amr.json --format dot --output-format json", "is for another program already"),
        ("show amr.json --format rules --limit 3", "rules are listed whole"),
    ],
)
def test_mistakes(cli: Cli, words: str, said: str) -> None:
    """Each ends with 2 and a way out."""
    ran = cli(*words.split())
    assert (ran.code, said in ran.err) == (2, True), ran.err
