"""Which tests are meant for which module of the trusted base, the quickest first."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

SEMANTICS = (
    "tests/semantics/test_literal.py",
    "tests/semantics/test_step.py",
    "tests/semantics/test_goals.py",
    "tests/semantics/test_judge.py",
)
WALK = ("tests/verify/test_steps.py", "tests/verify/test_verify.py")
TESTS: dict[str, tuple[str, ...]] = {
    "tumato_symbolic/semantics": SEMANTICS,
    "tumato_symbolic/symbolic/steps.py": ("tests/symbolic/test_steps.py",),
    "tumato_symbolic/policy/bind.py": (
        "tests/policy/test_numbers.py",
        "tests/policy/test_bind.py",
    ),
    "tumato_symbolic/policy/diagram.py": (
        "tests/policy/test_numbers.py",
        "tests/policy/test_bind.py",
    ),
    "tumato_symbolic/verify/by_walk": WALK,
    "tumato_symbolic/verify/by_z3": ("tests/verify/test_verify.py",),
    "tumato_symbolic/verify/no_policy": (
        "tests/verify/test_forged_refusals.py",
        "tests/verify/test_unrealizable_by_hand.py",
    ),
    "tumato_symbolic/verify": ("tests/verify/test_verify.py",),
    "proofs/checker.py": ("tests/checker/test_files.py",),
}


@dataclass(frozen=True)
class Covered:
    """A module of the trusted base, its file, and its tests."""

    module: str
    path: str
    tests: tuple[str, ...]


def covered(root: Path) -> list[Covered]:
    """Every module of the trusted base."""
    found: dict[str, Covered] = {}
    for place, tests in TESTS.items():
        files = [root / place] if place.endswith(".py") else sorted((root / place).rglob("*.py"))
        for file in files:
            path = file.relative_to(root).as_posix()
            module = path.removesuffix(".py").replace("/", ".")
            if file.name != "__init__.py":
                found.setdefault(module, Covered(module, path, tests))
    return list(found.values())
