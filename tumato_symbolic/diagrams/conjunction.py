"""In which order many predicates are conjoined, so that what is found on the way stays small."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import takewhile
from operator import itemgetter
from typing import TypeAlias, TypeVar

Predicate = TypeVar("Predicate")

Join: TypeAlias = Callable[[Predicate, Predicate], Predicate]

Levels: TypeAlias = Sequence[int]
"""The levels of the variables that a predicate tests, in ascending order; 0 is the top."""

FEW = 3
"""So many predicates are conjoined as they come."""


def conjoin(
    predicates: Iterable[Predicate],
    levels_of: Callable[[Predicate], Levels],
    both: Join[Predicate],
    everything: Predicate,
) -> Predicate:
    """The conjunction of any number of predicates.

    Of many, those that test the same variable first are conjoined, in the same way by the variables that follow; then
    these conjunctions with each other, the lowest first. Of pairs `xᵢ ≠ xⱼ` that is all that holds of one `xᵢ` and
    those below it, which are independent given `xᵢ`, before what holds of `xᵢ` meets what holds among those below.
    """
    waiting = list(predicates)
    if len(waiting) > FEW:
        return _lowest_first(sorted(((levels_of(each), each) for each in waiting), key=itemgetter(0)), both, everything)
    found = everything
    for each in waiting:
        found = both(found, each)
    return found


def _lowest_first(
    waiting: Sequence[tuple[Levels, Predicate]], both: Join[Predicate], everything: Predicate
) -> Predicate:
    """The conjunction of predicates that are sorted by their levels.

    On the stack is the conjunction of each group that is not ended, with the number of levels in which it agrees with
    the group below it.
    """
    stack = [(0, everything)]
    before: Levels = ()

    def end_groups(agreeing: int) -> None:
        while len(stack) > 1 and stack[-1][0] >= agreeing:
            _, last = stack.pop()
            stack[-1] = (stack[-1][0], both(stack[-1][1], last))

    for levels, each in reversed(waiting):
        agreeing = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(levels, before, strict=False)))
        end_groups(agreeing)
        stack.append((agreeing, each))
        before = levels
    end_groups(0)
    return stack[0][1]
