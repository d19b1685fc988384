"""The states in which an execution may start: those that a policy decides and that have some given values."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from math import prod

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.policy import DecisionDiagram, Policy, Table
from tumato_symbolic.semantics import State, is_start
from tumato_symbolic.simulation.dice import Dice
from tumato_symbolic.spec import Spec

_LISTED = 10_000
"""Up to so many decided states, starts are looked for among all of them."""

_ATTEMPTS = 1_000
"""A policy decides valid states; where it decides others as well, a valid one is looked for so often."""


class NoStartError(Exception):
    """There is no state to start in."""


class Starts:
    """The starts that a bound policy decides in which variables have the values that are `given`.

    Where the specification says nothing of starts, every valid state is one.
    """

    def __init__(self, spec: Spec, policy: Policy, given: Mapping[int, int]) -> None:
        self._spec, self._policy, self._given = spec, policy, given

    def draw(self, dice: Dice) -> State:
        """One of them, each as likely as the others. Raises `NoStartError` where none was found."""
        if self._spec.starts and self._decided.count <= _LISTED:  # they may be few
            return dice.one_of(self._all())
        for _ in range(_ATTEMPTS):
            state = self._decided.draw(dice)
            if state is not None and is_start(self._spec, state):
                return state
        raise self._none

    def all(self, most: int) -> list[State] | None:
        """All of them; None where they are more than `most`. Raises `NoStartError` where there is none."""
        if self._decided.count > most:
            return None
        return self._all()

    def _all(self) -> list[State]:
        found = [state for state in self._decided.all() if is_start(self._spec, state)]
        if not found:
            raise self._none
        return found

    @property
    def _none(self) -> NoStartError:
        noun = "start" if self._spec.starts else "valid state"
        return NoStartError(f"the policy decides no {noun} with these values")

    @cached_property
    def _decided(self) -> _Rows | _Paths:
        decisions, sizes = self._policy.decisions, self._policy.vocabulary.sizes
        if isinstance(decisions, Table):
            return _Rows(decisions, self._given)
        return _Paths(decisions, [[self._given[at]] if at in self._given else range(n) for at, n in enumerate(sizes)])


class _Rows:
    """Of a table."""

    def __init__(self, table: Table, given: Mapping[int, int]) -> None:
        agreeing = (row for row in table.rows if all(row[at] == value for at, value in given.items()))
        self._rows = sorted(agreeing)
        self.count = len(self._rows)

    def draw(self, dice: Dice) -> State | None:
        return dice.one_of(self._rows) if self._rows else None

    def all(self) -> Iterator[State]:
        return iter(self._rows)


class _Paths:
    """Of a diagram, without listing them: `_weights` counts the states below each reference, from its level on."""

    def __init__(self, decisions: DecisionDiagram, values: list[list[int] | range]) -> None:
        diagram = decisions.diagram
        self._nodes, self._leaves, self._order = diagram.nodes, len(diagram.leaves), diagram.order
        self._root, self._values = decisions.defined, values
        self._untested = [at for at in range(len(values)) if at not in set(diagram.order)]
        self._sizes = [len(values[variable]) for variable in diagram.order]
        self._weights = [int(leaf) for leaf in diagram.leaves]
        for level, below in diagram.nodes:
            self._weights.append(sum(self._weight(below[value], level + 1) for value in values[self._order[level]]))
        self.count = self._weight(self._root, 0) * prod(len(values[at]) for at in self._untested)

    def _level(self, root: Reference) -> int:
        return len(self._order) if root < self._leaves else self._nodes[root - self._leaves][0]

    def _weight(self, root: Reference, level: int) -> int:
        """How many assignments to the variables from a level on lead to a decision."""
        return self._weights[root] * prod(self._sizes[level : self._level(root)])

    def _below(self, root: Reference, level: int, value: int) -> Reference:
        return root if self._level(root) > level else self._nodes[root - self._leaves][1][value]

    def draw(self, dice: Dice) -> State | None:
        if not self.count:
            return None
        state, root = {at: dice.one_of(self._values[at]) for at in self._untested}, self._root
        for level, variable in enumerate(self._order):
            rest = dice.below(self._weight(root, level))
            for value in self._values[variable]:
                below = self._below(root, level, value)
                rest -= self._weight(below, level + 1)
                if rest < 0:
                    state[variable], root = value, below
                    break
        return tuple(state[at] for at in range(len(self._values)))

    def all(self) -> Iterator[State]:
        found = [(self._root, dict[int, int]())]
        for level, variable in enumerate(self._order):
            found = [
                (below, {**fixed, variable: value})
                for root, fixed in found
                for value in self._values[variable]
                if self._weight(below := self._below(root, level, value), level + 1)
            ]
        for variable in self._untested:
            found = [(root, {**fixed, variable: value}) for root, fixed in found for value in self._values[variable]]
        return iter(sorted(tuple(fixed[at] for at in range(len(self._values))) for _, fixed in found))
