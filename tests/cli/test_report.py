"""`report` and `synth --html` write pages."""

from __future__ import annotations

from pathlib import Path

from tests.cli.conftest import Cli
from tests.page.pages import carried


def test_report_writes_a_page(cli: Cli, tmp_path: Path) -> None:
    """Of a policy, with the verdict of `verify` as exit code; of a refuted one as well."""
    assert cli("report", "amr.json", "amr.tum").code == 0
    data = carried((tmp_path / "report.html").read_text(encoding="utf-8"))
    assert data["verdict"]["by"] == "Z3"
    assert len(data["rules"]["list"]) > 5
    refuted = cli("report", "unsafe.json", "amr.tum", "-o", "-")
    assert refuted.code == 1
    assert carried(refuted.out)["verdict"]["verdict"] == "refuted"


def test_report_of_a_specification_without_a_policy(cli: Cli, tmp_path: Path) -> None:
    """The lines to blame, what would help, and who proved it; `synth --html` writes the same."""
    assert cli("synth", "two_robots.tum", "-o", "no.json", "--html", "synth.html").code == 1
    assert cli("report", "no.unrealizable.json", "two_robots.tum").code == 0
    first, second = (carried((tmp_path / name).read_text(encoding="utf-8")) for name in ("report.html", "synth.html"))
    assert first["no"] == second["no"]
    assert first["verdict"]["verdict"] == "proved"
    assert first["no"]["repairs"]


def test_synth_writes_a_page(cli: Cli, tmp_path: Path) -> None:
    """The same as `report` of the policy that it writes."""
    assert cli("synth", "amr.tum", "-o", "made.json", "--html", "made.html").code == 0
    assert cli("report", "made.json", "amr.tum").code == 0
    assert (tmp_path / "made.html").read_text() == (tmp_path / "report.html").read_text()
