"""A reader of the forklift's page: what is asked there and what the page answers, in Chromium."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final, TypeAlias

import pytest

from tests.page.in_browser import missing, read
from tests.page.test_page import page_of
from tests.repo.documents import ROOT

pytestmark = pytest.mark.skipif(missing() is not None, reason=f"pages are not opened here: {missing()}")

Act: TypeAlias = tuple[object, ...]

SOURCE = ROOT / "examples" / "forklift.tum"


def text(selector: str) -> Act:
    """What stands there."""
    return "text", selector


def click(selector: str) -> Act:
    """Press it."""
    return "click", selector


def choose(variable: str, value: str) -> Act:
    """Another value in the chosen state."""
    return "choose", _select(variable), value


def value(variable: str) -> Act:
    """The number of the value in the chosen state."""
    return "property", _select(variable), "value"


def _select(variable: str) -> str:
    return f".state select[aria-label={variable}]"


def chip(variable: str, name: str) -> Act:
    """Press a value in the filter."""
    return click(f'.chip[title="{variable} is {name}"]')


AT_A_PERSON: Final = (
    choose("S_Person", "near"),
    choose("S_Place", "aisle_west"),
    choose("S_Speed", "fast"),
    choose("S_Battery", "low"),
    choose("S_Beacon", "on"),
)
RESULTS: Final = text("#panel-execution ul")
EXECUTED: Final = (click("[data-key=execute]"), RESULTS)
CHANCE: Final = text("[data-key=chance]")
CLEAR: Final = click(".filter button:has-text('clear')")
TOP: Final = ("property", ".state", "scrollTop")
WIDE: Final = "#panel-text .wide"

IN_TURN: Final[dict[str, tuple[Act, ...]]] = {
    "filter": (
        value("S_EStop"),
        *(chip("S_EStop", "pressed"), value("S_EStop")),
        *(chip("S_EStop", "pressed"), value("S_EStop")),
        *(chip("S_EStop", "pressed"), CLEAR, value("S_EStop")),
        *(chip("S_Battery", "low"), click(".filter .quiet .link"), text(".variable .chip[aria-pressed=true]")),
        *(value("S_Battery"), value("S_Person")),
        *(click("#panel-table .link"), CLEAR, value("S_Person")),
    ),
    "scroll": (("scroll", ".state", 150), TOP, click("#panel-table tr:not(.chosen) .link"), TOP),
    "state": (*AT_A_PERSON, text(".state details:has-text('Goals') a.line"), text(".state")),
    "chance": (
        *(click("#tab-execution"), CHANCE, text(".choices button")),
        *(choose("S_Speed", "slow"), CHANCE),
    ),
    "executions": (
        *EXECUTED,
        *(choose("S_Person", "clear"), RESULTS, *EXECUTED),
        *(chip("S_Battery", "low"), RESULTS, *EXECUTED),
        *(click("label:has-text('disturbances') input"), RESULTS, *EXECUTED),
    ),
    "listing": (click("#tab-text"), ("property", WIDE, "scrollWidth"), ("property", WIDE, "clientWidth")),
}


def readings(page: Path) -> dict[str, list[Any]]:
    """What is read, by what is done."""
    found = iter(read(page, [act for acts in IN_TURN.values() for act in acts]))
    return {name: [next(found) for act, *_ in acts if act in ("text", "property")] for name, acts in IN_TURN.items()}


def test_what_a_reader_asks(tmp_path: Path) -> None:
    """One page, asked everything in turn: to open it takes longer than to ask."""
    page = tmp_path / "forklift.html"
    page.write_text(page_of(SOURCE.name, SOURCE.read_text(encoding="utf-8")), encoding="utf-8")
    found = readings(page)
    assert found["filter"] == ["0", "1", "0", "0", "near", "0", "1", "1"], "only a state chosen meanwhile stays"
    assert found["scroll"] == [150, 0], "another state is shown from its head"
    the_state_in_front_of_a_person(*found["state"])
    several, buttons, one = found["chance"]
    assert (several, one) == ("by chance", ""), "to stop cannot fail, to brake may do more than is intended"
    assert "or instead: S_Speed is stopped" in buttons
    the_results(found["executions"])
    assert found["listing"][0] == found["listing"][1], "nothing is to the right of what is seen"


def the_state_in_front_of_a_person(line: str, whole: str) -> None:
    """The goal has its own line, though an earlier one reads the same; severities and outcomes are named."""
    written = SOURCE.read_text(encoding="utf-8").splitlines()[int(line.removeprefix("line ")) - 1]
    assert written == "when S_Person is near then goal: true"
    assert "After 2 steps safety is restored." in whole
    assert "as intended: S_Speed is slow unsafe" in whole
    assert "or it may instead: S_Speed is stopped" in whole
    assert "the rules of severity 1 hold again after at most 2 steps, which take at most 2 in all." in whole


def the_results(found: list[str]) -> None:
    """Counts of executions go when the state, the filter or the way of executing is another."""
    before, after = found[1::2], found[::2]
    assert before == [""] * 3
    assert all("of 1,000" in each for each in after)
    safe = "no step of the policy led from a safe state to an unsafe one"
    assert after[0].endswith(f"{safe} (disturbances are not counted)")
    assert after[-1].endswith(safe)
