"""The keys of a decision diagram: `Order`, `Leaves` and `Nodes`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from json import dumps as _json
from typing import Any

from msgspec import Struct

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.diagrams import Diagram, Node
from tumato_symbolic.policy.formats.kinds import REFERENCE, TEXTS, Kind, Names, Schema, whole
from tumato_symbolic.policy.formats.tables import Attributes, Block, Part, Place, Record, block, described, dotted
from tumato_symbolic.policy.records import SomeDrawn, canonical
from tumato_symbolic.policy.text import as_list, as_names, as_whole, fault, member, show, way_out

_LINE = 110
"""Columns that the nodes of one line may take."""

ORDER: Schema = {"description": "The variable that is tested at each level.", **TEXTS.schema}
NODES: Schema = {
    "description": "Pairs of a level and one reference for every value of its variable; children come first.",
    "type": "array",
    "items": {
        "type": "array",
        "prefixItems": [whole().schema, {"type": "array", "minItems": 1, "items": REFERENCE.schema}],
        "minItems": 2,
        "maxItems": 2,
    },
}


class DiagramPart(Struct, Part, frozen=True):
    """The diagram of a section; what is read after it may refer to it."""

    name: str
    leaves: Kind[tuple[Any, ...]]
    about: str = ""

    def read(self, section: dict[str, Any], place: Place, names: Names) -> dict[str, Any]:
        """See `Part`."""
        numbers = {name: number for number, (name, _) in enumerate(names.vocabulary.variables)}
        tested = as_names(member(section, "Order", place.name), place.of("Order"))
        for name in tested:
            if name not in numbers:
                message = f"{place.name} tests the unknown variable {show(name)}"
                raise fault(Code.TUM503, message, way_out(name, numbers, "variables"))
        order, sizes = tuple(numbers[name] for name in tested), names.vocabulary.sizes
        leaves = self.leaves.read(member(section, "Leaves", place.name), place.of("Leaves"), names)
        entries = as_list(member(section, "Nodes", place.name), place.of("Nodes"))
        nodes = _nodes(entries, place.name, [sizes[variable] for variable in order], len(leaves))
        names.counts["reference"] = len(leaves) + len(nodes)
        return {self.name: Diagram(order, leaves, nodes)}

    def written(self, record: Attributes, names: Names) -> dict[str, Any]:
        """See `Part`."""
        diagram: Diagram[Any] = getattr(record, self.name)
        order = [names.vocabulary.variables[variable][0] for variable in diagram.order]
        return {"Order": order, "Leaves": diagram.leaves, "Nodes": diagram.nodes}

    def blocks(self, record: Attributes, names: Names, indent: str) -> Iterator[Block]:
        """See `Part`."""
        diagram: Diagram[Any] = getattr(record, self.name)
        yield [f'{indent}"Order": {_json([names.vocabulary.variables[variable][0] for variable in diagram.order])}']
        yield [f'{indent}"Leaves": {_json(diagram.leaves)}']
        nodes = (_json(node, separators=(",", ":")) for node in diagram.nodes)
        yield block(f'{indent}"Nodes": [', _packed(nodes), "]")

    def describe(self) -> tuple[dict[str, Schema | bool], list[str]]:
        """See `Part`."""
        leaves = described(self.about, self.leaves.schema)
        return {"Order": ORDER, "Leaves": leaves, "Nodes": NODES}, ["Order", "Leaves", "Nodes"]


def section(
    make: Callable[..., SomeDrawn], parts: tuple[Part, ...], about: str = "", first: tuple[Part, ...] = ()
) -> Record[SomeDrawn]:
    """A section with a diagram, which is in canonical form both in the record and in the file."""
    return Record(lambda **found: canonical(make(**found)), parts, about, dotted, canonical, first)


def _nodes(entries: list[Any], where: str, sizes: Sequence[int], base: int) -> tuple[Node, ...]:
    levels = [len(sizes)] * base
    nodes: list[Node] = []
    for number, entry in enumerate(entries, base):
        here = f"node {number} of {where}"
        pair = as_list(entry, here)
        if len(pair) != 2:
            parts = count(len(pair), "part")
            raise fault(Code.TUM502, f"{here} has {parts}, expected a level and a list of references")
        level = as_whole(pair[0], f"the level of {here}", len(sizes))
        below = tuple(as_list(pair[1], f"the second part of {here}"))
        if len(below) != sizes[level]:
            found, values = count(len(below), "reference"), count(sizes[level], "value")
            raise fault(Code.TUM502, f"{here} has {found}, but its variable has {values}")
        for child in below:
            if levels[as_whole(child, f"a reference of {here}", number)] <= level:
                raise fault(Code.TUM502, f"{here} leads to {child}, which is not at a deeper level")
        nodes.append((level, below))
        levels.append(level)
    return tuple(nodes)


def _packed(entries: Iterable[str]) -> Iterator[str]:
    """Short entries, as many as fit together on a line."""
    line = ""
    for entry in entries:
        if line and len(line) + len(entry) >= _LINE:
            yield line
            line = ""
        line = f"{line},{entry}" if line else entry
    if line:
        yield line
