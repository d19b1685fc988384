"""Policies that others published are read, proved and asked: the two of a paper, which are no part of the repository.

`TUMATO_IRC2020` names the folder that holds `complete.tum`, `complete-policy.json.zip`, `simplified.tum` and
`simplified-policy.json`; without it these tests are skipped (`CONTRIBUTING.md`).
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from msgspec import Struct

from tests.checker.standalone import CHECKER
from tests.shell import PROGRAM

VARIABLE = "TUMATO_IRC2020"
FOLDER = Path(os.environ.get(VARIABLE, "."))

pytestmark = pytest.mark.skipif(VARIABLE not in os.environ, reason=f"{VARIABLE} names no folder with these files")

MEGABYTES = 1000
"""A command that needs more memory ends without an answer."""

ASKED = 20
"""Rows of a policy that are asked for, evenly spread."""


class Published(Struct, frozen=True):
    """A policy, the smallest specification that it fits, and how many states it decides."""

    policy: Path
    spec: Path
    states: int

    def rows(self) -> list[tuple[dict[str, str], list[str]]]:
        """Some states with what is decided there."""
        rows = json.loads(self.policy.read_text(encoding="utf-8"))["Policy"]
        assert len(rows) == self.states
        return [
            ({name: value for name, value in row.items() if name != "Actions"}, row["Actions"])
            for row in rows[:: len(rows) // ASKED]
        ]


@pytest.fixture(scope="module", params=["simplified", "complete"])
def published(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Published:
    """Values numbered from 1; and 175 MB, packed, values numbered from 0."""
    spec = FOLDER / f"{request.param}.tum"
    if request.param == "simplified":
        return Published(FOLDER / "simplified-policy.json", spec, 64)
    with zipfile.ZipFile(FOLDER / "complete-policy.json.zip") as archive:
        unpacked = archive.extract("complete-policy.json", tmp_path_factory.mktemp("published"))
    return Published(Path(unpacked), spec, 221_184)


def ask(*arguments: str | Path, text: str | None = None) -> str:
    """What a command prints that ends well."""
    ran = subprocess.run([*PROGRAM, *arguments], input=text, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, (ran.returncode, ran.stdout[-500:], ran.stderr[-500:])
    return ran.stdout


def test_it_is_proved(published: Published) -> None:
    """For all its states, in a gigabyte."""
    limit = ("--memory", str(MEGABYTES))
    answer = json.loads(ask("verify", published.policy, published.spec, "--output-format", "json", *limit))
    assert answer["verdict"] == "proved"
    assert answer["valid_states"] == published.states


def test_it_decides_as_it_says(published: Published) -> None:
    """Rows of the file are decided as they are written."""
    rows = published.rows()
    lines = "".join(json.dumps(state) + "\n" for state, _ in rows)
    answers = [json.loads(line) for line in ask("decide", published.policy, "--stdin", text=lines).splitlines()]
    assert [sorted(answer) for answer in answers] == [sorted(actions) for _, actions in rows]


def test_its_rules_speak_of_all_states(published: Published) -> None:
    """In a gigabyte."""
    answer = json.loads(
        ask("show", published.policy, "--format", "rules", "--output-format", "json", "--memory", str(MEGABYTES))
    )
    assert (answer["verdict"], answer["states"]) == ("ok", published.states)


def test_why_it_decides_so(published: Published) -> None:
    """In the state of some row that has actions, in a gigabyte."""
    state, actions = next(row for row in published.rows() if row[1])
    words = [f"{name}={value}" for name, value in state.items()]
    said = ask("why", published.policy, published.spec, *words, "--memory", str(MEGABYTES))
    assert f"decides: {{{', '.join(actions)}}}." in said


def test_both_readers_read_it() -> None:
    """The stand-alone checker judges the small one; the other one takes it minutes."""
    files = FOLDER / "simplified-policy.json", FOLDER / "simplified.tum"
    ran = subprocess.run([sys.executable, CHECKER, *files], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout.count("holds")) == (0, 4)
