"""A policy in the states of a selection, as sets: what is shown of it. States are never listed."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.diagrams import LEAVES, NOTHING, Cube, Reference, Sets, room_for
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import DecisionDiagram, Policy, StateSets, Vocabulary, as_diagram
from tumato_symbolic.spec import Spec
from tumato_symbolic.views.joint import Joint
from tumato_symbolic.views.selection import Selection


class Label(Struct, frozen=True):
    """What is done in a state: a set of actions, by their numbers in order; None where nothing is decided.

    `other`: something else is done than what is selected.
    """

    actions: tuple[int, ...] | None
    unsafe: bool = False
    other: bool = False


OTHERS = Label(None, other=True)

OTHER = ""
"""Stands for an action where something else is done than what is selected; no action has that name."""


class Selected(Struct, frozen=True):
    """What a policy does in some `states`; the sets of `executed`, one for each action, and `unsafe` are parts of them.

    Without a specification every state counts, and none is known to be unsafe. `others` have the same values, and do
    not execute what is selected.
    """

    vocabulary: Vocabulary
    sets: Sets
    states: Reference
    decided: Reference
    unsafe: Reference
    executed: tuple[Reference, ...]
    others: Reference

    def joint(self, context: Context | None = None) -> Joint[Label]:
        """What is done in each of the states and `others`. Raises `UserError` (TUM508) where that is too much."""
        actions = [action for action, states in enumerate(self.executed) if states != NOTHING]

        def label(where: Sequence[bool]) -> Label:
            other, decided, unsafe, *executed = where
            if other:
                return OTHERS
            chosen = tuple(action for action, each in zip(actions, executed, strict=True) if each)
            return Label(chosen if decided else None, unsafe)

        with room_for(len(self.sets.order)):
            every = self.sets.either(self.states, self.others)
        given = (self.others, self.decided, self.unsafe, *(self.executed[action] for action in actions))
        return Joint(self.sets, every, given, label, uncounted=OTHERS, context=context)

    def as_policy(self) -> Policy:
        """The policy that decides these states only; where there are `others`, it executes `OTHER` there."""
        executed, decided, vocabulary = [*self.executed], self.decided, self.vocabulary
        with room_for(len(self.sets.order)):
            if self.others != NOTHING:
                executed, decided = [*executed, self.others], self.sets.either(decided, self.others)
                vocabulary = Vocabulary(vocabulary.variables, (*vocabulary.actions, OTHER))
            diagram, roots = self.sets.as_diagram([*executed, decided])
        return Policy(vocabulary, DecisionDiagram(diagram, roots[:-1], roots[-1]))


def select(policy: Policy, selection: Selection | None = None, spec: Spec | None = None) -> Selected:
    """The part of a policy that is selected.

    With a specification, whose vocabulary the policy has (`fitted`), only valid states are looked at.
    """
    selection = selection or Selection()
    decisions, vocabulary = as_diagram(policy), policy.vocabulary
    with room_for(len(vocabulary.variables)):
        sets = Sets(whole_order(decisions.diagram.order, vocabulary), vocabulary.sizes)
        *executed, defined = sets.take(decisions.diagram, (*decisions.roots, decisions.defined), LEAVES)
        states, unsafe = sets.cube(_cube(sets, vocabulary, selection)), NOTHING
        if spec is not None:
            formulas = StateSets.of(sets, spec)
            states = sets.both(states, formulas.where(spec.validity))
            unsafe = sets.without(states, formulas.where(spec.state_rules))
        every = states
        for name in selection.executing:
            states = sets.both(states, sets.both(executed[vocabulary.actions.index(name)], defined))
        decided = sets.both(states, defined)
        return Selected(
            vocabulary,
            sets,
            states,
            decided,
            sets.both(unsafe, states),
            tuple([sets.both(each, decided) for each in executed]),
            sets.without(every, states),
        )


def whole_order(order: Sequence[int], vocabulary: Vocabulary) -> list[int]:
    """An order of all variables that begins with the one given."""
    return [*order, *(variable for variable in range(len(vocabulary.variables)) if variable not in order)]


def _cube(sets: Sets, vocabulary: Vocabulary, selection: Selection) -> Cube:
    allowed = dict(selection.values)
    cube = []
    for level, variable in enumerate(sets.order):
        name, values = vocabulary.variables[variable]
        if name in allowed:
            cube.append((level, tuple(n for n, value in enumerate(values) if value in allowed[name])))
    return tuple(cube)
