"""Which aliases use which: an order in which each is defined after those that it uses, and the cycles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence, Set
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.spec.names import Names
from tumato_symbolic.syntax import ast

Uses: TypeAlias = Sequence[Sequence[int]]
"""For every alias, the numbers of those that its predicate names directly."""


class Cycle(Struct, frozen=True):
    """Aliases each of which uses the next, and the last one the first."""

    aliases: tuple[int, ...]


def mentioned(predicate: ast.Predicate, names: Names) -> tuple[int, ...]:
    """The aliases that a predicate names directly."""
    match predicate:
        case ast.Reference(name):
            declared = names.table.get(name.text)
            return (declared.number,) if declared is not None and declared.kind == "alias" else ()
        case ast.Negation(operand):
            return mentioned(operand, names)
        case ast.Conjunction(operands) | ast.Disjunction(operands):
            return tuple(number for each in operands for number in mentioned(each, names))
        case ast.Implication(left, right) | ast.Equivalence(left, right):
            return mentioned(left, names) + mentioned(right, names)
        case _:
            return ()


def reachable(first: Iterable[int], uses: Uses, known: Set[int]) -> set[int]:
    """Some aliases and all that they use, directly or not, without those that are known, and what these use."""
    found: set[int] = set()
    waiting = list(first)
    while waiting:
        alias = waiting.pop()
        if alias not in known and alias not in found:
            found.add(alias)
            waiting.extend(uses[alias])
    return found


def definitions(uses: Uses) -> Iterator[int | Cycle]:
    """Every alias once, after those that it uses, or in a cycle; without recursion, since chains may be long."""
    done: set[int] = set()
    for alias in range(len(uses)):
        path = [alias]
        on_path = {alias}
        while path:
            here = path[-1]
            following = next((each for each in uses[here] if each not in done), None)
            if here in done or following is None:
                if here not in done:
                    done.add(here)
                    yield here
                path.pop()
                on_path.discard(here)
            elif following in on_path:
                cycle = Cycle(tuple(path[path.index(following) :]))
                done.update(cycle.aliases)
                yield cycle
            else:
                path.append(following)
                on_path.add(following)
