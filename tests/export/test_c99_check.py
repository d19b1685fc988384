"""The program that checks an exported policy in C: it accepts right policies, and no others."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from itertools import chain, islice
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.c_check import counts, expected, grouped
from tests.export.c_compiler import compile_c, needs_cc
from tests.export.cases import generated, stepwise
from tests.export.compiler import Case
from tests.export.policies import EXAMPLES, example, exported, request, write, written
from tests.profiles import ALL_PROFILES
from tumato_symbolic import parse
from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.export import c99
from tumato_symbolic.export.c99_check import MOST_STATES
from tumato_symbolic.policy import Table, as_table
from tumato_symbolic.semantics import judge
from tumato_symbolic.spec import Restoration


def _compare(cases: Sequence[Case], folder: Path) -> tuple[int, int]:
    """How many policies were right and wrong, where the program and the meaning agree on all of them."""
    right = wrong = 0
    for number, same in enumerate(grouped(cases)):
        place = folder / str(number)
        place.mkdir()
        truth = [expected(case) for case in same]
        assert counts([exported(case) for case in same], place) == truth
        right += sum(not each.code for each in truth)
        wrong += sum(each.code for each in truth)
    return right, wrong


@needs_cc
@pytest.mark.parametrize("name", EXAMPLES)
def test_the_policy_of_every_example_is_accepted(name: str, tmp_path: Path) -> None:
    """With the longest run that the explicit meaning knows, where it is not too slow for that."""
    made = replace(example(name), check=True)
    source, _, check = write(tmp_path, made, c99.files(made), (".c", ".h", "_check.c"))
    ran = subprocess.run([compile_c([source, check], tmp_path)], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout
    table = as_table(made.policy, 1000)
    if table is not None:
        judged = judge(made.spec, table.rows, made.ordering)
        assert f"longest run to a goal: {judged.longest_run}\n" in ran.stdout


@needs_cc
@pytest.mark.parametrize("actions", [[], ["wait"]])
def test_nothing_to_do_is_checked_as_well(actions: list[str], tmp_path: Path) -> None:
    """Without actions, and without effects, the program compiles as strictly, and accepts the policy."""
    spec = written({"S": "only"}, actions)
    made = replace(request(spec, {(0,): frozenset()}), check=True)
    source, _, check = write(tmp_path, made, c99.files(made), (".c", ".h", "_check.c"))
    assert subprocess.run([compile_c([source, check], tmp_path)], capture_output=True, check=False).returncode == 0


@needs_cc
def test_changed_policies_of_the_robot_are_refused(tmp_path: Path) -> None:
    """Another decision in any one state of the paper's example: accepted only where that is right as well."""
    made = example("amr")
    assert isinstance(made.policy.decisions, Table)
    rows = made.policy.decisions.rows
    sets = [frozenset(), *(frozenset((n,)) for n in range(8)), frozenset((3, 6)), frozenset((1, 6))]
    changed = [{**rows, state: chosen} for state in rows for chosen in sets if chosen != rows[state]]
    holed = [{other: chosen for other, chosen in rows.items() if other != state} for state in list(rows)[:4]]
    right, wrong = _compare([Case(made.spec, each, "any") for each in [*changed, *holed]], tmp_path)
    assert wrong > 250
    assert right < 40


@needs_cc
@pytest.mark.parametrize("profile", ALL_PROFILES)
def test_it_agrees_with_the_explicit_meaning(profile: str, tmp_path: Path) -> None:
    """On right and wrong policies of generated specifications, under both orderings, fault by fault.

    Of more: `python -m tests.export.trial c`.
    """
    realizable = (found for seed in range(60, 120) if (found := generated(profile, seed, 6)))
    right, _ = _compare(list(chain.from_iterable(islice(realizable, 1))), tmp_path)
    assert right > 0


@needs_cc
@pytest.mark.parametrize("restoration", ["one_step", "bounded", "fair"])
def test_it_agrees_where_safety_takes_several_steps(restoration: Restoration, tmp_path: Path) -> None:
    """And with severities of state rules."""
    cases = stepwise(41, restoration, 3)
    right, wrong = _compare(cases, tmp_path)
    assert wrong > 0
    assert right > 0


def test_too_many_states_are_refused() -> None:
    """The program goes through each; the other files can be had without it."""
    count = MOST_STATES.bit_length()
    variables = "\n".join(f"state S{number} can be a, b" for number in range(count))
    made = request(parse(f"BEGIN STATE VECTOR\n{variables}\nEND STATE VECTOR"), {(0,) * count: frozenset()})
    assert len(c99.files(made)) == 2
    with pytest.raises(UserError) as error:
        c99.files(replace(made, check=True))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code is Code.TUM508
    assert "leave out --check" in str(diagnostic.help)
