"""Policies in C, compiled by the C compiler that is found here."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.c_compiler import compile_c, needs_cc
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
from tumato_symbolic.export import c99, c_decisions
from tumato_symbolic.export.c99_names import Names
from tumato_symbolic.export.request import Request

_DRIVER = """\
#include "{name}.h"
#include <stdio.h>

int main(void)
{{
    int value;
    for (;;) {{
        {p}_state state;
        {p}_actions actions;
        unsigned action;
{reads}        switch ({p}_decide(&state, &actions)) {{
        case {u}_INVALID: fputs("invalid", stdout); break;
        case {u}_UNDECIDED: fputs("undecided", stdout); break;
        case {u}_DECIDED: fputs("decided", stdout); break;
        }}
        for (action = 0; action < {u}_ACTION_COUNT + 3u; action++) {{
            if ({p}_executes(&actions, ({p}_action)action)) printf(" %u", action);
        }}
        puts("");
    }}
}}
"""


def answers(made: Request, states: Sequence[Sequence[int]], folder: Path) -> list[str]:
    """What the compiled policy prints about states: its status, and the numbers of the actions."""
    names = Names.of(made)
    reads = "".join(
        f'        if (scanf("%d", &value) != 1) return 0;\n        state.{field} = ({type_})value;\n'
        for field, type_ in zip(names.fields, names.types, strict=True)
    )
    source, _ = write(folder, made, c99.files(made), (".c", ".h"))
    driver = folder / "driver.c"
    driver.write_text(_DRIVER.format(name=made.name, p=names.prefix, u=names.upper, reads=reads))
    program = compile_c([source, driver], folder)
    asked = "\n".join(" ".join(map(str, state)) for state in states)
    ran = subprocess.run([program], input=asked, capture_output=True, text=True, check=True)
    return ran.stdout.splitlines()


def _compare(made: Request, folder: Path) -> None:
    assert answers(made, [state for state, _ in decisions(made)], folder) == expected_lines(made)


@needs_cc
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_decides_as_decide_does(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In every state, as nested `switch` and as Boolean functions; from a table and from a diagram."""
    _compare(example(name), tmp_path)
    monkeypatch.setattr(c_decisions, "MOST_ANSWERS", 0)
    _compare(example(name, diagram=True), tmp_path)


@needs_cc
@pytest.mark.parametrize("seed", FROM_STARTS)
def test_policies_from_starts(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Decided states have their actions, all others the status that says so; in both forms."""
    policy = exported(mixed(seed)[0])
    assert "undecided" in expected_lines(policy)
    _compare(policy, tmp_path)
    monkeypatch.setattr(c_decisions, "MOST_ANSWERS", 0)
    _compare(policy, tmp_path)


@needs_cc
@pytest.mark.parametrize("seed", range(24))
def test_random_policies_with_nasty_names(seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keywords, names of ours, names that are alike once joined; undecided states; more actions than bits in a word."""
    made = random_request(seed)
    if seed % 3 == 0:
        monkeypatch.setattr(c_decisions, "MOST_ANSWERS", 0)
    _compare(replace(made, name=("int", "a-b", "9 lives", "UPPER", "_")[seed % 5]), tmp_path)


@needs_cc
def test_values_out_of_range_are_invalid(tmp_path: Path) -> None:
    """Each input is checked, and no action is in the set then, whatever was in it before."""
    made = example("amr")
    good = (0, 0, 0, 0)
    bad = [(*good[:place], value, *good[place + 1 :]) for place in range(4) for value in (4, -1, 2**31 - 1)]
    assert answers(made, [good, *bad], tmp_path) == ["decided 6"] + ["invalid"] * len(bad)


@needs_cc
def test_to_do_nothing_is_a_decision(tmp_path: Path) -> None:
    """An empty set is told from an undecided state by the status alone."""
    spec = written({"S": "a, b"}, ["act"])
    assert answers(request(spec, {(0,): frozenset()}), [(0,), (1,)], tmp_path) == ["decided", "undecided"]


@needs_cc
def test_the_header_is_c_plus_plus_too(tmp_path: Path) -> None:
    """A source in C++ may include it, whatever the names are."""
    for made in (example("amr"), random_request(1), random_request(2)):
        write(tmp_path, made, c99.files(made), (".c", ".h"))
        (tmp_path / "user.cpp").write_text(f'#include "{made.name}.h"\nint main() {{ return 0; }}\n')
        compile_c([tmp_path / "user.cpp"], tmp_path, plus_plus=True)


def test_a_name_stays_when_others_are_declared() -> None:
    """Where two names would be the same, neither takes the place of the other when the order changes."""
    variables = {"a": "b_c, d", "a_b": "c, d"}
    one = Names.of(request(written(variables, []), {}))
    other = Names.of(request(written(dict(reversed(variables.items())), []), {}))
    assert one.values == tuple(reversed(other.values))
    assert len({value for values in one.values for value in values}) == 4
