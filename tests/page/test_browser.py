"""Pages as they behave in Chromium."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Cli, cli
from tests.page.in_browser import missing, seen
from tests.repo.documents import ROOT

__all__ = ["cli"]

needs_browser = pytest.mark.skipif(missing() is not None, reason=f"pages are not opened here: {missing()}")


@needs_browser
def test_pages_open_filter_step_and_compare(cli: Cli, tmp_path: Path) -> None:
    """Without an error and without a request; the page says what it found itself."""
    assert cli("report", "amr.json", "amr.tum", "-o", "amr.html").code == 0
    assert cli("report", "slower.json", "amr.tum", "-o", "slower.html").code == 1
    assert cli("synth", "two_robots.tum", "-o", "no.json", "--html", "no.html").code == 1
    amr, slower = tmp_path / "amr.json", tmp_path / "slower.json"
    pages = [(tmp_path / "amr.html", slower), (tmp_path / "slower.html", slower), (tmp_path / "no.html", amr)]
    right, wrong, none = seen(pages)
    for each in (right, wrong, none):
        assert (each["errors"], each["requests"]) == ([], [])
    assert "Proved by Z3, for all 32 valid states" in right["title"]
    assert "checked 32 decisions and their runs itself, and found nothing wrong" in right["check"]
    assert right["filtered"] == "8 of 32 decided states"
    assert (right["lit"], right["steps"]) == (1, 1)
    assert right["boxes"] == 8
    assert right["itf"]["vars"][:2] == ["S_Location", "S_Battery"]
    assert len(right["itf"]["states"]) == 2
    assert "slower.json decides otherwise in 1 state:" in right["compared"]
    assert "Refuted" in wrong["title"]
    assert "1 are wrong" in wrong["check"]
    assert "would be restored better by stop_conveyor" in wrong["check"]
    assert "slower.json decides the same everywhere" in wrong["compared"]
    assert "There is no policy: proved by" in none["title"]
    assert "tried all" in none["check"]
    assert "These lines together suffice" in none["reasons"]
    assert none["line"]


@needs_browser
def test_what_a_policy_leaves_out_is_shown(cli: Cli, tmp_path: Path) -> None:
    """With starts: the states that are not decided are told from those where nothing is done."""
    document = (ROOT / "docs" / "starts.md").read_text(encoding="utf-8")
    (tmp_path / "tyre.tum").write_text(document.split("```tumato file=tyre.tum\n")[1].split("```")[0], encoding="utf-8")
    assert cli("synth", "tyre.tum", "-o", "tyre.json", "--html", "tyre.html").code == 0
    (tyre,) = seen([(tmp_path / "tyre.html", tmp_path / "tyre.json")])
    assert (tyre["errors"], tyre["requests"]) == ([], [])
    assert "checked 8 decisions" in tyre["check"]
    assert "found nothing wrong" in tyre["check"]
    assert "not decided 4" in tyre["decisions"]
