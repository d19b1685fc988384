"""Which of many moves matter for a set: those that can lead into it, or those that it makes.

An action with clauses has a move for each of its cases, most of which have nothing to do with a small set.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from tumato_symbolic.symbolic.manager import Bdd, Manager

FEW_MOVES = 32
"""So many moves are all tried."""


class Leading:
    """Moves by what they write, as constants for bits, each with what stands for it."""

    def __init__(self, manager: Manager, moves: Sequence[tuple[Mapping[str, bool], Bdd]]) -> None:
        self._manager, self._moves = manager, moves
        self._by_bits: dict[tuple[str, ...], dict[tuple[bool, ...], list[int]]] = {}
        for number, (written, _) in enumerate(moves):
            bits = tuple(sorted(written))
            values = tuple(written[bit] for bit in bits)
            self._by_bits.setdefault(bits, {}).setdefault(values, []).append(number)

    def into(self, target: Bdd) -> Bdd:
        """What stands for a move, where the move leads into a set of states, for all moves together."""
        cofactor = self._manager.cofactor
        return self._manager.union(pairs & cofactor(target, written) for written, pairs in self._relevant(target))

    def _relevant(self, target: Bdd) -> Iterator[tuple[Mapping[str, bool], Bdd]]:
        for bits, by_values in self._by_bits.items():
            values = present(self._manager, target, bits, len(by_values) // 2) if len(by_values) > FEW_MOVES else None
            if values is None:
                yield from (self._moves[number] for numbers in by_values.values() for number in numbers)
            else:
                yield from (self._moves[number] for each in values for number in by_values.get(each, ()))


def present(manager: Manager, found: Bdd, bits: Sequence[str], most: int) -> list[tuple[bool, ...]] | None:
    """The values that some bits have together in a set; None where there are more than `most`."""
    kept = frozenset(bits)
    projected = manager.exists([bit for bit in manager.bits if bit not in kept], found)
    if manager.count(projected, bits) > most:
        return None
    parts: list[tuple[tuple[bool, ...], Bdd]] = [((), projected)]
    for bit in bits:
        split = (
            ((*values, value), manager.cofactor(part, {bit: value}))
            for values, part in parts
            for value in (False, True)
        )
        parts = [(values, part) for values, part in split if part != manager.false]
    return [values for values, _ in parts]
