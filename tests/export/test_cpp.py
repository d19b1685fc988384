"""Policies in C++, compiled by the C++ compiler that is found here."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.c_compiler import compile_cpp, needs_cxx
from tests.export.mixed import FROM_STARTS, mixed
from tests.export.policies import (
    EXAMPLES,
    decisions,
    example,
    expected_lines,
    exported,
    random_request,
    request,
    write,
    written,
)
from tumato_symbolic.export import c_decisions, cpp
from tumato_symbolic.export.request import Request

_DRIVER = """\
#include "{name}.hpp"
#include <cstdio>

int main()
{{
    for (;;) {{
        int value = 0;
        {namespace}::State state{{}};
{reads}        const {namespace}::Decision decision = {namespace}::decide(state);
        switch (decision.status) {{
        case {namespace}::Status::invalid: std::fputs("invalid", stdout); break;
        case {namespace}::Status::undecided: std::fputs("undecided", stdout); break;
        case {namespace}::Status::decided: std::fputs("decided", stdout); break;
        }}
        unsigned count = 0u;
        for (const auto action : {namespace}::all_actions) {{
            if (decision.actions.contains(action)) {{
                std::printf(" %u", static_cast<unsigned>(action));
                ++count;
            }}
        }}
        if ((count == 0u) != decision.actions.empty()
            || decision.actions.contains(static_cast<{namespace}::Action>({namespace}::all_actions.size()))
            || decision.actions.contains(static_cast<{namespace}::Action>(-1))) {{
            std::fputs(" wrong", stdout);
        }}
        std::puts("");
    }}
}}
"""


def driver(made: Request) -> str:
    """A program that reads the values of states, one after the other, and prints what is decided."""
    names = cpp.Names.of(made)
    reads = "".join(
        '        if (std::scanf("%d", &value) != 1) {\n            return 0;\n        }\n'
        f"        state.{field} = static_cast<{names.namespace}::{type_}>(value);\n"
        for field, type_ in zip(names.fields, names.types, strict=True)
    )
    return _DRIVER.format(name=made.name, namespace=names.namespace, reads=reads)


def answers(made: Request, states: Sequence[Sequence[int]], folder: Path) -> list[str]:
    """What the compiled policy prints about states: its status, and the numbers of the actions."""
    write(folder, made, cpp.files(made), (".hpp",))
    source = folder / "driver.cpp"
    source.write_text(driver(made))
    asked = "\n".join(" ".join(map(str, state)) for state in states)
    ran = subprocess.run([compile_cpp([source], folder)], input=asked, capture_output=True, text=True, check=True)
    return ran.stdout.splitlines()


def _compare(made: Request, folder: Path) -> None:
    assert answers(made, [state for state, _ in decisions(made)], folder) == expected_lines(made)


@needs_cxx
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_decides_as_decide_does(name: str, tmp_path: Path) -> None:
    """In every state."""
    _compare(example(name), tmp_path)


@needs_cxx
def test_policies_from_starts(tmp_path: Path) -> None:
    """Decided states have their actions, all others the status that says so."""
    policy = exported(mixed(FROM_STARTS[0])[0])
    assert "undecided" in expected_lines(policy)
    _compare(policy, tmp_path)


@needs_cxx
@pytest.mark.parametrize("seed", range(8))
def test_random_policies_with_nasty_names(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keywords, names of ours; undecided states; more actions than bits in a word; as Boolean functions."""
    made = random_request(seed)
    if seed % 3 == 0:
        monkeypatch.setattr(c_decisions, "MOST_ANSWERS", 0)
    _compare(replace(made, name=("int", "a-b", "std", "UPPER", "State")[seed % 5]), tmp_path)


@needs_cxx
def test_names_of_the_header_itself(tmp_path: Path) -> None:
    """Variables, values and actions may be called like the namespace, like types and like functions of the header."""
    ours = (
        "State",
        "Action",
        "Actions",
        "name",
        "decide",
        "Status",
        "detail",
        "state",
        "actions",
        "n0",
        "v0",
        "policy",
    )
    spec = written(dict.fromkeys(ours, "State, policy, Action"), ["policy_", "insert", "each", "words_", "all_actions"])
    made = replace(request(spec, {(0,) * len(ours): frozenset({1, 3})}), name="policy")
    states = [(0,) * len(ours), (1,) * len(ours)]
    assert answers(made, states, tmp_path) == ["decided 1 3", "undecided"]


@needs_cxx
def test_values_out_of_range_are_invalid(tmp_path: Path) -> None:
    """Each input is checked, and no action is in the set then."""
    good = (0, 0, 0, 0)
    bad = [(*good[:place], value, *good[place + 1 :]) for place in range(4) for value in (4, -1, 2**31 - 1)]
    assert answers(example("amr"), [good, *bad], tmp_path) == ["decided 6"] + ["invalid"] * len(bad)


@needs_cxx
def test_to_do_nothing_is_a_decision(tmp_path: Path) -> None:
    """An empty set is told from an undecided state by the status alone."""
    spec = written({"S": "a, b"}, ["act"])
    assert answers(request(spec, {(0,): frozenset()}), [(0,), (1,)], tmp_path) == ["decided", "undecided"]


@needs_cxx
def test_decisions_are_constants(tmp_path: Path) -> None:
    """What a robot's engineer counts on can be asserted when it is compiled; a field that is not set is invalid."""
    made = replace(example("amr"), name="amr")
    write(tmp_path, made, cpp.files(made), (".hpp",))
    (tmp_path / "user.cpp").write_text("""\
#include "amr.hpp"
#include <string_view>
using namespace amr;
constexpr State start{S_Location::corridor, S_Battery::low, S_Load::free, S_Conveyor::on};
static_assert(decide(start).status == Status::decided);
static_assert(decide(start).actions.contains(Action::stop_conveyor));
static_assert(decide(State{}).status == Status::invalid);
static_assert(decide({S_Location::corridor, S_Battery::low, S_Load::free}).status == Status::invalid);
static_assert(name(Action::charge) == std::string_view{"charge"});
int main() { return 0; }
""")
    compile_cpp([tmp_path / "user.cpp"], tmp_path)
