"""Pages as they behave in Chromium."""

from __future__ import annotations

import re
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
    assert right["filtered"] == "8 of 32 states"
    assert (right["lit"], right["steps"]) == (1, 1)
    assert right["boxes"] == 8
    assert right["itf"]["vars"][:2] == ["S_Location", "S_Battery"]
    assert len(right["itf"]["states"]) == 2
    for line in [line for line in cli("diff", "amr.json", "slower.json").out.splitlines() if line[:1].strip()]:
        assert line in right["compared"]
    for each in (right, wrong):
        assert each["wider"] == 0, "no wider than a phone"
        assert each["turned"] == "tab-table", "by the arrow keys, round and round"
        assert each["visited"] == [False, True, False], "to the state, and back"
    assert "Refuted" in wrong["title"]
    assert "1 are wrong" in wrong["check"]
    assert "would be restored better by stop_conveyor" in wrong["check"]
    assert wrong["compared"] == cli("diff", "slower.json", "slower.json").out.strip()
    assert "There is no policy: proved by" in none["title"]
    assert "all 112 states said to fail do fail, so there is no policy" in none["check"]
    assert "they suffice for that, and none of them can be left out" in none["check"]
    assert "Not checked by this page: whether more states fail; what would help" in none["check"]
    assert "These lines together suffice" in none["reasons"]
    assert "THEN S_Conv1 is off` (line 114)" in none["reasons"]
    assert none["line"]


@needs_browser
def test_a_page_contradicts_what_is_not_so(cli: Cli, tmp_path: Path) -> None:
    """A page whose specification has no state rules says that no state fails for them."""
    assert cli("synth", "two_robots.tum", "-o", "no.json", "--html", "no.html").code == 1
    page = tmp_path / "no.html"
    page.write_text(re.sub(r'"state_rules":\[.*?\],"assumptions"', '"state_rules":[],"assumptions"', page.read_text()))
    (none,) = seen([(page, page)])
    assert "This page finds that 112 states do not fail as is said" in none["check"]


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
