"""Every numbered rule of docs/semantics.md has a test on every engine, or a listed reason why an engine has none."""

import ast
import re
from collections.abc import Iterator
from importlib import import_module
from itertools import product
from pathlib import Path
from types import FunctionType

from tests.conformance.roles import ROLES
from tests.conformance.rules import ENGINES, MISSING, NOT_YET, RULES, TEXT, UNANSWERED, asked, numbered

HERE = Path(__file__).parent
MODULES = sorted(path.stem for path in HERE.glob("test_[0-9]*.py"))


def marked() -> Iterator[tuple[str, FunctionType, tuple[str, ...]]]:
    """Every test of a section, with its rules."""
    for module in MODULES:
        for name, found in vars(import_module(f"tests.conformance.{module}")).items():
            if name.startswith("test_"):
                marks = [mark for mark in getattr(found, "pytestmark", []) if mark.name == "rule"]
                yield f"{module}.{name}", found, tuple(number for mark in marks for number in mark.args)


def roles(test: FunctionType) -> list[str]:
    """The roles in which a test asks for engines."""
    code = test.__code__
    return [role for role in ROLES if role in code.co_varnames[: code.co_argcount]]


def covered() -> set[tuple[str, str]]:
    """Every engine with every rule that it is asked about."""
    return {
        (engine.name, number)
        for _, test, numbers in marked()
        for role in roles(test)
        for engine in asked(role, numbers)
        for number in numbers
        if (engine.name, number) not in UNANSWERED
    }


def test_rules_are_numbered_from_one() -> None:
    """Without gaps, in every section."""
    sections = {number.partition(".")[0] for number in RULES}
    assert sections == {path.split("_")[1] for path in MODULES}
    for section in sections:
        items = [int(number.partition(".")[2]) for number in RULES if number.partition(".")[0] == section]
        assert items == list(range(1, len(items) + 1))


def test_every_rule_is_asked_of_every_engine_or_there_is_a_reason() -> None:
    """Never both: a reason that has become idle goes."""
    wanted = set(product((engine.name for engine in ENGINES), RULES))
    assert wanted - covered() == set(UNANSWERED)
    assert all(UNANSWERED.values())


def test_every_test_has_rules_that_exist_and_asks_for_one_role() -> None:
    """It stands in the file of their section, and says in a line what it holds."""
    for name, test, numbers in marked():
        assert numbers, f"{name} is marked with no rule"
        assert set(numbers) <= set(RULES), f"{name} is marked with a rule that there is not"
        assert {number.partition(".")[0] for number in numbers} == {name.split("_")[1]}
        assert len(roles(test)) == 1, f"{name} asks for no engine"
        assert test.__doc__


def test_a_rule_without_a_test_is_noticed() -> None:
    """Whether it is new in the document, or loses its tests."""
    text = "## 1. One\n\nIntroduction.\n\n1. first\n   goes on\n2. second\n\n## 2. Two\n\n- no number\n\n3. third\n"
    assert numbered(text) == {"1.1": "first", "1.2": "second", "2.3": "third"}
    assert set(product((engine.name for engine in ENGINES), ["3.99"])) - covered()


def test_every_section_has_tests_or_a_reason() -> None:
    """Also one that is new in the document, with numbers or without; never both."""
    sections = re.findall(r"^## (\d+)\.", TEXT, re.MULTILINE)
    with_tests = [path.split("_")[1] for path in MODULES]
    assert sorted(sections, key=int) == sorted([*with_tests, *NOT_YET], key=int)


def test_no_test_is_skipped_but_for_an_engine_that_is_not_here() -> None:
    """No file says `skip` or `xfail` by itself; explicit engines are always here."""
    for path in HERE.glob("*.py"):
        names = {
            node.attr
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Attribute)
        }
        assert names & {"skip", "skipif", "xfail", "importorskip"} <= ({"skip"} if path.stem == "conftest" else set())
    assert set(MISSING) <= {"bdd-cudd", "coq", "z3"}
