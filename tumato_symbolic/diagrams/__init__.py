"""Decision diagrams over many-valued variables: the diagrams, sets of states, conjunctions, covers, minimization."""

from tumato_symbolic.diagrams.conjunction import conjoin
from tumato_symbolic.diagrams.cover import MOST_CUBES, Coverer, TooManyCubes
from tumato_symbolic.diagrams.diagram import Diagram, DiagramBuilder, Leaf, Node, Reference, count_true, rebuild
from tumato_symbolic.diagrams.recursion import room_for
from tumato_symbolic.diagrams.restrict import smallest
from tumato_symbolic.diagrams.sets import EVERYTHING, LEAVES, NOTHING, Cube, Sets

__all__ = [
    "EVERYTHING",
    "LEAVES",
    "MOST_CUBES",
    "NOTHING",
    "Coverer",
    "Cube",
    "Diagram",
    "DiagramBuilder",
    "Leaf",
    "Node",
    "Reference",
    "Sets",
    "TooManyCubes",
    "conjoin",
    "count_true",
    "rebuild",
    "room_for",
    "smallest",
]
