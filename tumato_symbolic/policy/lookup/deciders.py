"""How `decide` looks a state up in a table or a diagram, and how much it remembers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from msgspec import Struct

from tumato_symbolic.diagrams import Reference
from tumato_symbolic.policy.lookup.states import check_state
from tumato_symbolic.policy.records import DecisionDiagram, Table, Vocabulary
from tumato_symbolic.policy.text import described
from tumato_symbolic.spec import Value

_MOST_REMEMBERED = 20_000
"""After so many different places in the diagrams of a policy they are forgotten, and after so many states."""


class UndecidedState(ValueError):  # noqa: N818 - no error of the user: a state may be undecided rightly
    """The policy says nothing of a state: one that the assumptions exclude, or one that the policy forgot."""

    def __init__(self, state: Mapping[str, Value]) -> None:
        super().__init__(f"the policy does not decide this state: {described(state)}")
        self.state = dict(state)


class Decider(Protocol):
    """A policy prepared for being asked many times."""

    def decide(self, state: Mapping[str, Value]) -> tuple[str, ...]:
        """See `Policy.decide`."""


def make_decider(vocabulary: Vocabulary, decisions: Table | DecisionDiagram) -> Decider:
    """Prepare decisions for `Policy.decide`."""
    if isinstance(decisions, Table):
        return _by_table(vocabulary, decisions)
    return _DiagramDecider(vocabulary, decisions)


class _TableDecider(Struct, frozen=True):
    """Decisions by the row of a state."""

    vocabulary: Vocabulary
    names: tuple[str, ...]
    answers: dict[tuple[Value, ...], tuple[str, ...]]

    def decide(self, state: Mapping[str, Value]) -> tuple[str, ...]:
        try:
            if len(state) == len(self.names):
                return self.answers[tuple([state[name] for name in self.names])]
        except (KeyError, TypeError):
            pass
        named = check_state(self.vocabulary, state)
        answer = self.answers.get(tuple([named[name] for name in self.names]))
        if answer is None:
            raise UndecidedState(named)
        return answer


def _by_table(vocabulary: Vocabulary, table: Table) -> _TableDecider:
    texts: dict[frozenset[int], tuple[str, ...]] = {}
    answers: dict[tuple[Value, ...], tuple[str, ...]] = {}
    for state, chosen in table.rows.items():
        key = tuple([values[value] for (_, values), value in zip(vocabulary.variables, state, strict=True)])
        if chosen not in texts:
            texts[chosen] = tuple(vocabulary.actions[action] for action in sorted(chosen))
        answers[key] = texts[chosen]
    return _TableDecider(vocabulary, tuple(name for name, _ in vocabulary.variables), answers)


class _Answer(Struct, frozen=True):
    """What is done in a state; None where the policy does not decide it."""

    actions: tuple[str, ...] | None


class _Question(Struct, frozen=True):
    """Where the diagrams of a policy have come to together, and the variable that the first of them tests next."""

    variable: int
    level: int
    roots: tuple[Reference, ...]
    below: list[_Question | _Answer | None]


class _DiagramDecider:
    """Follows the diagrams of all actions at once, and remembers where that led, and what was decided of states.

    A robot is mostly in a state that it was in before, and looking that up takes half the time.
    """

    def __init__(self, vocabulary: Vocabulary, decisions: DecisionDiagram) -> None:
        self._vocabulary = vocabulary
        self._diagram = decisions.diagram
        self._numbers: list[tuple[str, dict[Value, int]]] = [
            (name, {value: at for at, value in enumerate(values)}) for name, values in vocabulary.variables
        ]
        self._names = tuple(name for name, _ in vocabulary.variables)
        self._answers: dict[tuple[Value, ...], tuple[str, ...]] = {}
        self._known: dict[tuple[Reference, ...], _Question | _Answer] = {}
        self._start = self._at((decisions.defined, *decisions.roots))

    def decide(self, state: Mapping[str, Value]) -> tuple[str, ...]:
        try:
            key = tuple([state[name] for name in self._names]) if len(state) == len(self._names) else None
            answer = self._answers.get(key) if key is not None else None
        except (KeyError, TypeError):
            key = answer = None
        return answer if answer is not None else self._look_up(state, key)

    def _look_up(self, state: Mapping[str, Value], key: tuple[Value, ...] | None) -> tuple[str, ...]:
        """What is decided in a state; remembered where its values, `key`, are written as the policy does."""
        values = None if key is None else self._places(key)
        if key is None or values is None:
            named = check_state(self._vocabulary, state)
            return self._actions([known[named[name]] for name, known in self._numbers], state)
        if len(self._answers) >= _MOST_REMEMBERED:
            self._answers.clear()
        answer = self._answers[key] = self._actions(values, state)
        return answer

    def _places(self, key: tuple[Value, ...]) -> list[int] | None:
        """The numbers of values; None where one is not written as the policy does."""
        try:
            return [known[value] for value, (_, known) in zip(key, self._numbers, strict=True)]
        except (KeyError, TypeError):
            return None

    def _actions(self, values: list[int], state: Mapping[str, Value]) -> tuple[str, ...]:
        here = self._start
        while isinstance(here, _Question):
            value = values[here.variable]
            here = here.below[value] or self._follow(here, value)
        if here.actions is None:
            raise UndecidedState(state)
        return here.actions

    def _follow(self, question: _Question, value: int) -> _Question | _Answer:
        nodes, base = self._diagram.nodes, len(self._diagram.leaves)
        roots = tuple(
            [
                nodes[root - base][1][value] if root >= base and nodes[root - base][0] == question.level else root
                for root in question.roots
            ]
        )
        if len(self._known) >= _MOST_REMEMBERED:
            self._known.clear()
            self._start = self._at(self._start.roots) if isinstance(self._start, _Question) else self._start
        found = question.below[value] = self._known.get(roots) or self._at(roots)
        return found

    def _at(self, roots: tuple[Reference, ...]) -> _Question | _Answer:
        nodes, leaves = self._diagram.nodes, self._diagram.leaves
        base = len(leaves)
        found: _Question | _Answer
        if roots[0] < base and not leaves[roots[0]]:
            found = _Answer(None)
        elif all(root < base for root in roots):
            chosen = zip(self._vocabulary.actions, roots[1:], strict=True)
            found = _Answer(tuple([name for name, root in chosen if leaves[root]]))
        else:
            level, below = min(nodes[root - base] for root in roots if root >= base)
            found = _Question(self._diagram.order[level], level, roots, [None] * len(below))
        self._known[roots] = found
        return found
