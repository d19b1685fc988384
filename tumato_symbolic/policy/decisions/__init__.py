"""What a policy decides: other forms of it, smaller ones, and in the numbers of a specification."""

from tumato_symbolic.policy.decisions.binding import Renumbering, bind, fitted, made_for_less, restores_less
from tumato_symbolic.policy.decisions.compact import minimized, minimized_decisions
from tumato_symbolic.policy.decisions.convert import (
    Roots,
    as_diagram,
    as_table,
    count_defined,
    decided_at,
    never_executed,
    policy_from_rows,
    some_decided,
)
from tumato_symbolic.policy.decisions.part import formula_of, judged_within
from tumato_symbolic.policy.decisions.state_sets import StateSets

__all__ = [
    "Renumbering",
    "Roots",
    "StateSets",
    "as_diagram",
    "as_table",
    "bind",
    "count_defined",
    "decided_at",
    "fitted",
    "formula_of",
    "judged_within",
    "made_for_less",
    "minimized",
    "minimized_decisions",
    "never_executed",
    "policy_from_rows",
    "restores_less",
    "some_decided",
]
