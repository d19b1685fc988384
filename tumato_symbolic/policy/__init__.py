"""Policies as data: tables, diagrams, their files."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tumato_symbolic.policy.claim import load_claim
from tumato_symbolic.policy.decisions import (
    Roots,
    StateSets,
    as_diagram,
    as_table,
    bind,
    count_defined,
    decided_at,
    fitted,
    formula_of,
    judged_within,
    made_for_less,
    minimized,
    minimized_decisions,
    never_executed,
    policy_from_rows,
    restores_less,
    some_decided,
)
from tumato_symbolic.policy.files import dumps, load, loads, save
from tumato_symbolic.policy.formats import fits_table
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import (
    Certificate,
    DecisionDiagram,
    Deviation,
    RankedGoal,
    Restoring,
    Table,
    Vocabulary,
)
from tumato_symbolic.policy.text import save_text

if TYPE_CHECKING:
    from tumato_symbolic.policy.decisions.rules import Rule, RuleList, find_rules, minimal_rules
    from tumato_symbolic.policy.lookup import UndecidedState, parse_assignments, parse_state

__all__ = ["Policy", "Table", "UndecidedState", "Vocabulary", "as_diagram", "minimal_rules", "save"]
"""What docs/ offers to programs of others; the other names are for the rooms of this package."""

_LATER = {
    **dict.fromkeys(("Rule", "RuleList", "find_rules", "minimal_rules"), "decisions.rules"),
    **dict.fromkeys(("UndecidedState", "parse_assignments", "parse_state"), "lookup"),
}


def __getattr__(name: str) -> Any:  # noqa: ANN401 - the kinds differ, and type checkers read the imports above
    """Rules, and what is decided in one state, are imported on first use: a synthesis and a proof need neither."""
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_LATER[name]}"), name)
