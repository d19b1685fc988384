"""Ordered decision diagrams over many-valued variables: how policies and ranks are stored and handed on.

Plain data and plain Python: the engine writes them, the verifier reads them, neither trusts the other. A *reference*
is a number: below `len(leaves)` it names a leaf, otherwise the node `reference - len(leaves)`. Children come before
their parents, so a diagram cannot contain a cycle.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from math import prod
from typing import Generic, TypeAlias, TypeVar

from msgspec import Struct

Leaf = TypeVar("Leaf", bound=Hashable)
Reference: TypeAlias = int
Node: TypeAlias = tuple[int, tuple[Reference, ...]]
"""(level, one child for every value of the variable at that level); levels grow towards the leaves."""


class Diagram(Struct, Generic[Leaf], frozen=True):
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

    def levels(self) -> list[int]:
        """The level of every reference; that of the leaves is below all others."""
        return [len(self.order)] * len(self.leaves) + [level for level, _ in self.nodes]


class UniqueTable:
    """Reduced nodes over some levels, every one once. References below `leaves` are those of the leaves."""

    def __init__(self, leaves: int, levels: int) -> None:
        self._levels = [levels] * leaves
        self._below: list[tuple[Reference, ...]] = [()] * leaves
        self._known: dict[Node, Reference] = {}

    def node(self, level: int, below: tuple[Reference, ...]) -> Reference:
        """The reference of a node, which continues with `below[value]` for every value of the variable at `level`."""
        if below.count(below[0]) == len(below):
            return below[0]
        key = (level, below)
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = len(self._levels)
            self._levels.append(level)
            self._below.append(below)
        return found

    def nodes_from(self, reference: Reference) -> Iterator[Node]:
        """The nodes that were made, in order, from this reference on."""
        return zip(self._levels[reference:], self._below[reference:], strict=True)


class DiagramBuilder(UniqueTable, Generic[Leaf]):
    """Builds one shared, reduced diagram from the leaves upwards."""

    def __init__(self, order: Sequence[int], leaves: Sequence[Leaf]) -> None:
        super().__init__(len(leaves), len(order))
        self._order = tuple(order)
        self._leaves = tuple(leaves)
        self._leaf_references = {leaf: number for number, leaf in enumerate(self._leaves)}

    def leaf(self, value: Leaf) -> Reference:
        """The reference of a leaf."""
        return self._leaf_references[value]

    def from_table(self, sizes: Sequence[int], table: Mapping[tuple[int, ...], Leaf], default: Leaf) -> Reference:
        """The diagram of a finite function: `table`, and `default` elsewhere. `sizes` counts values per variable."""
        elsewhere = self.leaf(default)
        below = {tuple([state[variable] for variable in self._order]): self.leaf(leaf) for state, leaf in table.items()}
        for level in reversed(range(len(self._order))):
            children: dict[tuple[int, ...], list[Reference]] = {}
            for (*path, value), child in below.items():
                children.setdefault(tuple(path), [elsewhere] * sizes[self._order[level]])[value] = child
            below = {path: self.node(level, tuple(nodes)) for path, nodes in children.items()}
        return below.get((), elsewhere)

    def finish(self) -> Diagram[Leaf]:
        """The diagram with all nodes made so far."""
        return Diagram(self._order, self._leaves, tuple(self.nodes_from(len(self._leaves))))


def rebuild(
    diagram: Diagram[Leaf],
    roots: Sequence[Reference],
    order: Sequence[int] | None = None,
    values: Sequence[Sequence[int]] | None = None,
) -> tuple[Diagram[Leaf], tuple[Reference, ...]]:
    """The same functions in canonical form: reduced, only what `roots` need, nodes in the order of a depth-first walk.

    `order` renames the variable of every level; `values[level]` lists, for every new value number, the old one.
    """
    builder = DiagramBuilder(diagram.order if order is None else order, diagram.leaves)
    base = len(diagram.leaves)
    done: dict[Reference, Reference] = {reference: reference for reference in range(base)}
    for root in roots:
        pending = [root]
        while pending:
            here = pending[-1]
            if here in done:
                pending.pop()
                continue
            level, below = diagram.nodes[here - base]
            children = below if values is None else tuple(below[old] for old in values[level])
            waiting = [child for child in children if child not in done]
            if waiting:
                pending.extend(reversed(waiting))
            else:
                done[here] = builder.node(level, tuple(done[child] for child in children))
    return builder.finish(), tuple(done[root] for root in roots)


def count_true(diagram: Diagram[bool], root: Reference, sizes: Sequence[int]) -> int:
    """In how many states `root` leads to True, exactly. `sizes` counts the values of every variable."""
    depth, base = len(diagram.order), len(diagram.leaves)
    below_level = [1] * (depth + 1)
    for level in range(depth - 1, -1, -1):
        below_level[level] = below_level[level + 1] * sizes[diagram.order[level]]
    levels = diagram.levels()
    counts = [int(leaf) for leaf in diagram.leaves]
    for level, below in diagram.nodes[: max(0, root - base + 1)]:
        counts.append(sum(counts[child] * (below_level[level + 1] // below_level[levels[child]]) for child in below))
    tested = frozenset(diagram.order)
    untested = prod(size for variable, size in enumerate(sizes) if variable not in tested)
    return counts[root] * (below_level[0] // below_level[levels[root]]) * untested
