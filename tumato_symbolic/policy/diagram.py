"""Ordered decision diagrams over many-valued variables: how policies and ranks are stored and handed on.

Plain data and plain Python: the engine writes them, the verifier reads them, neither trusts the other. A *reference*
is a number: below `len(leaves)` it names a leaf, otherwise the node `reference - len(leaves)`. Children come before
their parents, so a diagram cannot contain a cycle.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Generic, TypeAlias, TypeVar

Leaf = TypeVar("Leaf", bound=Hashable)
Reference: TypeAlias = int
Node: TypeAlias = tuple[int, tuple[Reference, ...]]
"""(level, one child for every value of the variable at that level); levels grow towards the leaves."""


@dataclass(frozen=True, slots=True)
class Diagram(Generic[Leaf]):
    """A shared diagram: `order[level]` is the number of the variable that is tested at that level.

    Reduced: no two nodes are equal, and no node has only equal children. Roots are kept by the owner.
    """

    order: tuple[int, ...]
    leaves: tuple[Leaf, ...]
    nodes: tuple[Node, ...]

    def evaluate(self, root: Reference, state: Sequence[int]) -> Leaf:
        """The leaf that `root` leads to in `state` (value numbers in the order of declaration)."""
        base = len(self.leaves)
        while root >= base:
            level, below = self.nodes[root - base]
            root = below[state[self.order[level]]]
        return self.leaves[root]


class DiagramBuilder(Generic[Leaf]):
    """Builds one shared, reduced diagram from the leaves upwards."""

    def __init__(self, order: Sequence[int], leaves: Sequence[Leaf]) -> None:
        self._order = tuple(order)
        self._leaves = tuple(leaves)
        self._nodes: list[Node] = []
        self._known: dict[Node, Reference] = {}
        self._leaf_references = {leaf: number for number, leaf in enumerate(self._leaves)}

    def leaf(self, value: Leaf) -> Reference:
        """The reference of a leaf."""
        return self._leaf_references[value]

    def node(self, level: int, below: tuple[Reference, ...]) -> Reference:
        """The reference of a node, which is made where there is none yet."""
        if all(child == below[0] for child in below):
            return below[0]
        key = (level, below)
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = len(self._leaves) + len(self._nodes)
            self._nodes.append(key)
        return found

    def from_table(self, sizes: Sequence[int], table: Mapping[tuple[int, ...], Leaf], default: Leaf) -> Reference:
        """The diagram of a finite function: `table`, and `default` elsewhere. `sizes` counts values per variable."""

        def build(level: int, rows: list[tuple[tuple[int, ...], Leaf]]) -> Reference:
            if not rows:
                return self.leaf(default)
            if level == len(self._order):
                return self.leaf(rows[0][1])
            variable = self._order[level]
            split: list[list[tuple[tuple[int, ...], Leaf]]] = [[] for _ in range(sizes[variable])]
            for row in rows:
                split[row[0][variable]].append(row)
            return self.node(level, tuple(build(level + 1, part) for part in split))

        return build(0, list(table.items()))

    def finish(self) -> Diagram[Leaf]:
        """The diagram with all nodes made so far."""
        return Diagram(self._order, self._leaves, tuple(self._nodes))
