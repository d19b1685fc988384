"""The program that checks an exported policy, as a bounded model checker reads it: ESBMC, where it is found."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.export.c_compiler import compile_c, needs_cc
from tests.export.cases import generated
from tests.export.compiler import Case
from tests.export.esbmc import needs_esbmc, proved
from tests.export.policies import example, request, write
from tumato_symbolic.export import c99
from tumato_symbolic.policy import Table
from tumato_symbolic.semantics import State, judge


def _is_allowed(case: Case) -> bool:
    """What is proved of it: every valid state is decided, and every decision allowed."""
    found = judge(case.spec, case.rows, case.ordering)
    return not (found.missing or found.not_allowed)


@needs_esbmc
def test_the_robot_is_proved_and_changes_are_refused(tmp_path: Path) -> None:
    """The paper's example; decisions that break a rule, a precondition or nothing, and a hole."""
    made = example("amr")
    assert isinstance(made.policy.decisions, Table)
    rows = made.policy.decisions.rows
    unsafe: State = (0, 1, 0, 0)
    policies = [
        rows,
        {**rows, unsafe: frozenset()},
        {**rows, unsafe: frozenset((0,))},
        {**rows, unsafe: frozenset((1, 6))},
        {**rows, unsafe: frozenset((1, 2))},
        {state: chosen for state, chosen in rows.items() if state != unsafe},
    ]
    cases = [Case(made.spec, each, "any") for each in policies]
    truth = [_is_allowed(case) for case in cases]
    assert truth[0]
    assert not all(truth)
    assert [proved(request(case.spec, case.rows), tmp_path) for case in cases] == truth


@needs_esbmc
@pytest.mark.parametrize("profile", ["concurrent", "overlapping"])
def test_generated_policies_with_sets(profile: str, tmp_path: Path) -> None:
    """Where the order of effects matters. Of more specifications: `python -m tests.export.trial esbmc`."""
    realizable = (found for seed in range(360, 400) if (found := generated(profile, seed, 2)))
    right, *_, wrong, other = next(realizable)
    for case in (right, wrong, other):
        assert proved(replace(request(case.spec, case.rows), ordering=case.ordering), tmp_path) == _is_allowed(case)


@needs_cc
def test_it_compiles_without_a_model_checker(tmp_path: Path) -> None:
    """With any source of numbers in the place of unknown ones; here, none of them is a value."""
    made = replace(example("amr"), check=True)
    source, _, check = write(tmp_path, made, c99.files(made), (".c", ".h", "_check.c"))
    unknown = tmp_path / "unknown.c"
    unknown.write_text("int __VERIFIER_nondet_int(void);\nint __VERIFIER_nondet_int(void) { return -1; }\n")
    program = compile_c([source, check, unknown], tmp_path, ["-DPROVE", "-Wno-unused"])
    assert subprocess.run([program], check=False).returncode == 0
