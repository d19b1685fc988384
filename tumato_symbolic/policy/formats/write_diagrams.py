"""The nodes of a decision diagram as lines of JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from json import dumps as _json
from typing import Any

from tumato_symbolic.diagrams import Diagram
from tumato_symbolic.policy.records import Vocabulary

_LINE = 110
"""Columns that the nodes of one line may take."""


def block(opening: str, entries: Iterable[str], closing: str) -> Iterator[str]:
    """Entries between brackets, one on every line, two columns deeper."""
    yield opening
    deeper = " " * (len(opening) - len(opening.lstrip()) + 2)
    waiting: str | None = None
    for entry in entries:
        if waiting is not None:
            yield f"{deeper}{waiting},"
        waiting = entry
    if waiting is not None:
        yield f"{deeper}{waiting}"
    yield closing


def diagram_lines(diagram: Diagram[Any], vocabulary: Vocabulary) -> Iterator[str]:
    """`Order`, `Leaves` and `Nodes`, with a comma behind."""
    yield f'    "Order": {_json([vocabulary.variables[variable][0] for variable in diagram.order])},'
    yield f'    "Leaves": {_json(diagram.leaves)},'
    yield from block('    "Nodes": [', _packed(_json(node, separators=(",", ":")) for node in diagram.nodes), "    ],")


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
