"""What formulas say about their own variables, decided by a bounded search."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

from tumato_symbolic.spec.fold import THREE_VALUED, fold
from tumato_symbolic.spec.formula import And, Constant, Executing, Formula, Is, atoms, children

Known: TypeAlias = dict[tuple[str, int], int]
"""Part of a state and of a set of actions: value by ("variable", number), 0 or 1 by ("action", number)."""


class OutOfBudgetError(Exception):
    """The search was given up."""


class Budget:
    """How many terms may still be looked at."""

    def __init__(self, terms: int) -> None:
        self._left = terms

    @property
    def is_spent(self) -> bool:
        """Whether more was asked for than there was."""
        return self._left < 0

    def spend(self, terms: int) -> None:
        """Take `terms` off, or raise `OutOfBudgetError`."""
        self._left -= terms
        if self._left < 0:
            raise OutOfBudgetError


def size(formula: Formula) -> int:
    """How many atoms and operators a formula has."""
    return 1 + sum(size(part) for part in children(formula))


def unknowns(formula: Formula) -> list[tuple[str, int]]:
    """What the truth of a formula depends on, in order of first mention."""
    return list(dict.fromkeys(map(unknown_of, atoms(formula))))


def models(formula: Formula, sizes: Mapping[int, int], budget: Budget) -> Iterator[Known]:
    """Every assignment to the unknowns of `formula` that satisfies it, each once, in lexicographic order.

    `sizes` tells how many values each variable has. Raises `OutOfBudgetError` rather than searching for long.
    """
    open_ = unknowns(formula)
    known: Known = {}
    parts = formula.operands if isinstance(formula, And) else (formula,)
    pinned = [part for part in parts if isinstance(part, Is)]
    if any(known.setdefault(("variable", part.variable), part.value) != part.value for part in pinned):
        return
    rest = [part for part in parts if not isinstance(part, Is)]
    remaining = And(tuple(rest)) if len(rest) > 1 else rest[0] if rest else Constant(True)
    waiting = [each for each in open_ if each not in known]
    options = [range(sizes[number]) if kind == "variable" else range(2) for kind, number in waiting]
    yield from search(remaining, list(zip(waiting, options, strict=True)), known, budget)


def search(
    formula: Formula, open_: Sequence[tuple[tuple[str, int], Iterable[int]]], known: Known, budget: Budget
) -> Iterator[Known]:
    """Depth first, without recursion, cutting off what cannot become true any more.

    `open_` are the unknowns that are not known yet, each with what it may be.
    """
    cost = size(formula)
    choices: list[Iterator[int]] = []
    budget.spend(cost)
    if truth(formula, known) is False:
        return
    while True:
        if len(choices) == len(open_):
            yield dict(known)
        else:
            choices.append(iter(open_[len(choices)][1]))
        while choices:
            unknown = open_[len(choices) - 1][0]
            value = next(choices[-1], None)
            if value is None:
                choices.pop()
                known.pop(unknown, None)
                continue
            known[unknown] = value
            budget.spend(cost)
            if truth(formula, known) is not False:
                break
        else:
            return


def truth(formula: Formula, known: Mapping[tuple[str, int], int]) -> bool | None:
    """The truth value of a formula as far as it is settled by `known`."""

    def atom(atom: Is | Executing) -> bool | None:
        wanted = atom.value if isinstance(atom, Is) else 1
        found = known.get(unknown_of(atom))
        return None if found is None else found == wanted

    return fold(formula, atom, THREE_VALUED)


def unknown_of(atom: Is | Executing) -> tuple[str, int]:
    """What the truth of an atom depends on."""
    return ("variable", atom.variable) if isinstance(atom, Is) else ("action", atom.action)
