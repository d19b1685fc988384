"""Every test that asks for an engine by its role runs once for each engine that has it."""

import pytest

from tests.conformance.roles import ROLES
from tests.conformance.rules import MISSING, asked


def pytest_configure(config: pytest.Config) -> None:
    """The mark that names rules."""
    config.addinivalue_line("markers", "rule(*numbers): the rules of docs/semantics.md that a test holds")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each engine."""
    marks = list(metafunc.definition.iter_markers("rule"))
    for role in ROLES:
        if role in metafunc.fixturenames:
            numbers = tuple(number for mark in marks for number in mark.args)
            params = [
                pytest.param(engine, id=engine.name, marks=_skipped(engine.name)) for engine in asked(role, numbers)
            ]
            metafunc.parametrize(role, params)


def _skipped(name: str) -> list[pytest.MarkDecorator]:
    return [pytest.mark.skip(reason=MISSING[name])] if name in MISSING else []
