"""JSON to the nodes of a decision diagram."""

from __future__ import annotations

from typing import Any

from tumato_symbolic.diagnostics import Code
from tumato_symbolic.diagnostics.wording import count
from tumato_symbolic.diagrams import Node
from tumato_symbolic.policy.records import Vocabulary
from tumato_symbolic.policy.text import as_list, as_names, as_whole, fault, member, show, way_out


def read_diagram(
    section: dict[str, Any], title: str, vocabulary: Vocabulary
) -> tuple[tuple[int, ...], list[Any], tuple[Node, ...]]:
    """Order, leaves (not empty, but unchecked) and nodes of the section called `title`."""
    where = f"`{title}`"
    numbers = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
    names = as_names(member(section, "Order", where), f"`{title}.Order`")
    for name in names:
        if name not in numbers:
            message = f"{where} tests the unknown variable {show(name)}"
            raise fault(Code.TUM503, message, way_out(name, numbers, "variables"))
    order, sizes = tuple(numbers[name] for name in names), vocabulary.sizes
    leaves = as_list(member(section, "Leaves", where), f"`{title}.Leaves`")
    if not leaves:
        raise fault(Code.TUM502, f"`{title}.Leaves` is empty")
    entries = as_list(member(section, "Nodes", where), f"`{title}.Nodes`")
    return order, leaves, _nodes(entries, where, [sizes[variable] for variable in order], len(leaves))


def _nodes(entries: list[Any], where: str, sizes: list[int], base: int) -> tuple[Node, ...]:
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
            message = f"{here} has {found}, but its variable has {values}"
            raise fault(Code.TUM502, message)
        for child in below:
            if levels[as_whole(child, f"a reference of {here}", number)] <= level:
                raise fault(Code.TUM502, f"{here} leads to {child}, which is not at a deeper level")
        nodes.append((level, below))
        levels.append(level)
    return tuple(nodes)
