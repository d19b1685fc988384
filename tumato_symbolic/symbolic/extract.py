"""From sets of bit vectors to diagrams over state variables, which need no engine to be read."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Generic, TypeVar

from tumato_symbolic.policy.diagram import DiagramBuilder, Reference
from tumato_symbolic.symbolic.encoding import Encoding, number_bits
from tumato_symbolic.symbolic.manager import Bdd

Value = TypeVar("Value", bound=Hashable)


class Extractor(Generic[Value]):
    """Turns functions of the state, given as disjoint sets with a value each, into nodes of one shared diagram."""

    def __init__(self, encoding: Encoding, builder: DiagramBuilder[Value], default: Value) -> None:
        self._encoding = encoding
        self._default = default
        self._node = builder.node
        self._leaf = builder.leaf
        self._known: dict[tuple[int, tuple[tuple[Value, Bdd], ...]], Reference] = {}

    def function(self, parts: Sequence[tuple[Value, Bdd]]) -> Reference:
        """The reference of the function that has each part's value in that part and the default elsewhere."""
        false = self._encoding.manager.false
        return self._build(0, tuple(part for part in parts if part[1] != false))

    def _build(self, level: int, parts: tuple[tuple[Value, Bdd], ...]) -> Reference:
        manager = self._encoding.manager
        if not parts:
            return self._leaf(self._default)
        if parts[0][1] == manager.true:
            return self._leaf(parts[0][0])
        key = (level, parts)
        if key not in self._known:
            variable = self._encoding.order[level]
            below = []
            for number in range(len(self._encoding.spec.variables[variable].values)):
                constants = number_bits(self._encoding.state_bits[variable], number)
                rest = ((value, manager.cofactor(part, constants)) for value, part in parts)
                kept = tuple(part for part in rest if part[1] != manager.false)
                below.append(self._build(level + 1, kept))
            self._known[key] = self._node(level, tuple(below))
        return self._known[key]
