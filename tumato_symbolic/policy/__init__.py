"""Policies as data: tables, diagrams, their files."""

from tumato_symbolic.policy.bind import bind
from tumato_symbolic.policy.convert import (
    as_diagram,
    as_table,
    count_defined,
    never_executed,
    policy_from_rows,
    some_decided,
)
from tumato_symbolic.policy.files import load, loads, save
from tumato_symbolic.policy.lookup import UndecidedState
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
from tumato_symbolic.policy.states import parse_assignments, parse_state
from tumato_symbolic.policy.write import dumps, fits_table

__all__ = [
    "Certificate",
    "DecisionDiagram",
    "Deviation",
    "Policy",
    "RankedGoal",
    "Restoring",
    "Table",
    "UndecidedState",
    "Vocabulary",
    "as_diagram",
    "as_table",
    "bind",
    "count_defined",
    "dumps",
    "fits_table",
    "load",
    "loads",
    "never_executed",
    "parse_assignments",
    "parse_state",
    "policy_from_rows",
    "save",
    "some_decided",
]
