"""Tiny specifications in the language, and states and sets of actions in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from itertools import combinations

from msgspec import Struct

from tumato_symbolic import parse
from tumato_symbolic.semantics import ActionSet, State, action_names, all_states, cases_in, named
from tumato_symbolic.spec import Ordering, Spec

BOTH: tuple[Ordering, ...] = ("any", "first")

Decisions = Mapping[str, str]
"""A policy in words: for a state the names of the actions."""


REMEMBERED = 4
"""Specifications for which an engine keeps what it has built: a manager of diagrams takes megabytes."""


class World(Struct, frozen=True):
    """A specification, as text and as a record, under one effect ordering."""

    text: str
    spec: Spec
    ordering: Ordering

    def state(self, words: str) -> State:
        """A state by its values: `ab` where all values are letters, else `corridor low`."""
        return next(state for state in all_states(self.spec) if self.words(state) == words)

    def words(self, state: State) -> str:
        """The values of a state."""
        values = named(self.spec, state).values()
        return ("" if all(len(value) == 1 for value in values) else " ").join(values)

    def actions(self, names: str) -> ActionSet:
        """A set of actions by their names, in the order of declaration."""
        return frozenset(map(self.spec.action_names.index, names.split()))

    def cases(self, state: State, actions: ActionSet) -> ActionSet:
        """What a set of actions is in a state, as engines number it."""
        return cases_in(self.spec, actions, state)

    def names(self, chosen: ActionSet) -> str:
        """The names of a set of actions, as declared."""
        return " ".join(action_names(self.spec, chosen))

    def rows(self, decisions: Decisions) -> dict[State, ActionSet]:
        """A policy in the numbers of the specification."""
        rows = {self.state(state): self.actions(names) for state, names in decisions.items()}
        return {state: self.cases(state, chosen) for state, chosen in rows.items()}

    def decisions(self, rows: Mapping[State, ActionSet]) -> dict[str, str]:
        """A policy in words."""
        return {self.words(state): self.names(chosen) for state, chosen in rows.items()}

    def sets(self) -> Iterable[ActionSet]:
        """Every set of actions, the small ones first."""
        numbers = range(len(self.spec.cases))
        return (frozenset(some) for size in range(len(numbers) + 1) for some in combinations(numbers, size))


@cache
def world(text: str, ordering: Ordering = "any") -> World:
    """The meaning of a text under an effect ordering."""
    return World(text, parse(text), ordering)


def text(variables: Mapping[str, str], **blocks: str) -> str:
    """A specification: `text({"x": "abc"}, ACTIONS="action go nominal effects: x is b")`; `_` stands for a space."""
    states = " ".join(f"state {name} can be {', '.join(values)}" for name, values in variables.items())
    parts = {"STATE VECTOR": states, **{title.replace("_", " "): body for title, body in blocks.items()}}
    return "\n".join(f"BEGIN {title} {body} END {title}" for title, body in parts.items())
