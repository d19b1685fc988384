"""Two policies over the names of both: names that were added or removed, and one order of variables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import NOTHING, Diagram, Reference, Sets, room_for
from tumato_symbolic.limits import Context
from tumato_symbolic.policy import Policy, Vocabulary, as_diagram

Values = tuple[tuple[str, tuple[str, ...]], ...]
"""Variables, each with some of its values."""


class NamesChanged(Struct, frozen=True):
    """What only one of two vocabularies has. `values` are those of variables that both have."""

    added_variables: Values
    removed_variables: Values
    added_values: Values
    removed_values: Values
    added_actions: tuple[str, ...]
    removed_actions: tuple[str, ...]

    @property
    def some(self) -> bool:
        """Whether there is any."""
        return any((*self.values_and_variables, self.added_actions, self.removed_actions))

    @property
    def values_and_variables(self) -> tuple[Values, ...]:
        """Those that say which states there are."""
        return self.added_variables, self.removed_variables, self.added_values, self.removed_values


def names_changed(old: Vocabulary, new: Vocabulary) -> NamesChanged:
    """What was added and removed; the order of declaration does not matter."""
    return NamesChanged(
        _without(new.variables, old.variables),
        _without(old.variables, new.variables),
        _values_of(new, old),
        _values_of(old, new),
        tuple(name for name in new.actions if name not in old.actions),
        tuple(name for name in old.actions if name not in new.actions),
    )


def _without(mine: Values, theirs: Values) -> Values:
    known = dict(theirs)
    return tuple((name, values) for name, values in mine if name not in known)


def _values_of(mine: Vocabulary, theirs: Vocabulary) -> Values:
    """The values that only mine has, of variables that both have."""
    known = dict(theirs.variables)
    both = ((name, values, known[name]) for name, values in mine.variables if name in known)
    found = ((name, tuple(value for value in values if value not in others)) for name, values, others in both)
    return tuple((name, values) for name, values in found if values)


def joint_vocabulary(old: Vocabulary, new: Vocabulary) -> Vocabulary:
    """All names of both: those of the new one first, in its order."""
    before, after = dict(old.variables), dict(new.variables)
    variables = [
        (name, (*values, *(value for value in before.get(name, ()) if value not in values)))
        for name, values in new.variables
    ]
    variables += [(name, values) for name, values in old.variables if name not in after]
    actions = (*new.actions, *(name for name in old.actions if name not in new.actions))
    return Vocabulary(tuple(variables), actions)


def joint_order(policies: Sequence[Policy], vocabulary: Vocabulary) -> list[int]:
    """The order of the larger diagram; variables that it does not test come behind their neighbours in the other."""
    numbers = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
    found: list[int] = []
    for policy in sorted(policies, key=lambda each: len(as_diagram(each).diagram.nodes), reverse=True):
        names = [policy.vocabulary.variables[variable][0] for variable in as_diagram(policy).diagram.order]
        place = 0
        for number in (numbers[name] for name in names):
            if number in found:
                place = found.index(number) + 1
            else:
                found.insert(place, number)
                place += 1
    return [*found, *(number for number in range(len(numbers)) if number not in found)]


class Placed(Struct, frozen=True):
    """A policy in the sets of both: the states of its own values, those that it decides, where it executes each action.

    `decided` and `executed` are parts of `known`.
    """

    known: Reference
    decided: Reference
    executed: tuple[Reference, ...]


@contextmanager
def placed_together(old: Policy, new: Policy, context: Context) -> Iterator[tuple[Sets, Vocabulary, Placed, Placed]]:
    """Two policies as sets of the same states, those of the names of both."""
    old, new = (replace(policy, decisions=as_diagram(policy)) for policy in (old, new))
    vocabulary = joint_vocabulary(old.vocabulary, new.vocabulary)
    with room_for(len(vocabulary.variables)):
        sets = Sets(joint_order((old, new), vocabulary), vocabulary.sizes)
        before, after = (place(policy, sets, vocabulary, context) for policy in (old, new))
        yield sets, vocabulary, before, after


def place(policy: Policy, sets: Sets, vocabulary: Vocabulary, context: Context) -> Placed:
    """The policy in `sets`, which have the numbers of a joint vocabulary; the same for all values of others."""
    decisions, mine = as_diagram(policy), policy.vocabulary
    numbers = {name: number for number, (name, _) in enumerate(vocabulary.variables)}
    levels = {variable: level for level, variable in enumerate(sets.order)}
    values = [
        [vocabulary.variables[numbers[name]][1].index(value) for value in known] for name, known in mine.variables
    ]
    at = [levels[numbers[name]] for name, _ in mine.variables]
    cube = sorted((level, tuple(sorted(each))) for level, each in zip(at, values, strict=True))
    known = sets.cube(tuple((level, each) for level, each in cube if len(each) < sets.sizes[level]))
    moved = _moved(decisions.diagram, sets, at, values, context)
    decided = sets.both(known, moved[decisions.defined])
    executed = [NOTHING] * len(vocabulary.actions)
    for name, root in zip(mine.actions, decisions.roots, strict=True):
        executed[vocabulary.actions.index(name)] = sets.both(decided, moved[root])
    return Placed(known, decided, tuple(executed))


def _moved(
    diagram: Diagram[bool], sets: Sets, levels: Sequence[int], values: Sequence[Sequence[int]], context: Context
) -> list[Reference]:
    """Every reference of a diagram as a set, whatever the order of variables and values is there."""
    found = [int(leaf) for leaf in diagram.leaves]
    for level, below in diagram.nodes:
        context.check()
        variable = diagram.order[level]
        there, children = levels[variable], [NOTHING] * sets.sizes[levels[variable]]
        for value, child in zip(values[variable], below, strict=True):
            children[value] = found[child]
        if all(sets.top(child) > there for child in children):
            found.append(sets.node(there, tuple(children)))
        else:
            chosen = NOTHING
            for value, child in enumerate(children):
                chosen = sets.choose(sets.cube(((there, (value,)),)), child, chosen)
            found.append(chosen)
    return found
