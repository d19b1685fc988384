"""Steps taken in turns: one group of actions after the other, where that comes to the same.

The sets of a relation are taken apart group by group. Where a group may act first, and what the others may do depends
on the state that it leaves only, what leads into a set is found for the others first and then for the group: the work
is the sum of what the groups do, not its product.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd, Manager

MOST_TURN_MOVES = 1000
"""A relation that takes more moves, in all turns together, is not taken in turns."""


class Move(Struct, frozen=True, eq=False):
    """What a group writes in its turn: its `choices` that write it, where they are taken, and where that leads.

    `after` may hold more, where what is written was something else before.
    """

    written: tuple[str, ...]
    choices: Bdd
    before: Bdd
    after: Bdd

    def into(self, manager: Manager, target: Bdd) -> Bdd:
        """Where the move is taken and leads into a set; what the set says of other things than states is kept."""
        if not self.written:
            return target & self.before
        return manager.and_exists(self.written, target, self.after) & self.before


class Turn(Struct, frozen=True, eq=False):
    """The turn of a group: what it may do, and for each part of that the turn of the next group from there.

    `states` are those that the relation relates to some set. After the last turn there are no branches.
    """

    manager: Manager
    states: Bdd
    branches: tuple[tuple[tuple[Move, ...], Turn], ...]

    def into(self, target: Bdd) -> Bdd:
        """The states that some set of the relation leads into a set of states."""
        return self.each_into(target, {})

    def each_into(self, target: Bdd, known: dict[Turn, Bdd]) -> Bdd:
        """`into`, with what it is for every turn from here on."""
        if self not in known:
            known[self] = (
                self.manager.balanced_union(self._parts(target, known)) if self.branches else self.states & target
            )
        return known[self]

    def _parts(self, target: Bdd, known: dict[Turn, Bdd]) -> Iterator[Bdd]:
        for moves, then in self.branches:
            following = then.each_into(target, known)
            yield from (move.into(self.manager, following) for move in moves)


_Known: TypeAlias = dict[tuple[Bdd, tuple[int, ...]], Turn]


def in_turns(encoding: Encoding, relation: Bdd) -> Turn | None:
    """A relation of sets whose nominal effects agree, taken in turns; None where it cannot be, or takes too many."""
    try:
        return _turn(encoding, relation, tuple(range(len(encoding.groups))), {})
    except _NotInTurnsError:
        return None


class _NotInTurnsError(Exception):
    """No group may act first, or there would be too many moves."""


def _turn(encoding: Encoding, relation: Bdd, groups: tuple[int, ...], known: _Known) -> Turn:
    """The turns of some groups, to which the choices of a relation belong; `known` has all turns so far."""
    key = (relation, groups)
    if key not in known:
        manager = encoding.manager
        first, parts = _fewest_parts(encoding, relation, groups)
        rest = tuple(group for group in groups if group != first)
        branches = tuple((moves, _turn(encoding, left, rest, known)) for moves, left in parts)
        states = manager.exists([bit for group in groups for bit in encoding.groups[group].bits], relation)
        known[key] = Turn(manager, states, branches)
        if sum(len(moves) for turn in known.values() for moves, _ in turn.branches) > MOST_TURN_MOVES:
            raise _NotInTurnsError
    return known[key]


_Parts: TypeAlias = Sequence[tuple[tuple[Move, ...], Bdd]]
"""Moves of a group, and the relation of the other groups in the states where they lead."""


def _fewest_parts(encoding: Encoding, relation: Bdd, groups: Sequence[int]) -> tuple[int | None, _Parts]:
    """The group that had best act first, and its moves with what comes after them."""
    best: tuple[int, _Parts] | None = None
    for group in groups:
        rest = [bit for other in groups if other != group for bit in encoding.groups[other].bits]
        parts = _apart(encoding.manager, _moves(encoding, relation, group, rest))
        if parts is not None and (best is None or len(parts) < len(best[1])):
            best = group, parts
            if len(parts) == 1:
                break
    if best is None and groups:
        raise _NotInTurnsError
    return best or (None, ())


def _moves(encoding: Encoding, relation: Bdd, group: int, rest: Sequence[str]) -> Iterator[tuple[Move, Bdd]]:
    """The moves of a group in a relation, each with what the other groups may do in the states where it is taken."""
    manager, bits = encoding.manager, encoding.groups[group].bits
    for effect, choices in encoding.nominal_moves[group]:
        left = manager.and_exists(bits, relation, choices)
        if left != manager.false:
            values, before = encoding.assignment_bits(effect), manager.exists(rest, left)
            yield Move(tuple(values), choices, before, _written(manager, values, before)), left


def _written(manager: Manager, values: Mapping[str, bool], where: Bdd) -> Bdd:
    """What some pairs or states become when constants are written."""
    return manager.exists(values, where) & manager.cube(values) if values else where


def _apart(manager: Manager, moves: Iterator[tuple[Move, Bdd]]) -> _Parts | None:
    """Moves by what the others may do afterwards, as few such relations as are found; None where that is no relation.

    Moves share a relation if, taken back to where each move is made, it is exactly what the others may do there.
    """
    parts: list[tuple[list[tuple[Move, Bdd]], Bdd]] = []
    for move, left in moves:
        pushed = (manager.exists(move.written, left) & move.after) if move.written else left
        for number, (several, relation) in enumerate([*parts, ([], manager.false)]):
            both = relation | pushed
            if all(each.into(manager, both) == own for each, own in (*several, (move, left))):
                parts[number : number + 1] = [([*several, (move, left)], both)]
                break
        else:
            return None
    return [(tuple(move for move, _ in several), relation) for several, relation in parts]


class Rounds:
    """Rounds of a search backward: which states lead into a set of the round and into none of an earlier one."""

    def __init__(self, turn: Turn) -> None:
        self._manager, self._turn = turn.manager, turn
        self._seen: dict[Turn, Bdd] = {}
        self._fresh: dict[Turn, list[Bdd]] = {}

    def into(self, target: Bdd) -> Bdd:
        """The states that lead into the set of the next round; the sets of all rounds are disjoint."""
        known: dict[Turn, Bdd] = {}
        self._turn.each_into(target, known)
        for turn, states in known.items():
            seen = self._seen.get(turn, self._manager.false)
            self._fresh.setdefault(turn, []).append(states & ~seen)
            self._seen[turn] = seen | states
        return self._fresh[self._turn][-1]

    def pairs(self) -> Bdd:
        """Every state with those of its sets, and maybe others that write the same, that lead into its first set."""
        if not self._fresh:
            return self._manager.false
        return self._pairs(self._turn, {turn: self._digits(fresh) for turn, fresh in self._fresh.items()}, {})

    def _digits(self, fresh: Sequence[Bdd]) -> list[Bdd]:
        """The numbers of the rounds in binary; that of the first is 1, and 0 stands for none."""
        return [
            self._manager.union(states for number, states in enumerate(fresh, 1) if number >> digit & 1)
            for digit in range(len(fresh).bit_length())
        ]

    def _pairs(self, turn: Turn, digits: Mapping[Turn, Sequence[Bdd]], known: dict[Turn, Bdd]) -> Bdd:
        manager = self._manager
        if not turn.branches:
            return manager.true
        if turn not in known:
            parts = []
            for moves, then in turn.branches:
                following = self._pairs(then, digits, known)
                for move in moves:
                    agreed = move.into(manager, self._seen[then])
                    for digit, after in zip(digits[turn], digits[then], strict=True):
                        agreed = _agreeing(agreed, digit, move.into(manager, after))
                    parts.append(agreed & move.choices & move.into(manager, following))
            known[turn] = manager.balanced_union(parts)
        return known[turn]


def _agreeing(among: Bdd, one: Bdd, other: Bdd) -> Bdd:
    """Where in a set two others agree."""
    here = among & one
    return (here & other) | ((among & ~here) & ~other)
