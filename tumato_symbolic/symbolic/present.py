"""Which of many moves matter for a set: those that can lead into it, or those that it makes.

An action with clauses has a move for each of its cases, most of which have nothing to do with a small set.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic.manager import Bdd, Manager

FEW_MOVES = 32
"""So many moves are all tried."""


LEAST_RELATED = 4
"""So many values that are written at least are taken together by a relation."""


class _Moves(Struct, frozen=True):
    """Moves by what they write. `ends` has what stands for those that write nothing (more).

    `branches` has, by bits and then by their values, these values and the moves that go on from there. `related` has
    those that write nothing but some bits and have the same values there before.
    """

    ends: Bdd
    branches: dict[tuple[str, ...], dict[tuple[bool, ...], list[tuple[Mapping[str, bool], _Moves]]]]
    related: dict[tuple[str, ...], _Related]


class _Related(Struct, frozen=True):
    """Moves that write some bits: `before` is what these are before; `written` what stands for which values there."""

    before: Bdd
    written: Bdd


class Leading:
    """Moves by what they write, each with what stands for it; `bits` turns what is written into constants for bits.

    Moves that write the same value are looked at together, what most of them write first: one cofactor serves all.
    Where it will be asked `often`, those that write different values in place of the same one are a relation.
    """

    def __init__(
        self,
        manager: Manager,
        moves: Iterable[tuple[Assignment, Bdd]],
        bits: Callable[[Assignment], Mapping[str, bool]],
        *,
        often: bool = False,
    ) -> None:
        self._manager, self._often = manager, often
        self._moves = self._together(list(moves), bits)  # kept itself, `bits` would hold the encoding

    def _together(
        self, moves: Sequence[tuple[Assignment, Bdd]], bits: Callable[[Assignment], Mapping[str, bool]]
    ) -> _Moves:
        often = Counter(each for written, _ in moves for each in written)
        ends = self._manager.union(pairs for written, pairs in moves if not written)
        by_most_often: dict[tuple[int, int], list[tuple[Assignment, Bdd]]] = {}
        for written, pairs in moves:
            if written:
                by_most_often.setdefault(max(written, key=often.__getitem__), []).append((written, pairs))
        found = _Moves(ends, {}, {})
        for first, several in by_most_often.items():
            shared = several[0][0] if len(several) == 1 else (first,)
            rests = [(tuple([each for each in written if each not in shared]), pairs) for written, pairs in several]
            values = bits(shared)
            by_values = found.branches.setdefault(tuple(values), {})
            by_values.setdefault(tuple(values.values()), []).append((values, self._together(rests, bits)))
        for places, by_values in [*found.branches.items()] if self._often else ():
            related = self._related(places, by_values)
            if related is not None:
                found.related[places] = related
                del found.branches[places]
        return found

    def _related(
        self, bits: tuple[str, ...], by_values: Mapping[tuple[bool, ...], list[tuple[Mapping[str, bool], _Moves]]]
    ) -> _Related | None:
        """Moves that write some bits as a relation, if they are many, write no more, and need the same values there."""
        manager, every = self._manager, [each for several in by_values.values() for each in several]
        if len(every) < LEAST_RELATED or any(below.branches or below.related for _, below in every):
            return None
        some = next((below.ends for _, below in every if below.ends != manager.false), None)
        if some is None:
            return None
        values = manager.some(some, bits)
        before = manager.cube(values)
        if any((below.ends & ~before) != manager.false for _, below in every):
            return None
        written = (manager.cofactor(below.ends, values) & manager.cube(after) for after, below in every)
        return _Related(before, manager.union(written))

    def into(self, target: Bdd) -> Bdd:
        """What stands for a move, where the move leads into a set of states, for all moves together."""
        return self._into(self._moves, target)

    def _into(self, moves: _Moves, target: Bdd) -> Bdd:
        manager = self._manager
        if target == manager.false:
            return target
        parts = (
            self._into(below, manager.cofactor(target, values))
            for bits, by_values in moves.branches.items()
            for values, below in self._relevant(target, bits, by_values)
        )
        together = (
            each.before & manager.and_exists(bits, each.written, target) for bits, each in moves.related.items()
        )
        return manager.union([moves.ends & target, *parts, *together])

    def _relevant(
        self,
        target: Bdd,
        bits: tuple[str, ...],
        by_values: Mapping[tuple[bool, ...], list[tuple[Mapping[str, bool], _Moves]]],
    ) -> Iterator[tuple[Mapping[str, bool], _Moves]]:
        met = present(self._manager, target, bits, len(by_values) // 2) if len(by_values) > FEW_MOVES else None
        for values in by_values if met is None else met:
            yield from by_values.get(values, ())


Written: TypeAlias = Mapping[str, tuple[Bdd, Bdd]]
"""For every bit that something writes, where it becomes 0, and where it becomes 1."""


def written_by(manager: Manager, moves: Iterable[tuple[Mapping[str, bool], Bdd]]) -> Written:
    """What some moves write together, each in what comes with it."""
    found: dict[str, tuple[Bdd, Bdd]] = {}
    for constants, where in moves:
        for bit, value in constants.items():
            zeros, ones = found.get(bit, (manager.false, manager.false))
            found[bit] = (zeros, ones | where) if value else (zeros | where, ones)
    return found


def next_values(manager: Manager, written: Written) -> Mapping[str, Bdd]:
    """The next value of every bit that is written; where it is not, it stays as it is."""
    return {bit: ones | (manager.cube({bit: True}) & ~zeros) for bit, (zeros, ones) in written.items()}


def present(manager: Manager, found: Bdd, bits: Sequence[str], most: int) -> list[tuple[bool, ...]] | None:
    """The values that some bits have together in a set; None where there are more than `most`."""
    kept = frozenset(bits)
    projected = manager.exists([bit for bit in manager.bits if bit not in kept], found)
    if manager.count(projected, bits) > most:
        return None
    return [values for values, _ in by_values(manager, projected, bits)]


def by_values(manager: Manager, found: Bdd, bits: Sequence[str]) -> list[tuple[tuple[bool, ...], Bdd]]:
    """What is left of a set for all values that some bits have together in it."""
    parts: list[tuple[tuple[bool, ...], Bdd]] = [((), found)]
    for bit in bits:
        split = (
            ((*values, value), manager.cofactor(part, {bit: value}))
            for values, part in parts
            for value in (False, True)
        )
        parts = [(values, part) for values, part in split if part != manager.false]
    return parts
