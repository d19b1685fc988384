"""`verify --guarantees`, and what `why` says of one state."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Cli
from tumato_symbolic.explain import guaranteed
from tumato_symbolic.verify.guarantees import analyse
from tumato_symbolic.verify.guarantees.result import Guarantees

SPEC = """
BEGIN STATE VECTOR
  state S_Place can be start, goal
  state S_Tank can be full, low, empty
END STATE VECTOR
BEGIN ACTIONS
  action drive
    preconditions: S_Place is start, S_Tank is full
    nominal effects: S_Place is goal
    alternative effects: S_Tank is low
  action crawl
    preconditions: S_Place is start, S_Tank is low
    nominal effects: S_Place is goal
    alternative effects: S_Tank is empty
END ACTIONS
BEGIN GOALS goal type: priority
  when NOT S_Tank is empty then goal: S_Place is goal
END GOALS
"""


def _proved(cli: Cli) -> tuple[str, ...]:
    Path("tank.tum").write_text(SPEC, encoding="utf-8")
    assert cli("synth", "tank.tum", "-o", "tank.json").code == 0
    return "verify", "tank.json", "tank.tum", "--guarantees"


def test_levels_are_told_with_an_example(cli: Cli) -> None:
    """One line a level, and moves that lead to where another goal is active."""
    ran = cli(*_proved(cli))
    assert ran.code == 0
    assert "1 valid state: survives 1 deviation" in ran.out
    assert "where S_Place is start, S_Tank is full" in ran.out
    assert "the nominal run from there never meets the goal; its goal is none" in ran.out


def test_levels_for_a_program(cli: Cli) -> None:
    """All valid states, each in one level; the key is there only when it is asked for."""
    command = _proved(cli)
    found = json.loads(cli(*command, "--output-format", "json").out)["guarantees"]
    assert (found["status"], found["reason"]) == ("known", None)
    told = [(each["level"], each["steps"], each["deviations"], each["states"]) for each in found["levels"]]
    assert told == [("guaranteed", 1, None, 4), ("survives", None, 1, 1), ("nominal", None, None, 1)]
    assert found["levels"][1]["cubes"] == [{"S_Place": ["start"], "S_Tank": ["full"]}]
    example = found["levels"][1]["example"]
    assert [each["after"]["S_Tank"] for each in example["moves"]] == ["low", "empty"]
    assert (example["loop"], len(example["rest"])) == (None, 2)
    assert "guarantees" not in json.loads(cli(*command[:-1], "--output-format", "json").out)


def test_why_tells_the_level_of_a_state(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same level; nothing where too much can follow."""
    _proved(cli)
    command = ("why", "tank.json", "tank.tum", "S_Place=start", "S_Tank=full")
    ran = cli(*command)
    assert "Survives 1 deviation: the goal is met with that many in the whole run, but" in ran.out
    told = json.loads(cli(*command, "--output-format", "json").out)["guarantee"]
    assert (told["level"], told["deviations"], len(told["why_no_more"]["moves"])) == ("survives", 1, 2)
    monkeypatch.setattr(guaranteed, "MOST_OUTCOMES", 2)
    assert "Too much can follow" in cli(*command).out
    assert json.loads(cli(*command, "--output-format", "json").out)["guarantee"] is None


def test_undecided_is_3(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it is not found out, the exit code is 3, although the policy is proved."""
    command = _proved(cli)
    monkeypatch.setattr(analyse, "guarantees", lambda *_, **__: Guarantees("undecided", reason="too large"))
    ran = cli(*command)
    assert (ran.code, "guarantees: undecided (too large)" in ran.out) == (3, True)
    found = json.loads(cli(*command, "--output-format", "json").out)
    assert (found["verdict"], found["guarantees"]["status"], found["guarantees"]["levels"]) == (
        "proved",
        "undecided",
        [],
    )
    assert (
        "::error file=tank.json,title=guarantees undecided::guarantees undecided: too large"
        in cli(*command, "--output-format", "github").out
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((".", "--guarantees"), "one policy and its specification"),
        (("amr.json", "amr.tum", "--guarantees", "--properties", "safe,goals"), "needs them among the properties"),
    ],
)
def test_wrong_usage(cli: Cli, arguments: tuple[str, ...], said: str) -> None:
    """A folder, and properties that the levels build on."""
    ran = cli("verify", *arguments)
    assert (ran.code, said in ran.err) == (2, True)


def test_a_certificate_is_written_where_it_is_asked_for(cli: Cli) -> None:
    """To a file, which asks for the levels as well, or to the standard output, with the report beside it."""
    command = _proved(cli)[:-1]
    ran = cli(*command, "--write-guarantees", "shown.json")
    assert (ran.code, "survives 1 deviation" in ran.out) == (0, True)
    text = Path("shown.json").read_text(encoding="utf-8")
    assert json.loads(text)["Type"] == "guarantees"
    ran = cli(*command, "--write-guarantees", "-")
    assert (ran.code, ran.out) == (0, text)
    assert "survives 1 deviation" in ran.err


def test_a_certificate_is_not_written_where_nothing_is_proved(cli: Cli) -> None:
    """Of a policy that is refuted there is nothing to show."""
    ran = cli("verify", "slower.json", "amr.tum", "--write-guarantees", "shown.json")
    assert (ran.code, Path("shown.json").exists()) == (1, False)
