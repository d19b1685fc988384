"""The parse table of the grammar, as data and as a file.

The file is read at every start in place of the grammar, because compiling a grammar takes longer than checking a
specification. It is generated: `make regenerate`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from hashlib import sha256
from typing import Any

from msgspec import Struct

START = 0
"""The state in which parsing starts."""


class Rule(Struct, frozen=True):
    """`origin: parts`. `node` says what is built of the parts, by the name of a function in `builder`.

    Where it is None, nothing is built: the only part stands for the whole, or the origin is a list (`is_list`).
    """

    origin: str
    parts: tuple[str, ...]
    node: str | None


class Table(Struct, frozen=True):
    """What to do in which state. Keywords and symbols are terminals that are named as they are written.

    `actions[state][terminal]` is the state to go to, or -1 - n, after which rule n is complete. `gotos[state][origin]`
    is the state after a rule that began in this one; the text is over in the state `end`.
    """

    patterns: Mapping[str, str]
    rules: tuple[Rule, ...]
    actions: tuple[Mapping[str, int], ...]
    gotos: tuple[Mapping[str, int], ...]
    end: int


def is_list(symbol: str) -> bool:
    """Whether what a symbol stands for is a list, which becomes part of what it stands in."""
    return symbol.startswith("_")


def written(table: Table, grammar: str) -> str:
    """The text of the file: one rule or state a line, each state with its actions and its gotos."""
    head = {"grammar": _digest(grammar), "patterns": table.patterns, "end": table.end}
    rules = [[rule.origin, " ".join(rule.parts), rule.node] for rule in table.rules]
    states = list(zip(table.actions, table.gotos, strict=True))
    fields = [f'"{name}": {json.dumps(value)}' for name, value in head.items()]
    fields += [f'"{name}": [\n{_lines(value)}\n]' for name, value in (("rules", rules), ("states", states))]
    return "{\n" + ",\n".join(fields) + "\n}\n"


def read(text: str, grammar: str) -> Table | None:
    """The table in the text of a file; None where it was compiled from another grammar."""
    data = json.loads(text)
    if data["grammar"] != _digest(grammar):
        return None
    return Table(
        data["patterns"],
        tuple(Rule(origin, tuple(parts.split()), node) for origin, parts, node in data["rules"]),
        tuple(actions for actions, _ in data["states"]),
        tuple(gotos for _, gotos in data["states"]),
        data["end"],
    )


def _digest(grammar: str) -> str:
    return f"sha256:{sha256(grammar.encode()).hexdigest()}"


def _lines(values: list[Any]) -> str:
    return ",\n".join(json.dumps(value) for value in values)
