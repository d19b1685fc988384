"""The node of the example for ROS 2, with headers that stand for those of ROS: no ROS is needed, and none is tried."""

from __future__ import annotations

import re
import subprocess
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.c_compiler import compile_cpp, needs_cxx
from tests.export.policies import decisions, example, write
from tests.export.ros2.loop import PACKAGE
from tests.repo.documents import ROOT
from tumato_symbolic.export import cpp

_STUBS = ROOT / "tests" / "export" / "ros2"
_LIMITS = "limits{1s, 10min, 30s}"

ON = "s corridor low free on"
OFF = "s corridor low free off"
"""Here it stops its conveyor, there it drives to the charger."""


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The node, driven by lines; it waits for ever, for machines that test may be slow."""
    folder = tmp_path_factory.mktemp("node")
    (folder / "amr_policy").mkdir()
    made = replace(example("amr"), name="amr")
    write(folder / "amr_policy", made, cpp.files(made), (".hpp",))
    source = (PACKAGE / "src" / "node.cpp").read_text()
    assert source.count(_LIMITS) == 1
    (folder / "node.cpp").write_text(source.replace(_LIMITS, "limits{24h, 24h, 24h}"))
    places = [folder, _STUBS / "stubs", PACKAGE / "include"]
    return compile_cpp([_STUBS / "drive.cpp"], folder, [f"-I{place}" for place in places])


def drive(node: Path, lines: Sequence[str]) -> tuple[list[str], list[str]]:
    """What there is after each line: goals and cancels of actions, whether a state is asked for; and what is logged."""
    ran = subprocess.run([node], input="\n".join(lines), capture_output=True, text=True, check=True)
    return ran.stdout.splitlines(), ran.stderr.splitlines()


@needs_cxx
def test_it_starts_what_the_policy_decides(node: Path) -> None:
    """In every state, given by the words of the specification."""
    made = example("amr")
    lines, expected = [], []
    for state, actions in decisions(made):
        words = [made.policy.vocabulary.variables[place][1][value] for place, value in enumerate(state)]
        assert actions is not None
        (action,) = actions
        lines += ["t", f"s {' '.join(words)}", f"y {action}", f"r {action} 4"]
        expected.append(f"start {action}")
    assert drive(node, lines)[1] == expected


@needs_cxx
def test_it_halts_before_it_starts_something_else(node: Path) -> None:
    """What was seen before the result is not enough: the state is asked for once more."""
    lines = ["t", ON, "y stop_conveyor", "t", OFF, "t", "r stop_conveyor 5", OFF, "t", OFF]
    seen, logged = drive(node, lines)
    assert logged == ["start stop_conveyor", "halt stop_conveyor", "start move_to_charger"]
    assert seen[4:] == [
        "stop_conveyor 1 1 idle",
        "stop_conveyor 1 1 asked",
        "stop_conveyor 1 1 asked",
        "stop_conveyor 1 1 idle",
        "stop_conveyor 1 1 asked",
        "move_to_charger 1 0 stop_conveyor 1 1 idle",
    ]


@needs_cxx
def test_what_is_accepted_after_it_was_halted_is_cancelled_again(node: Path) -> None:
    """The first time the goal may not have been there; a rejected one has never begun."""
    begun = ["t", ON, "t", OFF]
    accepted, _ = drive(node, [*begun, "y stop_conveyor", "t", OFF])
    assert accepted[3:5] == ["stop_conveyor 1 1 idle", "stop_conveyor 1 2 idle"]
    _, logged = drive(node, [*begun, "n stop_conveyor", "t", OFF])
    assert logged[-1] == "start move_to_charger"


@needs_cxx
def test_an_unknown_result_is_no_end(node: Path) -> None:
    """Nobody knows what the action still does: nothing else is started."""
    _, logged = drive(node, ["t", ON, "y stop_conveyor", "r stop_conveyor 0", "t", OFF, "t", OFF])
    assert logged == ["start stop_conveyor", "halt stop_conveyor"]


@needs_cxx
def test_it_waits_for_the_robot(node: Path) -> None:
    """Before all servers are there, it does not even ask."""
    assert drive(node, ["d", "t", "u", "t"])[0] == ["idle", "idle", "idle", "asked"]


@needs_cxx
def test_words_that_it_does_not_know_stop_it(node: Path) -> None:
    """It says why, and asks no more."""
    for word in ("corridor free low on", "nowhere low free on", "corridor low free ON"):
        seen, logged = drive(node, ["t", OFF, "y move_to_charger", "t", f"s {word}", "t"])
        assert seen[-1] == "move_to_charger 1 1 idle"
        assert logged[-1] == "stopped: the state has a value that it cannot have. Call somebody."


def test_the_package_names_what_the_node_includes() -> None:
    """In package.xml and CMakeLists.txt; and the fields that it reads are those of the service."""
    source, build = (PACKAGE / "src" / "node.cpp").read_text(), (PACKAGE / "CMakeLists.txt").read_text()
    package = ET.parse(PACKAGE / "package.xml").getroot()
    named = {each.text for each in package if each.tag.endswith("depend")}
    libraries = set(re.findall(r"#include <(\w+)/", source))
    assert libraries == {"rclcpp", "rclcpp_action"}
    assert libraries <= named
    assert all(f"find_package({each} REQUIRED)" in build and f"{each}::{each}" in build for each in libraries)
    for made in re.findall(r'"((?:action|srv)/\w+\.\w+)"', build):
        assert (PACKAGE / made).is_file()
    fields = re.findall(r"^string (\w+)$", (PACKAGE / "srv" / "GetState.srv").read_text(), re.MULTILINE)
    assert re.findall(r"said\.(\w+)", source) == fields
