"""Several sets together: one diagram that leads every state to what they say of it."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from math import inf, prod
from typing import Generic, TypeVar

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagrams import EVERYTHING, NOTHING, Reference, Sets, room_for
from tumato_symbolic.limits import Context

MOST_LABELS = 10_000
"""Functions with more different labels are given up."""

MOST_PLACES = 500_000
"""Functions whose sets come together in more different ways are given up, too."""

Label = TypeVar("Label", bound=Hashable)


class Joint(Generic[Label]):
    """A function of the state: `root` leads to a label, or to `NOTHING` outside the states that are looked at.

    Like `root`, functions are references into `sets`, which have the order of those given: one of all variables.
    `uncounted` is a label whose states are not counted.
    """

    def __init__(
        self,
        sets: Sets,
        states: Reference,
        given: Sequence[Reference],
        label: Callable[[Sequence[bool]], Label],
        *,
        uncounted: Label | None = None,
        context: Context | None = None,
        most: int = MOST_LABELS,
    ) -> None:
        """Of a state of `states`, `label` says what it means in which of the sets given it is.

        Raises `UserError` (TUM508) where there are more than `most` labels, or it takes too many nodes.
        """
        self.context = context or Context()
        sizes = dict(zip(sets.order, sets.sizes, strict=True))
        self.sets = Sets(sets.order, [sizes[variable] for variable in range(len(sizes))], 2 + MOST_LABELS)
        self._from, self._label, self._uncounted, self._most = sets, label, uncounted, most
        self._labels: list[Label] = []
        self._references: dict[Label, Reference] = {}
        self._known: dict[tuple[Reference, ...], Reference] = {}
        self._leaves: dict[Reference, frozenset[Reference]] = {NOTHING: frozenset()}
        self._counts = {NOTHING: 0}
        self._parts: dict[tuple[Reference, int], tuple[Reference, ...]] = {}
        with room_for(len(self.sets.order)):
            self.root = self._at((states, *given))

    def label(self, reference: Reference) -> Label | None:
        """The label of all states that a function is about; None where they have different ones."""
        leaves = self.leaves(reference)
        return self._labels[next(iter(leaves)) - 2] if len(leaves) == 1 else None

    def labels(self, reference: Reference) -> list[Label]:
        """The different labels of a function, as they were found."""
        return [self._labels[leaf - 2] for leaf in sorted(self.leaves(reference))]

    def leaves(self, reference: Reference) -> frozenset[Reference]:
        """The same by their references."""
        found = self._leaves.get(reference)
        if found is None:
            if self.sets.is_leaf(reference):
                found = frozenset((reference,))
            else:
                found = frozenset()
                for each in self._below(reference):
                    found |= self.leaves(each)
            self._leaves[reference] = found
        return found

    def count(self, reference: Reference) -> int:
        """How many states have a label that counts, exactly."""
        return self._count(reference) * prod(self.sets.sizes[: self.sets.top(reference)])

    def counts(self) -> dict[Label, int]:
        """How many states have each label, exactly."""
        sizes, top = self.sets.sizes, self.sets.top
        reaching = {self.root: prod(sizes[: top(self.root)])}
        for here in self._downwards(self.root):
            for child in self._below(here):
                reaching[child] = reaching.get(child, 0) + reaching[here] * prod(sizes[top(here) + 1 : top(child)])
        return {label: reaching[leaf] for label, leaf in self._references.items() if leaf in reaching}

    def where(self, label: Label) -> Reference:
        """The set of states with a label."""
        leaf = self._references[label]
        found = {each: EVERYTHING if each == leaf else NOTHING for each in (NOTHING, *self.leaves(self.root))}
        for here in reversed(self._downwards(self.root)):
            found[here] = self.sets.node(self.sets.top(here), tuple([found[child] for child in self._below(here)]))
        return found[self.root]

    def _downwards(self, reference: Reference) -> list[Reference]:
        """The nodes of a function, each before those below it."""
        reached = self._reached(reference, inf)
        return sorted((each for each in reached if not self.sets.is_leaf(each)), reverse=True)

    def _reached(self, reference: Reference, enough: float) -> set[Reference]:
        """The nodes and leaves of a function; once there are more than is enough, no others are looked for."""
        pending, seen = [reference], {reference}
        while pending and len(seen) <= enough:
            here = pending.pop()
            if not self.sets.is_leaf(here):
                fresh = set(self._below(here)) - seen
                seen |= fresh
                pending += fresh
        return seen

    def tested(self, reference: Reference) -> list[int]:
        """The levels that a function tests."""
        return sorted({self.sets.top(each) for each in self._downwards(reference)})

    def is_large(self, reference: Reference, nodes: int) -> bool:
        """Whether a function has more nodes than that."""
        return len(self._reached(reference, nodes)) > nodes

    def split(self, reference: Reference, level: int) -> tuple[Reference, ...]:
        """What is left of a function for each value of the variable at a level."""
        top = self.sets.top(reference)
        if top >= level:
            return self.sets.below(level, reference)
        key = (reference, level)
        found = self._parts.get(key)
        if found is None:
            below = [self.split(each, level) for each in self._below(reference)]
            values = range(self.sets.sizes[level])
            found = tuple([self.sets.node(top, tuple([each[value] for each in below])) for value in values])
            self._parts[key] = found
        return found

    def _below(self, reference: Reference) -> tuple[Reference, ...]:
        return self.sets.below(self.sets.top(reference), reference)

    def _count(self, reference: Reference) -> int:
        found = self._counts.get(reference)
        if found is None:
            if self.sets.is_leaf(reference):
                found = int(self._labels[reference - 2] != self._uncounted)
            else:
                level = self.sets.top(reference) + 1
                found = 0
                for child in self._below(reference):
                    found += self._count(child) * prod(self.sets.sizes[level : self.sets.top(child)])
            self._counts[reference] = found
        return found

    def _at(self, roots: tuple[Reference, ...]) -> Reference:
        """What several sets say together; the first is that of the states that are looked at."""
        if roots[0] == NOTHING:
            return NOTHING
        found = self._known.get(roots)
        if found is None:
            self.context.check()
            level = self._from.top(*roots)
            if level == len(self._from.order):
                found = self._leaf(self._label([each != NOTHING for each in roots[1:]]))
            else:
                below = [self._at(part) for part in self._split(level, roots)]
                found = self.sets.node(level, tuple(below))
            self._known[roots] = found
            if len(self._known) > MOST_PLACES:
                raise _too_much(f"its diagrams come together in more than {MOST_PLACES:,} ways")
        return found

    def _split(self, level: int, roots: tuple[Reference, ...]) -> Iterator[tuple[Reference, ...]]:
        yield from zip(*[self._from.below(level, each) for each in roots], strict=True)

    def _leaf(self, label: Label) -> Reference:
        if label not in self._references:
            if len(self._labels) == self._most:
                raise _too_much(f"it takes more than {self._most:,} different decisions")
            self._references[label] = 2 + len(self._labels)
            self._labels.append(label)
        return self._references[label]


def _too_much(why: str) -> UserError:
    message = f"the policy is too large to be drawn: {why}"
    help_ = "look at a part of it: name values as VARIABLE=VALUE, or an action with --executing"
    return UserError((Diagnostic(Code.TUM508, message, help=help_),))
