"""From sets of bit vectors to diagrams over state variables, which need no engine to be read."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from itertools import repeat
from typing import Generic, TypeVar

from tumato_symbolic.diagrams import EVERYTHING, NOTHING, DiagramBuilder, Reference, Sets
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd

Value = TypeVar("Value", bound=Hashable)


class Extractor(Generic[Value]):
    """Turns functions of the state, given as disjoint sets with a value each, into nodes of one shared diagram.

    The parts of a function are numbered, the default being 0, and only the digits of these numbers are followed down
    the diagrams: of 30 ranks, 5 sets.
    """

    def __init__(self, encoding: Encoding, builder: DiagramBuilder[Value], default: Value) -> None:
        self._manager = encoding.manager
        self._default = default
        self._node = builder.node
        self._leaf = builder.leaf
        self._sets = Sets(encoding.order, [len(variable.values) for variable in encoding.spec.variables])
        self._bits = [[self._manager.level(bit) for bit in encoding.state_bits[each]] for each in encoding.order]
        self._tested = {bit: level for level, bits in enumerate(self._bits) for bit in bits}
        self._taken = {self._manager.false: NOTHING, self._manager.true: EVERYTHING}
        self._known: dict[tuple[Reference, ...], dict[tuple[Reference, ...], Reference]] = {}

    def function(self, parts: Sequence[tuple[Value, Bdd]]) -> Reference:
        """The reference of the function that has each part's value in that part and the default elsewhere.

        Raises `LimitReachedError` when time is up.
        """
        self._manager.context.check()
        leaves = (self._leaf(self._default), *(self._leaf(value) for value, _ in parts))
        digits = (
            self._manager.union(states for number, (_, states) in enumerate(parts, 1) if number >> digit & 1)
            for digit in range(len(parts).bit_length())
        )
        return self._build(tuple(map(self._take, digits)), leaves, self._known.setdefault(leaves, {}))

    def _build(
        self,
        digits: tuple[Reference, ...],
        leaves: tuple[Reference, ...],
        known: dict[tuple[Reference, ...], Reference],
    ) -> Reference:
        """The function that has in every state the leaf with the number of which these sets are the digits."""
        found = known.get(digits)
        if found is None:
            self._manager.context.check()
            sets = self._sets
            if all(map(sets.is_leaf, digits)):
                found = leaves[sum(digit << place for place, digit in enumerate(digits))]
            else:
                level = sets.top(*digits)
                each = zip(*[sets.below(level, digit) for digit in digits], strict=True)
                found = self._node(level, tuple([self._build(rest, leaves, known) for rest in each]))
            known[digits] = found
        return found

    def _take(self, states: Bdd) -> Reference:
        """A set of bit vectors as one of states."""
        found = self._taken.get(states)
        if found is None:
            self._manager.context.check()
            level = self._tested[self._manager.top(states)]
            below: list[Reference] = []
            for rest, values in self._by_value(states, level):
                below += repeat(self._take(rest), values)
            found = self._taken[states] = self._sets.node(level, tuple(below))
        return found

    def _by_value(self, states: Bdd, level: int) -> Iterator[tuple[Bdd, int]]:
        """What is left of a set for the values of the variable at a level, each with how many values in turn do so."""
        manager, bits = self._manager, self._bits[level]
        pending = [(states, 0, self._sets.sizes[level])]
        while pending:
            rest, place, values = pending.pop()
            if manager.top(rest) > bits[-1]:
                yield rest, values
            else:
                low, high = manager.halves(rest, bits[place])
                half = 1 << (len(bits) - place - 1)
                if values > half:
                    pending.append((high, place + 1, values - half))
                pending.append((low, place + 1, min(values, half)))
