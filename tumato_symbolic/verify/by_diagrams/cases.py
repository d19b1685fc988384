"""What a policy nominally writes, case by case: in each part of the states where it acts, the same constants.

The parts are found one by one, each as a predicate: one function that tells for every state what is written there may
be far larger than all of them together, for it has to remember one machine while it looks at the next.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from tumato_symbolic.spec import Spec
from tumato_symbolic.verify.by_diagrams.functions import FALSE, Function
from tumato_symbolic.verify.by_diagrams.walk import Walk

MOST_CASES = 128
"""So many different things that a policy nominally writes are looked at apart, for every `NODES_OF_A_BLOCK`.

Actions in different blocks that are independent of one another write far more different things than the policy has
nodes.
"""

NODES_OF_A_BLOCK = 64
"""Policies with fewer nodes for a block count as if they had so many."""

_Written: TypeAlias = int
"""Variables with values that are written, a bit for each."""


class Case(NamedTuple):
    """States in which the same constants are written; `changed` has what else is, where it depends on the state."""

    where: Function
    writes: Mapping[int, int]
    changed: Mapping[int, Function]


class _Block(NamedTuple):
    """Actions of which one at most is executed in a state: where one is, and where what is written."""

    actions: Sequence[int]
    busy: Function
    parts: Mapping[_Written, Function]


class Cases:
    """The states `acting`, taken apart by what actions nominally write there.

    `executed` has for every group of actions that exclude each other, the largest first, where which of them are.
    """

    def __init__(self, spec: Spec, walk: Walk, acting: Function, executed: Sequence[Mapping[int, Function]]) -> None:
        self._spec, self._walk, self._acting, self._groups = spec, walk, acting, executed
        self._executed = {action: where for group in executed for action, where in group.items()}
        pairs = sorted({pair for action in spec.actions for pair in action.nominal})
        self._bit = {pair: 1 << place for place, pair in enumerate(pairs)}
        self._blocks = self._in_blocks()

    def apart(self, nodes: int) -> list[Case]:
        """By all actions where that makes few cases for a policy of so many nodes; else by those of a group.

        What others do is then beside that.
        """
        most = MOST_CASES * max(1, nodes // (NODES_OF_A_BLOCK * len(self._blocks) or 1))
        parts, others = self._parts(most), list[int]()
        if parts is None:
            taken = [action for action in self._blocks[0].actions if action in self._groups[0]]
            parts = self._by_written(taken)
            parts[0] = self._walk.without(self._acting, self._walk.any_of(parts.values()))
            others = [action for action in self._executed if action not in taken]
        return [self._case(where, written, others) for written, where in sorted(parts.items())]

    def _in_blocks(self) -> list[_Block]:
        """Every action in the first block, where that has room for it, or in one of its group."""
        walk = self._walk
        actions, busy = list[list[int]](), list[Function]()
        for group in self._groups:
            own = len(busy)
            for action, where in group.items():
                numbers = (0, *range(own, len(busy))) if busy else ()
                number = next((each for each in numbers if walk.all_of((busy[each], where)) == FALSE), len(busy))
                if number == len(busy):
                    actions.append([])
                    busy.append(FALSE)
                actions[number].append(action)
                busy[number] = walk.any_of((busy[number], where))
        return [_Block(each, taken, self._by_written(each)) for each, taken in zip(actions, busy, strict=True)]

    def _by_written(self, actions: Iterable[int]) -> dict[_Written, Function]:
        parts = defaultdict[_Written, list[Function]](list)
        for action in actions:
            parts[sum(self._bit[pair] for pair in self._spec.actions[action].nominal)].append(self._executed[action])
        return self._joined(parts)

    def _joined(self, parts: Mapping[_Written, Iterable[Function]]) -> dict[_Written, Function]:
        joined = {written: self._walk.any_of(each) for written, each in parts.items()}
        return {written: where for written, where in joined.items() if where != FALSE}

    def _parts(self, most: int) -> dict[_Written, Function] | None:
        """By what is written, block by block; None where that makes too many."""
        walk, found = self._walk, {0: self._acting}
        for block in self._blocks:
            parts = defaultdict[_Written, list[Function]](list)
            for written, where in found.items():
                parts[written].append(walk.without(where, block.busy))
                for more, part in block.parts.items():
                    parts[written | more].append(walk.all_of((where, part)))
            found = self._joined(parts)
            if len(found) > most:
                return None
        return found

    def _case(self, where: Function, written: _Written, others: Sequence[int]) -> Case:
        """Some states in which these constants are written, and whatever `others` write there."""
        walk, changed = self._walk, dict[int, Function]()
        writes = dict(pair for pair, bit in self._bit.items() if written & bit)
        for action in others:
            executed = walk.all_of((where, self._executed[action]))
            for variable, value in self._spec.actions[action].nominal if executed != FALSE else ():
                if variable not in writes:
                    stays = changed.get(variable, walk.variable(variable))
                    changed[variable] = walk.select(walk.within(where, executed), (stays, walk.constant(value)))
        return Case(where, writes, changed)
