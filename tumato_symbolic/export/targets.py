"""The table of targets: what `tumato-sym export` can write, with the endings of files."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Final, TypeAlias, cast

from msgspec import Struct

if TYPE_CHECKING:
    from tumato_symbolic.export.request import Request

Texts: TypeAlias = tuple[str, ...]
"""The text of FILE, then those of the files beside it, then that of the program that checks it, if it is asked for."""


class Target(Struct, frozen=True):
    """A format. Its module has the same name (with `_` for `-`), and a function `files` from a `Request` to `Texts`.

    `example` is a usual name of FILE. `beside` are the endings of files that are written beside FILE in any case,
    `check` that of the program which `--check` adds.
    """

    purpose: str
    example: str
    beside: tuple[str, ...] = ()
    check: str | None = None


TARGETS: Final = {
    "python": Target("a module for Python 3.8 or later", "amr.py"),
    "c99": Target("a source and its header in C99", "amr.c", beside=(".h",), check="_check.c"),
    "cpp": Target("a header in C++17, which needs no other file", "amr.hpp"),
    "structured-text": Target("a function block for controllers (IEC 61131-3)", "amr.st"),
    "btcpp": Target("a tree for BehaviorTree.CPP 4", "amr.xml"),
    "nusmv": Target("a model for NuSMV, with its claims", "amr.smv"),
    "promela": Target("a model for SPIN, with its claims", "amr.pml"),
    "tlaplus": Target("a module of TLA+, with its claims", "amr.tla", beside=(".cfg",)),
    "prism": Target("a model for PRISM and Storm, with its claims", "amr.prism", beside=(".props",)),
    "coq": Target("a theorem for Coq", "amr.v"),
}
"""Every target in the order of the help."""


def load(name: str) -> Callable[[Request], Texts]:
    """What writes a target."""
    return cast("Callable[[Request], Texts]", import_module(f"tumato_symbolic.export.{name.replace('-', '_')}").files)
