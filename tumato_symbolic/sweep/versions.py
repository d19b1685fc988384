"""The versions of what answers depend on, here and on the workers of a cluster."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

Versions: TypeAlias = dict[str, str | None]
"""Versions by package; None where it is not there."""


def versions() -> Callable[[], Versions]:
    """A function that tells the versions; it runs where there is nothing of ours."""

    def told() -> Versions:
        from importlib.metadata import PackageNotFoundError, version

        found: Versions = {"tumato-symbolic": None}
        try:
            import tumato_symbolic

            found["tumato-symbolic"] = tumato_symbolic.__version__
        except ImportError:
            pass
        for name in ("dd", "z3-solver"):
            try:
                found[name] = version(name)
            except PackageNotFoundError:
                found[name] = None
        return found

    return told


def difference(there: Versions, here: Versions) -> str | None:
    """Which package has another version there, in words."""
    for package, mine in here.items():
        if there[package] != mine:
            theirs = f"has {package} {there[package]}" if there[package] else f"does not have {package}"
            return f"{theirs}, and {package} here is {mine}"
    return None
