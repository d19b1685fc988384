"""Synthesize robot policies from declarative specifications, and prove them.

The public API is what `__all__` lists. `parse` reads a specification, `synthesize` computes a policy (or says why there
is none), `verify` proves one, and a `Policy` decides. Everything is loaded when it is first used, so that importing
the package costs next to nothing.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tumato_symbolic.diagnostics import Diagnostic, UserError
    from tumato_symbolic.policy import Policy
    from tumato_symbolic.spec import Spec
    from tumato_symbolic.synthesis import Failure, Realizable, Statistics, Undecided, Unrealizable, synthesize
    from tumato_symbolic.verify import Verification
    from tumato_symbolic.verify.prove import verify

__version__ = "0.1.0"

_HOMES = {
    "Diagnostic": "diagnostics",
    "UserError": "diagnostics",
    "Policy": "policy",
    "Spec": "spec",
    "Failure": "synthesis",
    "Realizable": "synthesis",
    "Statistics": "synthesis",
    "Undecided": "synthesis",
    "Unrealizable": "synthesis",
    "synthesize": "synthesis",
    "Verification": "verify",
}

__all__ = [
    "Diagnostic",
    "Failure",
    "Policy",
    "Realizable",
    "Spec",
    "Statistics",
    "Undecided",
    "Unrealizable",
    "UserError",
    "Verification",
    "__version__",
    "parse",
    "synthesize",
    "verify",
]


def parse(text: str) -> Spec:
    """Read a specification. Raises `UserError`, which carries every mistake found in it."""
    from tumato_symbolic.diagnostics import Source, UserError
    from tumato_symbolic.spec import load

    source = Source("<text>", text)
    loaded = load(source)
    if loaded.spec is None:
        raise UserError(loaded.diagnostics, source)
    return loaded.spec


def __getattr__(name: str) -> Any:  # noqa: ANN401 - the kinds differ, and type checkers read the imports above
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__


class _Package(ModuleType):
    """The package, in which `verify` is the function although a subpackage has the same name."""

    @property
    def verify(self) -> Any:  # noqa: ANN401 - as above
        """See `tumato_symbolic.verify.prove.verify`."""
        return import_module(f"{__name__}.verify.prove").verify

    @verify.setter
    def verify(self, subpackage: ModuleType) -> None:
        """Importing a subpackage binds its name here; this one is reached by its path only."""


sys.modules[__name__].__class__ = _Package
