"""Policies looked at: a part of one, its decisions as a tree or a graph, how two differ. States are never listed."""

from tumato_symbolic.views.difference import ByAction, Change, Decided, Difference, difference
from tumato_symbolic.views.meaning import Altered, altered
from tumato_symbolic.views.placing import NamesChanged
from tumato_symbolic.views.questions import Answer, Box, Branch, Condition, Folded, Question, Questions, Row, Tree, rows
from tumato_symbolic.views.selected import OTHER, Label, Selected, select
from tumato_symbolic.views.selection import Selection, parse_selection

__all__ = [
    "OTHER",
    "Altered",
    "Answer",
    "Box",
    "Branch",
    "ByAction",
    "Change",
    "Condition",
    "Decided",
    "Difference",
    "Folded",
    "Label",
    "NamesChanged",
    "Question",
    "Questions",
    "Row",
    "Selected",
    "Selection",
    "Tree",
    "altered",
    "difference",
    "parse_selection",
    "rows",
    "select",
]
