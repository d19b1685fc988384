"""What parsing yields."""

from __future__ import annotations

from msgspec import Struct

from tumato_symbolic.diagnostics import Diagnostic
from tumato_symbolic.syntax import ast


class Parsed(Struct, frozen=True):
    """The tree of a text and the mistakes in it.

    After a mistake the tree holds what could be read all the same, or is None where reading had to be given up.
    `lost` holds the words that were passed over: what they may have declared is not to be missed.
    """

    tree: ast.Specification | None
    diagnostics: tuple[Diagnostic, ...]
    lost: frozenset[str] = frozenset()
