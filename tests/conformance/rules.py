"""The numbered rules of docs/semantics.md, and which engines answer for them."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import pytest

from tests.conformance.by_checker import Checker
from tests.conformance.by_coq import TOPLEVEL, Coq
from tests.conformance.by_engine import Bdd, Explicit
from tests.conformance.by_verify import Z3, States, Walk
from tests.conformance.roles import ROLES, Engine
from tumato_symbolic.limits import has_z3
from tumato_symbolic.symbolic import available_backend

TEXT = (Path(__file__).parents[2] / "docs" / "semantics.md").read_text(encoding="utf-8")

NOT_YET: dict[str, str] = {}
"""Sections whose rules have no tests here, with the reason."""

ENGINES: tuple[Engine, ...] = (
    Explicit(),
    Bdd("cudd"),
    Bdd("autoref"),
    Z3(),
    Walk(),
    States(),
    Checker(),
    Coq(),
)

MISSING = {
    **({} if available_backend() == "cudd" else {"bdd-cudd": "CUDD is not available here"}),
    **({} if has_z3() else {"z3": "Z3 cannot be imported here"}),
    **({} if TOPLEVEL else {"coq": "Coq is not installed"}),
}
"""Engines that cannot be asked here, with the reason."""

_NO_JUDGE = "it finds policies, and judges none that is given"
_NO_DECIDER = "it judges policies, and finds none"
_NO_STEPS_ALONE = "a policy that it judges fixes what is done where a run comes back"
_PROVERS = ("z3", "walk", "states")
UNANSWERED: dict[tuple[str, str], str] = {
    **{("coq", rule): "the package reads specifications for it" for rule in ("2.3", "2.4")},
    **{(bdd, rule): _NO_JUDGE for bdd in ("bdd-cudd", "bdd-autoref") for rule in ("5.1",)},
    **{(e, rule): _NO_DECIDER for e in (*_PROVERS, "checker", "coq") for rule in ("5.8", "6.1", "6.2", "6.3", "6.4")},
    **{(e, rule): _NO_DECIDER for e in ("walk", "states", "coq") for rule in ("7.1", "7.2", "7.3")},
    **{(e, "3.11"): _NO_STEPS_ALONE for e in ("walk", "states", "coq")},
    **{(e, "9.8"): _NO_DECIDER for e in ("walk", "states", "coq")},
    **{("z3", rule): "it proves efforts that are claimed, and computes none" for rule in ("9.1", "9.3")},
    **{
        (e, f"11.{number}"): "of guarantees it says nothing"
        for e in ("bdd-cudd", "bdd-autoref", "z3", "states", "coq")
        for number in range(1, 9)
    },
    **{("coq", f"12.{number}"): "the exporter refuses START" for number in range(1, 6)},
    **{(bdd, rule): _NO_JUDGE for bdd in ("bdd-cudd", "bdd-autoref") for rule in ("12.2", "12.3")},
    **{(e, rule): _NO_DECIDER for e in (*_PROVERS, "checker") for rule in ("12.4", "12.5")},
    ("explicit", "6.4"): "it writes no files",
}
"""Rules of which an engine gives no answer, with the reason; every other engine is asked about every other rule."""


def numbered(text: str) -> dict[str, str]:
    """The rules of a document: item N of section S is rule `S.N`; each with how it begins."""
    found = {}
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        number = section.partition(".")[0]
        for item, words in re.findall(r"^(\d+)\. (.*)$", section.partition("\n")[2], re.MULTILINE):
            rule = f"{number}.{item}"
            assert rule not in found, f"there are two rules {rule}"
            found[rule] = words
    return found


RULES = {rule: words for rule, words in numbered(TEXT).items() if rule.partition(".")[0] not in NOT_YET}

Test = TypeVar("Test", bound=Callable[..., None])


def rule(*numbers: str) -> Callable[[Test], Test]:
    """Mark a test as one of these rules; `test_rules.py` holds that they exist."""

    def mark(test: Test) -> Test:
        marked: Test = pytest.mark.rule(*numbers)(test)
        return marked

    return mark


def in_role(role: str) -> list[Engine]:
    """The engines that have a role."""
    return [engine for engine in ENGINES if isinstance(engine, ROLES[role])]


def asked(role: str, numbers: tuple[str, ...]) -> list[Engine]:
    """The engines of a role that answer for these rules."""
    return [each for each in in_role(role) if not all((each.name, number) in UNANSWERED for number in numbers)]
