"""What is said about results."""

from typing import Any
from xml.etree import ElementTree

import pytest

from benchmarks.bars import judged
from benchmarks.compare import compared
from benchmarks.document import figures, renewed
from benchmarks.plots import CHARTS, Chart, drawn
from benchmarks.run import problems
from benchmarks.table import COLUMNS, table


def _ran(seconds: float, code: int | None = 0) -> dict[str, Any]:
    return {"exit": code, "seconds": seconds, "cpu": seconds, "peak_mb": 100}


def _case(**changes: object) -> dict[str, Any]:
    proof = {"goals": {"verdict": "proved", "proved_by": "z3", "obligations": 3, "seconds": 0.1}}
    return {
        "case": "amr",
        "family": "amr",
        "size": 1,
        "limit": False,
        "unit": _ran(1.0),
        "verdict": "realizable",
        "states": 32,
        "valid": 32,
        "variables": 4,
        "actions": 8,
        "goals": 3,
        "longest_run": 4,
        "allowed_sets": 10,
        "stages": {"parse": 0.1, "encode": 0.2, "extraction": 0.25, "write": 0.5},
        "peak_mb": 90,
        "nodes": 26,
        "rank_nodes": 36,
        "bytes": 5786,
        "digest": "a",
        "synth": _ran(1.2),
        "verify": _ran(0.9),
        "twin": _ran(1.0, 1),
        "proof": proof,
        "reproduced": True,
        **changes,
    }


def _result(**changes: object) -> dict[str, Any]:
    machine = {"cpu": "A", "cores": 2, "memory_gb": 8, "python": "3.11", "versions": {"dd": "0.6"}}
    return {"machine": machine, "unit": _ran(1.0), "help": _ran(0.3), "cases": [_case(**changes)]}


def test_the_table_has_a_cell_for_every_column() -> None:
    """Writing counts as extraction; processes are shown in units, the memory is the most that any process took."""
    line = table(_result()).splitlines()[-1].split()
    assert len(line) == len(COLUMNS)
    cells = dict(zip([name.replace(" ", "") for name in COLUMNS], line, strict=True))
    assert (cells["extraction"], cells["synth"], cells["MB"], cells["provedby"]) == ("0.75", "1.20", "100", "z3")


def test_a_case_without_an_answer_is_shown_as_such() -> None:
    """Neither the table nor the bars hide that a process met the limit."""
    lost = {"case": "amr", "family": "amr", "size": 1, "limit": False, "unit": _ran(1.0), "verdict": "over the limit"}
    result = _result() | {"cases": [lost]}
    assert "over the limit" in table(result)
    assert judged(result).count("MISSED (no answer)") == 2
    assert problems(lost) == ["amr: over the limit"]


def test_bars_are_judged_by_the_clock() -> None:
    """A time within the bar is kept, one above it is missed, and one of a process that failed is no answer."""
    assert judged(_result(synth=_ran(1.0))).count("kept") == 3
    assert "synth" in next(line for line in judged(_result(synth=_ran(1.4))).splitlines() if "MISSED" in line)
    assert "no answer" in judged(_result(verify=_ran(0.1, 3)))


@pytest.mark.parametrize(
    ("changes", "mark"),
    [
        ({"synth": _ran(1.9)}, "synth 1.20 → 1.90 WORSE"),
        ({"synth": _ran(1.3)}, "synth 1.20 → 1.30;"),
        ({"synth": _ran(0.6)}, "synth 1.20 → 0.60 better"),
        ({"verify": _ran(9.0, None)}, "verify 0.90 → – WORSE"),
        ({"bytes": 9000}, "bytes 5,786 → 9,000 WORSE"),
        ({"digest": "b"}, "policy changed"),
    ],
    ids=["slower", "noise", "faster", "lost", "larger", "changed"],
)
def test_a_regression_is_marked(changes: dict[str, object], mark: str) -> None:
    """Growth by more than a quarter is marked, and so is a policy that is not the same."""
    (line,) = compared(_result(), _result(**changes))
    assert mark in line


def test_times_are_compared_in_units() -> None:
    """A machine of half the speed makes nothing worse."""
    slower = _result(synth=_ran(2.4), verify=_ran(1.8), twin=_ran(2.0, 1), unit=_ran(2.0))
    (line,) = compared(_result(), slower)
    assert "WORSE" not in line


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"verify": _ran(1.0, 3)}, "amr: verify did not prove the policy"),
        ({"reproduced": False}, "amr: two runs gave different policies"),
        ({"twin": _ran(1.0, 0)}, "amr: the twin is not called unrealizable (exit 0)"),
        ({"verdict": "undecided"}, "amr: undecided"),
    ],
    ids=["unproved", "different", "twin", "undecided"],
)
def test_a_broken_promise_is_named(changes: dict[str, object], problem: str) -> None:
    """A policy that is not proved, a second one, and a wrong verdict fail the run."""
    assert problems(_case()) == []
    assert problems(_case(**changes)) == [problem]


@pytest.mark.parametrize("chart", CHARTS, ids=lambda chart: chart.name)
def test_charts_are_drawings(chart: Chart) -> None:
    """Every chart is well-formed, and has one point for every case that it knows and that has an answer."""
    result = _result(family=chart.families[0], limit=True)
    result["cases"].append(_case(family=chart.families[0], synth=_ran(9.0, 3)))
    result["cases"].append(_case(family="elsewhere"))
    drawing = ElementTree.fromstring(drawn(chart, result))
    assert len(drawing.findall("{http://www.w3.org/2000/svg}circle")) == 1


def test_the_document_has_the_figures_of_a_run() -> None:
    """What stands between the marks is written anew from a file of results; the rest of the document stays."""
    written = renewed("before\n<!-- figures -->\nold\n<!-- end of figures -->\nafter\n", _result(), "run.json")
    assert written.startswith("before\n<!-- figures -->\n")
    assert written.endswith("\n<!-- end of figures -->\nafter\n")
    assert "old" not in written
    assert renewed(written, _result(), "run.json") == written
    row = next(line for line in figures(_result(), "run.json").splitlines() if line.startswith("| amr |"))
    stages = "extraction 0.75, encode 0.20"
    assert row == f"| amr | 32 | 8 | 10 | {stages} | 0.10 | 100 | 26 | 5,786 | Z3 | 1.20 | 0.90 | 1.00 | – |"


def test_the_document_tells_of_cases_without_an_answer() -> None:
    """They have a row without figures, and the bars say what was missed."""
    lost = {"case": "amr", "family": "amr", "size": 1, "limit": False, "unit": _ran(1.0), "verdict": "over the limit"}
    told = figures(_result() | {"cases": [lost]}, "run.json")
    assert "| amr | over the limit |" in told
    assert "MISSED (no answer)" in told


@pytest.mark.parametrize("valid", [1, 32, 4_611_686_018_427_387_904, 10**40])
def test_axes_reach_every_value(valid: int) -> None:
    """However many states there are, the chart has a mark on either side of them."""
    assert "<circle" in drawn(CHARTS[0], _result(valid=valid))
