"""Policies looked at: a part of one, its decisions as a tree or a graph, how two differ. States are never listed."""

from importlib import import_module
from typing import TYPE_CHECKING

from tumato_symbolic.views.questions import Answer, Box, Folded, Question, Questions, Row, Tree, rows
from tumato_symbolic.views.selected import OTHER, Label, Selected, select
from tumato_symbolic.views.selection import Selection, parse_selection

if TYPE_CHECKING:
    from tumato_symbolic.views.counting import counted
    from tumato_symbolic.views.meaning import Altered, altered
    from tumato_symbolic.views.two_policies import Change, Decided, Difference, difference

_HOMES = {
    **dict.fromkeys(("Change", "Decided", "Difference", "difference"), "two_policies"),
    **dict.fromkeys(("Altered", "altered"), "meaning"),
    "counted": "counting",
}


def __getattr__(name: str) -> object:
    """How two policies differ is imported on first use: those who look at one need not pay for it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
