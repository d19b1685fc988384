"""What the playground asks of the package, what it is put together from, and how it behaves in a browser."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path
from typing import Any

import pytest

from playground.assemble import HERE, PAGE_FILES
from playground.session import Session, check
from tests.cli.conftest import Cli, cli
from tests.page.pages import carried
from tests.playground.in_browser import AMR, WRONG, missing, used
from tests.repo.documents import ROOT

__all__ = ["cli"]

TWO_ROBOTS = (ROOT / "examples" / "two_robots.tum").read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def _as_in_a_browser(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """No child processes and no Z3."""
    if "cli" in request.fixturenames:
        return
    monkeypatch.delattr(os, "fork")
    monkeypatch.setitem(sys.modules, "z3", None)


def solved(text: str) -> tuple[dict[str, Any], str, list[str]]:
    """The answer, the page, and the stages that were told."""
    session, stages = Session(), list[str]()
    answer: dict[str, Any] = json.loads(session.solve(text, stages.append))
    return answer, session.report(stages.append), stages


def test_mistakes_are_placed_in_units_of_browsers() -> None:
    """A character beyond the basic plane counts twice, as in JavaScript."""
    (found,) = json.loads(check("/* \U0001f916 */ " + WRONG.replace("\nstate", " state", 1)))
    assert (found["severity"], found["code"]) == ("error", "TUM201")
    line, column = found["range"][0]
    lines = ("/* \U0001f916 */ " + WRONG.replace("\nstate", " state", 1)).split("\n")
    assert lines[line][column:].startswith("S_Batery")
    (first,) = json.loads(check("/* \U0001f916 */ ?" + AMR))[:1]
    assert first["range"][0] == [0, 9]


def test_a_policy_is_proved_by_the_walk() -> None:
    """The answer has the bytes of the committed policy, and a page about it."""
    answer, page, stages = solved(AMR)
    assert answer["verdict"] == "realizable"
    assert "proved by the walk" in answer["lines"][0]
    assert answer["files"] == {"policy.json": (ROOT / "proofs" / "amr.policy.json").read_text(encoding="utf-8")}
    assert "<!DOCTYPE html>" in page
    assert any("proving" in stage for stage in stages)


def test_where_there_is_none_the_certificate_is_given() -> None:
    """Without Z3 the stand-alone checker judges it, and nobody is told to install that in a browser."""
    answer, page, _ = solved(TWO_ROBOTS)
    assert answer["verdict"] == "unrealizable"
    assert answer["lines"][1].endswith("(no-allowed-set): proved by the stand-alone checker.")
    verdict = carried(page)["verdict"]
    assert (verdict["verdict"], verdict["by"]) == ("proved", "the stand-alone checker")
    assert list(answer["files"]) == ["policy.unrealizable.json"]
    assert "pip install" not in page + json.dumps(answer)


def test_a_certificate_that_is_too_much_is_said_to_be_unchecked(monkeypatch: pytest.MonkeyPatch) -> None:
    """And one that is wrong is refuted."""
    monkeypatch.setattr("proofs.checker.main", lambda _: 3)
    assert "too much for the stand-alone checker" in solved(TWO_ROBOTS)[0]["lines"][1]
    monkeypatch.setattr("proofs.checker.main", lambda _: print("unrealizable FAILS: no") or 1)
    answer, page, _ = solved(TWO_ROBOTS)
    assert answer["lines"][1] == "Not proved: unrealizable FAILS: no."
    assert carried(page)["verdict"]["verdict"] == "refuted"


@pytest.mark.parametrize(
    "text",
    [
        WRONG,
        "",
        AMR.replace(
            "BEGIN GOALS",
            "BEGIN ASSUMPTIONS\nassumption: S_Load is free, S_Load is loaded\nEND ASSUMPTIONS\nBEGIN GOALS",
        ),
    ],
)
def test_mistakes_are_an_answer(text: str) -> None:
    """Also those that only synthesis finds; there is no page then."""
    answer, page, _ = solved(text)
    assert answer["verdict"] == "mistakes"
    assert answer["problems"]
    assert (answer["files"], page) == ({}, "")


def test_every_file_of_the_page_is_copied() -> None:
    """What is imported, and what the page names."""
    texts = "".join(path.read_text(encoding="utf-8") for path in (*HERE.glob("*.mjs"), HERE / "index.html"))
    named = set(re.findall(r'"(?:\./)?(\w+\.(?:mjs|css))"', texts))
    assert named == set(PAGE_FILES)


@pytest.mark.skipif(missing() is not None, reason=f"the playground is not opened here: {missing()}")
def test_it_works_in_a_browser(cli: Cli, tmp_path: Path) -> None:
    """Typed, marked, synthesized, proved, judged by the page, shared, cancelled; the bytes are those of `synth`."""
    assert cli("synth", "amr.tum", "-o", "amr.json").code == 0
    found = used(tmp_path / "build")
    assert (found["errors"], found["requests"]) == ([], [])
    assert found["policy"] == (tmp_path / "amr.json").read_text(encoding="utf-8")
    assert "proved for all 32 valid states" in found["verdict"]
    assert "found nothing wrong" in found["check"]
    assert found["line"]
    assert "TUM201" in found["problems"][0]
    assert (found["marked"], found["numbered"]) == (["S_Batery"], ["85"])
    assert "mistakes" in found["refused"]
    assert found["shared"] == WRONG
    assert "There is no policy" in found["none"]
    assert "proved for all 9 valid states" in found["afterwards"]
