"""A policy as a tree of questions about the state: what is asked first, and what is folded for lack of lines."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from heapq import heappop, heappush
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.diagrams import NOTHING, Reference, room_for
from tumato_symbolic.views.joint import Joint
from tumato_symbolic.views.selected import OTHERS, Label

_SMALL = 1_500
"""Nodes of a function for which the best question is sought; of a larger one, the first variable is asked for."""


class Answer(Struct, frozen=True):
    """What is done in so many states, all alike."""

    label: Label
    states: int


class Folded(Struct, frozen=True):
    """So many states with so many different decisions, which are not shown one by one."""

    decisions: int
    states: int


class Branch(Struct, frozen=True):
    """Some values of a variable, and what follows if it has one of them."""

    values: tuple[int, ...]
    tree: Tree


class Question(Struct, frozen=True):
    """Which value a variable has; values with which no state is looked at are in no branch."""

    variable: int
    branches: tuple[Branch, ...]
    states: int


Tree: TypeAlias = Answer | Folded | Question

Condition: TypeAlias = tuple[tuple[int, tuple[int, ...]], ...]
"""Variables with the values that they may have, in the order in which they are asked for."""


class Row(Struct, frozen=True):
    """A leaf of a tree with the answers that lead there."""

    condition: Condition
    leaf: Answer | Folded


def rows(tree: Tree) -> list[Row]:
    """The leaves in order but those where something else is done. Their conditions exclude each other."""
    found: list[Row] = []

    def visit(here: Tree, condition: Condition) -> None:
        if isinstance(here, Question):
            for branch in here.branches:
                visit(branch.tree, (*condition, (here.variable, branch.values)))
        elif isinstance(here, Folded) or not here.label.other:
            found.append(Row(condition, here))

    visit(tree, ())
    return found


class Box(Struct, frozen=True):
    """A function of a graph. `branches` lead to others, by reference; a leaf has none and is folded, or decided."""

    reference: Reference
    variable: int | None
    branches: tuple[tuple[tuple[int, ...], Reference], ...]
    label: Label | None
    decisions: int

    @property
    def is_folded(self) -> bool:
        """Whether different decisions are not shown one by one."""
        return self.variable is None and self.label is None


class Questions:
    """Asks, of each function, for the variable that leaves least to be asked; equal functions are asked alike."""

    def __init__(self, joint: Joint[Label]) -> None:
        self._joint = joint
        self._known: dict[Reference, tuple[int, list[tuple[tuple[int, ...], Reference]]]] = {}

    def tree(self, most: int, *, leaves_only: bool = False) -> Tree | None:
        """The whole tree, or as much of it as `most` lines hold, where most states are first; None of no states.

        A branch is a line; with `leaves_only`, only those that end in a leaf are.
        """
        if self._joint.root == NOTHING:
            return None
        with room_for(len(self._joint.sets.order)):
            return self._tree(most, leaves_only)

    def _tree(self, most: int, leaves_only: bool) -> Tree:
        joint, root = self._joint, self._joint.root
        places: dict[int, tuple[Reference, int]] = {0: (root, joint.count(root))}
        children: dict[int, list[tuple[tuple[int, ...], int]]] = {}
        waiting: list[tuple[int, int]] = []
        lines = int(leaves_only)

        def wait(place: int) -> None:
            reference, states = places[place]
            if joint.label(reference) is None:
                heappush(waiting, (-states, place))

        wait(0)
        while waiting:
            _, place = heappop(waiting)
            reference, states = places[place]
            level, groups = self._question(reference)
            lines += len(groups) - leaves_only
            if lines > most:
                break
            size = joint.sets.sizes[level]
            children[place] = []
            for values, below in groups:
                number = len(places)
                places[number] = below, self._share(states, reference, below, len(values), size)
                children[place].append((values, number))
                wait(number)

        def built(place: int) -> Tree:
            reference, states = places[place]
            if place in children:
                level, _ = self._question(reference)
                branches = tuple([Branch(values, built(number)) for values, number in children[place]])
                return Question(joint.sets.order[level], branches, states)
            label = joint.label(reference)
            return Folded(self._decisions(reference), states) if label is None else Answer(label, states)

        return built(0)

    def graph(self, most: int) -> list[Box]:
        """The boxes of a graph in which equal parts are one, from the first question on; at most so many."""
        if self._joint.root == NOTHING:
            return []
        with room_for(len(self._joint.sets.order)):
            return list(self._boxes(most))

    def _boxes(self, most: int) -> Iterator[Box]:
        joint, root = self._joint, self._joint.root
        seen, waiting = {root}, deque([root])
        while waiting:
            reference = waiting.popleft()
            label = joint.label(reference)
            variable, branches = None, list[tuple[tuple[int, ...], Reference]]()
            if label is None:
                level, groups = self._question(reference)
                fresh = list(dict.fromkeys(below for _, below in groups if below not in seen))
                if len(seen) + len(fresh) <= most:
                    variable, branches = joint.sets.order[level], groups
                    seen.update(fresh)
                    waiting += fresh
            decisions = self._decisions(reference)
            yield Box(reference, variable, tuple(branches), label, decisions)

    def _share(self, states: int, reference: Reference, below: Reference, values: int, size: int) -> int:
        """How many of the states of a place go on to a place below, by one of several values of a variable."""
        return states * values * self._joint.count(below) // (size * self._joint.count(reference))

    def _decisions(self, reference: Reference) -> int:
        """How many different decisions a function leads to."""
        return sum(label != OTHERS for label in self._joint.labels(reference))

    def _question(self, reference: Reference) -> tuple[int, list[tuple[tuple[int, ...], Reference]]]:
        """The level that is asked for, and what is left for which of its values."""
        found = self._known.get(reference)
        if found is None:
            found = self._known[reference] = self._best(reference)
        return found

    def _best(self, reference: Reference) -> tuple[int, list[tuple[tuple[int, ...], Reference]]]:
        joint = self._joint
        levels = joint.tested(reference)
        splits = ((level, self._groups(reference, level)) for level in levels)
        useful = (each for each in splits if len(each[1]) > 1)
        if joint.is_large(reference, _SMALL):
            return next(useful)
        return min(useful, key=lambda each: (*self._cost(each[1]), joint.sets.order[each[0]]))

    def _groups(self, reference: Reference, level: int) -> list[tuple[tuple[int, ...], Reference]]:
        """Values that make no difference to each other stay together."""
        parts: dict[Reference, list[int]] = {}
        for value, below in enumerate(self._joint.split(reference, level)):
            if below != NOTHING:
                parts.setdefault(below, []).append(value)
        return [(tuple(values), below) for below, values in parts.items()]

    def _cost(self, parts: Sequence[tuple[tuple[int, ...], Reference]]) -> tuple[int, int]:
        """How many lines a question will need at least: one for every answer that differs below it."""
        distinct = [len(self._joint.leaves(below)) for _, below in parts]
        return sum(distinct) + sum(number > 1 for number in distinct), len(parts)
