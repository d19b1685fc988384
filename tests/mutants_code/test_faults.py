"""The tool that plants faults: it finds what it should, by stable names, and a planted fault is noticed."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from tests.mutants_code.__main__ import drawn
from tests.mutants_code.covering import covered
from tests.mutants_code.sites import planted, sites

ROOT = Path(__file__).parents[2]

TEXT = '''\
"""A module."""
LIMIT = 3

def near(steps: int, far: int, bound: int | None) -> bool:
    """Whether it is near."""
    if bound is None or not far:
        raise ValueError(f"far {1 + 1}")
    return all(each < 2 for each in (steps, far)) and steps + far <= bound
'''


@pytest.fixture
def module(tmp_path: Path) -> Path:
    path = tmp_path / "module.py"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_every_kind_of_fault_is_found(module: Path) -> None:
    """Comparison, boundary, constant, operator, forgotten conjunct, negation; not limits, types, texts."""
    names = [site.name.removeprefix("m:near: ") for site in sites(module, "m")]
    for expected in (
        "bound is None -> bound is not None",
        "bound is None or not far -> bound is None and (not far)",
        "bound is None or not far -> bound is None",
        "not far -> far",
        "each < 2 -> each <= 2",
        "2 -> 3",
        "2 -> 1",
        "steps + far -> steps - far",
        "steps + far <= bound -> steps + far < bound",
        "all((each < 2 for each in (steps, far))) -> any((each < 2 for each in (steps, far)))",
    ):
        assert expected in names
    assert len(set(names)) == len(names)
    assert not any(name.startswith(("1", "3", "int", "'far")) for name in names)


def test_a_fault_changes_one_thing_and_its_name_not_with_the_lines(module: Path) -> None:
    """Every fault compiles and differs from the module; a line more above it leaves its name as it is."""
    plain = ast.unparse(ast.parse(TEXT))
    before = sites(module, "m")
    for site in before:
        text = ast.unparse(planted(module, "m", site.number))
        compile(text, "m", "exec")
        assert text != plain
    module.write_text("import math\n\n" + TEXT, encoding="utf-8")
    assert [site.name for site in sites(module, "m")] == [site.name for site in before]


def test_every_module_of_the_trusted_base_has_its_share() -> None:
    """Semantics, all rooms of verify, steps, binding, diagrams and the checker, each with tests that exist."""
    modules = covered(ROOT)
    names = {each.module for each in modules}
    assert {"tumato_symbolic.semantics.step", "tumato_symbolic.verify.by_z3.outcomes", "proofs.checker"} <= names
    assert {"tumato_symbolic.symbolic.steps", "tumato_symbolic.policy.bind"} <= names
    for each in modules:
        paths = [test.split("::")[0] for test in each.tests if test.startswith("tests/")]
        assert paths and all((ROOT / path).exists() for path in paths)
    everything = {each.module: sites(ROOT / each.path, each.module) for each in modules[:4]}
    assert {module for module, _ in drawn(everything, 40, 1)} == set(everything)
    assert drawn(everything, 40, 1) == drawn(everything, 40, 1) != drawn(everything, 40, 2)


def test_a_planted_fault_is_noticed() -> None:
    """In a process of its own the tests of a module fail with a fault, and only with it."""
    code = (
        "from pathlib import Path; from tests.mutants_code.run import run_tests\n"
        "from tests.mutants_code.sites import sites\n"
        "module = 'tumato_symbolic.policy.diagram'; path = Path('tumato_symbolic/policy/diagram.py').resolve()\n"
        "number = next(s.number for s in sites(path, module) if 'root >= base -> root > base' in s.name)\n"
        "tests = ('tests/policy/test_numbers.py',)\n"
        "assert not run_tests(tests, None, '', 0, 60).killed\n"
        "assert run_tests(tests, path, module, number, 60).killed\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
