"""From sets of bit vectors to diagrams over state variables, which need no engine to be read."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Generic, TypeVar

from tumato_symbolic.diagrams import DiagramBuilder, Reference
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd

Value = TypeVar("Value", bound=Hashable)


class Extractor(Generic[Value]):
    """Turns functions of the state, given as disjoint sets with a value each, into nodes of one shared diagram.

    The parts of a function are numbered, the default being 0, and only the digits of these numbers are followed down
    the diagrams: of 30 ranks, 5 sets.
    """

    def __init__(self, encoding: Encoding, builder: DiagramBuilder[Value], default: Value) -> None:
        self._manager, variables = encoding.manager, encoding.spec.variables
        self._default = default
        self._node = builder.node
        self._leaf = builder.leaf
        self._sizes = [len(variables[variable].values) for variable in encoding.order]
        self._bits = [[encoding.manager.level(bit) for bit in encoding.state_bits[each]] for each in encoding.order]
        self._tested = {bit: level for level, bits in enumerate(self._bits) for bit in bits}
        self._known: dict[tuple[Reference, ...], dict[tuple[Bdd, ...], Reference]] = {}

    def function(self, parts: Sequence[tuple[Value, Bdd]]) -> Reference:
        """The reference of the function that has each part's value in that part and the default elsewhere.

        Raises `LimitReachedError` when time is up.
        """
        self._manager.context.check()
        leaves = (self._leaf(self._default), *(self._leaf(value) for value, _ in parts))
        digits = tuple(
            self._manager.union(states for number, (_, states) in enumerate(parts, 1) if number >> digit & 1)
            for digit in range(len(parts).bit_length())
        )
        return self._build(digits, leaves, self._known.setdefault(leaves, {}))

    def _build(
        self, digits: tuple[Bdd, ...], leaves: tuple[Reference, ...], known: dict[tuple[Bdd, ...], Reference]
    ) -> Reference:
        found = known.get(digits)
        if found is None:
            manager = self._manager
            manager.context.check()
            inner = [manager.top(digit) for digit in digits if digit not in (manager.true, manager.false)]
            if inner:
                level = self._tested[min(inner)]
                below: list[Reference] = []
                for rest, values in self._by_value(level, 0, 0, digits):
                    below += [self._build(rest, leaves, known)] * values
                found = self._node(level, tuple(below))
            else:
                found = leaves[sum((digit == manager.true) << place for place, digit in enumerate(digits))]
            known[digits] = found
        return found

    def _by_value(
        self, level: int, place: int, first: int, digits: tuple[Bdd, ...]
    ) -> list[tuple[tuple[Bdd, ...], int]]:
        """What is left of digits for the values from `first` on that agree in the bits before `place`.

        Values that follow each other and leave the same may be one entry, with their number.
        """
        bits, manager = self._bits[level], self._manager
        alike = 1 << (len(bits) - place)
        if first >= self._sizes[level]:
            return []
        inner = [manager.top(digit) for digit in digits if digit not in (manager.true, manager.false)]
        if place == len(bits) or min(inner, default=bits[-1] + 1) > bits[-1]:
            return [(digits, min(alike, self._sizes[level] - first))]
        halves = [manager.halves(digit, bits[place]) for digit in digits]
        low = self._by_value(level, place + 1, first, tuple([low for low, _ in halves]))
        return low + self._by_value(level, place + 1, first + alike // 2, tuple([high for _, high in halves]))
