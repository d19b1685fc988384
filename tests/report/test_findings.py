"""Findings for programs."""

from typing import Any

from tumato_symbolic.diagnostics import Code, Diagnostic, Note, Span
from tumato_symbolic.report.findings import Finding, as_github, finding_json, findings_of
from tumato_symbolic.report.sarif import as_sarif


def test_workflow_commands_are_escaped() -> None:
    """Percent signs and line ends are escaped in messages, colons and commas in properties too."""
    found = Finding("error", "100% wrong:\r\na, b", "dir,x:y.tum", Span(3, 5, 3, 9), "TUM1,2")
    assert as_github([found]) == (
        "::error file=dir%2Cx%3Ay.tum,line=3,endLine=3,col=5,endColumn=9,title=TUM1%2C2::100%25 wrong:%0D%0Aa, b"
    )


def test_a_command_without_a_place() -> None:
    """Without a file there are no properties and no stray space."""
    assert as_github([Finding("notice", "done")]) == "::notice::done"


def test_a_span_of_several_lines_has_no_end_column() -> None:
    """GitHub takes `endColumn` on one line only."""
    assert "endColumn" not in as_github([Finding("error", "x", "f", Span(1, 2, 3, 4))])


def test_warnings_are_warnings_and_tell_the_way_out() -> None:
    """The severity is the command; the help follows the message."""
    unused = Diagnostic(Code.TUM321, "unused", Span(1, 1, 1, 2), help="remove it")
    text = as_github(findings_of([unused], "a.tum"))
    assert text.startswith("::warning file=a.tum,line=1")
    assert text.endswith("::unused%0Aremove it")


def test_a_finding_as_json() -> None:
    """Every field is there, with null where nothing is known."""
    found = finding_json(
        Diagnostic(Code.TUM203, "twice", Span(4, 1, 4, 6), notes=(Note("first", Span(2, 1, 2, 6)),)), "a"
    )
    assert found == {
        "code": "TUM203",
        "severity": "error",
        "message": "twice",
        "help": None,
        "file": "a",
        "line": 4,
        "column": 1,
        "end_line": 4,
        "end_column": 6,
        "notes": [{"message": "first", "line": 2, "column": 1, "end_line": 2, "end_column": 6}],
    }
    assert finding_json(Diagnostic(Code.TUM101, "no file"), None)["line"] is None


def test_sarif_has_errors_and_warnings_and_their_kinds() -> None:
    """A notice is no result; what has no code is known by its title; notes are related places."""
    twice = Diagnostic(Code.TUM203, "twice", Span(4, 1, 4, 6), notes=(Note("first", Span(2, 1, 2, 6)),))
    late = Finding("error", "too late", "p q.json", title="goals refuted")
    log: Any = as_sarif([*findings_of([twice], "a.tum"), late, late, Finding("notice", "done")])
    (run,) = log["runs"]
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == ["TUM203", "goals-refuted"]
    assert [result["ruleId"] for result in run["results"]] == ["TUM203", "goals-refuted", "goals-refuted"]
    first, second, _ = run["results"]
    assert first["relatedLocations"][0]["message"] == {"text": "first"}
    assert second["locations"] == [{"physicalLocation": {"artifactLocation": {"uri": "p%20q.json"}}}]
