"""Policies as data: tables, diagrams, their files."""

from tumato_symbolic.policy.bind import bind
from tumato_symbolic.policy.convert import as_diagram, as_table, count_defined, policy_from_rows, some_decided
from tumato_symbolic.policy.decide import UndecidedState, parse_assignments, parse_state
from tumato_symbolic.policy.diagram import Diagram, DiagramBuilder, Node, Reference, count_true, rebuild
from tumato_symbolic.policy.files import load, save
from tumato_symbolic.policy.model import Certificate, DecisionDiagram, Policy, RankedGoal, Table, Vocabulary
from tumato_symbolic.policy.read import loads
from tumato_symbolic.policy.write import dumps, fits_table

__all__ = [
    "Certificate",
    "DecisionDiagram",
    "Diagram",
    "DiagramBuilder",
    "Node",
    "Policy",
    "RankedGoal",
    "Reference",
    "Table",
    "UndecidedState",
    "Vocabulary",
    "as_diagram",
    "as_table",
    "bind",
    "count_defined",
    "count_true",
    "dumps",
    "fits_table",
    "load",
    "loads",
    "parse_assignments",
    "parse_state",
    "policy_from_rows",
    "rebuild",
    "save",
    "some_decided",
]
