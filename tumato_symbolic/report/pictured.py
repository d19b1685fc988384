"""What a policy does, for a person: drawn where that takes a few lines, and which actions it never executes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tumato_symbolic.policy import Policy, count_defined, never_executed
from tumato_symbolic.report.layout import enumeration
from tumato_symbolic.spec import Spec

if TYPE_CHECKING:
    from tumato_symbolic.views import Tree

_PICTURED_STATES = 10_000
"""Policies of more states are not drawn."""

_PICTURED_LINES = 30
"""Policies whose tree has more lines are not drawn."""

_NAMES = 5
"""So many actions that are never executed are named."""


def drawn(spec: Spec, policy: Policy, show: str, *, restores: bool) -> str:
    """What the policy does; where that is long, `show`, the command that shows it.

    `restores`: there are states in which it restores safety.
    """
    tree = _tree(spec, policy)
    if tree is None:
        return f"What it does takes more than {_PICTURED_LINES} lines, which are left out here. To see them:\n  {show}"
    from tumato_symbolic.report.trees import tree_lines

    legend = " (! restores safety)" if restores else ""
    return "\n".join((f"What it does{legend}:", *(f"  {line}" for line in tree_lines(policy.vocabulary, tree))))


def _tree(spec: Spec, policy: Policy) -> Tree | None:
    """The whole policy, where that takes a few lines."""
    if count_defined(policy) > _PICTURED_STATES:
        return None
    from tumato_symbolic.views import Folded, Questions, rows, select

    tree = Questions(select(policy, spec=spec).joint()).tree(_PICTURED_LINES)
    whole = tree is not None and not any(isinstance(row.leaf, Folded) for row in rows(tree))
    return tree if whole else None


def never_executed_lines(policy: Policy) -> list[str]:
    """The actions that are executed in no state, on one line; none where there are none."""
    names = never_executed(policy)
    shown = [*names[:_NAMES], f"{len(names) - _NAMES:,} more"] if len(names) > _NAMES else list(names)
    return [f"  never executed: {enumeration(shown)}"] if names else []
