"""The tool that plants faults: it finds what it should, by stable names, and a planted fault is noticed."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

from tests.mutants_code.__main__ import drawn, is_within
from tests.mutants_code.covering import covered
from tests.mutants_code.harmless import harmless
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
        tree = planted(module, "m", site.number)
        compile(tree, "m", "exec")
        assert ast.unparse(tree) != plain
    module.write_text("import math\n\n" + TEXT, encoding="utf-8")
    assert [site.name for site in sites(module, "m")] == [site.name for site in before]


def test_every_module_of_the_trusted_base_has_its_share() -> None:
    """Semantics, all rooms of verify, steps, binding, diagrams and the checker, each with tests that exist."""
    modules = covered(ROOT)
    names = {each.module for each in modules}
    assert {"tumato_symbolic.semantics.step", "tumato_symbolic.verify.by_z3.outcomes", "proofs.checker"} <= names
    assert {"tumato_symbolic.symbolic.steps", "tumato_symbolic.policy.decisions.binding"} <= names
    assert {"tumato_symbolic.verify.by_states.steps", "tumato_symbolic.verify.by_diagrams.walk"} <= names
    everything = {each.module: sites(ROOT / each.path, each.module) for each in modules[:4]}
    assert {module for module, _ in drawn(everything, 40, 1)} == set(everything)
    assert drawn(everything, 40, 1) == drawn(everything, 40, 1) != drawn(everything, 40, 2)


def test_harmless_faults_are_faults() -> None:
    """Every name in the list is that of a fault of today, and has a reason."""
    names = {site.name for each in covered(ROOT) for site in sites(ROOT / each.path, each.module)}
    assert [name for name in harmless() if name not in names] == []
    assert all(harmless().values())


def test_the_tests_that_are_named_exist() -> None:
    """Every module has tests, and a test that was renamed is missed."""
    lists = {each.tests for each in covered(ROOT)}
    named = sorted({test for tests in lists for test in tests if test.startswith("tests/")})
    assert all(any(test in named for test in tests) for tests in lists)
    for file, _, name in (test.partition("::") for test in named):
        assert (ROOT / file).exists(), file
        function = f"def {name.partition('[')[0]}("
        assert not name or function in (ROOT / file).read_text(encoding="utf-8"), (file, name)


@pytest.mark.parametrize(
    ("wanted", "expected"),
    [
        (None, True),
        ("tumato_symbolic.symbolic.steps", True),
        ("symbolic.steps", True),
        ("symbolic", True),
        ("steps", False),
        ("symbolic.step", False),
        ("verify", False),
    ],
)
def test_which_modules_are_wanted(wanted: str | None, expected: bool) -> None:
    """A module or a package by its whole name."""
    assert is_within("tumato_symbolic.symbolic.steps", wanted) == expected


TESTS = """
import time

import pytest

import changed


def test_it() -> None:
    while changed.ONE == 2 and changed.HOW == "loop":
        pass
    if changed.ONE == 2 and changed.HOW == "wait":
        time.sleep(1000)
    assert changed.ONE == 1 or changed.HOW != "fail"
    if changed.ONE == 2 and changed.HOW == "exit":
        pytest.exit("no verdict", 4)
"""


ENDINGS = {
    "fail": ("noticed", True),
    "loop": ("no end", True),
    "wait": ("no end", True),
    "pass": ("survived", False),
    "exit": ("error", False),
    "load": ("not loaded", False),
}
RUN = """
import os, sys
from pathlib import Path
from tests.mutants_code import run, sites

os.chdir(sys.argv[1])
sys.path.insert(0, sys.argv[1])
run.IDLE = 2.0
run.load_what_tests_need()
path = Path("changed.py").resolve()
plain = path.read_text()
for how in sys.argv[2:]:
    path.write_text(f"HOW = {how!r}" + plain)
    number = next(each.number for each in sites.sites(path, "changed") if each.name.endswith("1 -> 2"))
    ending = run.run_tests(["tests/test_it.py"], path, "changed", number, 0 if how == "loop" else 60)
    print(how, ending.how, ending.killed, sep=",")
print(run.run_tests(["tests/test_it.py"], None, "", 0, 60).how)
"""


def test_how_the_tests_end(tmp_path: Path) -> None:
    """A failed test and one that finds no end are deaths; an error of pytest and a module that cannot be loaded not."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_it.py").write_text(TESTS, encoding="utf-8")
    bad = 'if one() == 2 and HOW == "load":\n    raise ImportError\n'
    text = f"\n\n\ndef one() -> int:\n    return 1\n\n\nONE = one()\n{bad}"
    (tmp_path / "changed.py").write_text(text, encoding="utf-8")
    command = [sys.executable, "-c", RUN, str(tmp_path), *ENDINGS]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    expected = [f"{name},{how},{killed}" for name, (how, killed) in ENDINGS.items()]
    assert told.splitlines() == [*expected, "survived"]


def test_a_planted_fault_is_noticed() -> None:
    """In a process of its own the tests of a module fail with a fault, and only with it."""
    code = (
        "from pathlib import Path; from tests.mutants_code.run import run_tests\n"
        "from tests.mutants_code.sites import sites\n"
        "module = 'tumato_symbolic.diagrams.diagram'; path = Path('tumato_symbolic/diagrams/diagram.py').resolve()\n"
        "number = next(s.number for s in sites(path, module) if 'root >= base -> root > base' in s.name)\n"
        "tests = ('tests/policy/test_numbers.py',)\n"
        "assert run_tests(tests, None, '', 0, 60).how == 'survived'\n"
        "assert run_tests(tests, path, module, number, 60).how == 'noticed'\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


def test_every_test_of_the_verifier_is_meant_for_some_module() -> None:
    """A test that is added later is asked too; one that plants faults itself is no test of what it plants in."""
    asked = {argument.split("::")[0] for each in covered(ROOT) for argument in each.tests}
    there = {f"tests/verify/{file.name}" for file in (ROOT / "tests/verify").glob("test_*.py")}
    assert there - asked == {"tests/verify/test_planted_restoring.py"}
