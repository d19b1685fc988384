"""How two policies differ: sets of states with the decision before and after. States are never listed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import UserError
from tumato_symbolic.diagrams import (
    EVERYTHING,
    NOTHING,
    Coverer,
    Cube,
    Reference,
    Sets,
    TooManyCubes,
)
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.policy import Policy, Vocabulary
from tumato_symbolic.spec import Spec
from tumato_symbolic.views.compared import states_changed, states_compared
from tumato_symbolic.views.joint import MOST_LABELS, Joint
from tumato_symbolic.views.placing import (
    NamesChanged,
    Placed,
    Values,
    names_changed,
    placed_together,
)

MOST_CHANGES = 50
"""So many different changes are described at most, those of most states."""

_MOST_CUBES = 50
"""Changes that take more cubes are not described."""

_MANY = 20
"""More different changes are told apart only by the actions that are newly executed, or no longer."""


class Decided(Struct, frozen=True):
    """What a policy says of a state: actions by name; None where it decides nothing. Not `known`: no such state.

    `whole`: these are all actions that it executes, and not only those that the other policy does not.
    """

    actions: tuple[str, ...] | None
    known: bool = True
    whole: bool = True


class Change(Struct, frozen=True):
    """So many states in which `before` became `after`.

    `cubes` hold these and no other states that one of the policies decides; None where there are too many. `example` is
    one of the states.
    """

    before: Decided
    after: Decided
    states: int
    cubes: tuple[Values, ...] | None
    example: tuple[tuple[str, str], ...]


class ByAction(Struct, frozen=True):
    """In how many states an action is executed by the new policy only, and by the old one only."""

    action: str
    started: int
    stopped: int


class Difference(Struct, frozen=True):
    """Where two policies decide otherwise, in the states of the names of both.

    `compared` counts the states that one of them decides, `changed` those with different decisions, `changes` has these
    by decisions, the most states first; `left` is how many further kinds of change there are, None where that is not
    known. `limit` is why something is missing.
    """

    variables: Values
    names: NamesChanged
    compared: int
    changed: int
    changes: tuple[Change, ...]
    by_action: tuple[ByAction, ...]
    left: int | None = 0
    limit: str | None = None

    @property
    def same(self) -> bool:
        """Whether the policies have the same names, and decide alike."""
        return not self.changed and not self.names.some


_Label: TypeAlias = tuple[Decided, Decided]


def difference(
    old: Policy, new: Policy, spec: Spec | None = None, context: Context | None = None, most: int = MOST_CHANGES
) -> Difference:
    """How two policies differ, of which at most so many kinds of change are described.

    The order of declaration does not matter, nor whether they are tables or diagrams. A policy says the same for every
    value of a variable that only the other one has; of a state with a value that it does not know, nothing. With the
    specification of the new policy, whose names it has, only valid states are compared. Raises `LimitReachedError`
    where it is not known in time in how many states they differ.
    """
    context = context or Context()
    context.tell("comparing the policies")
    with placed_together(old, new, context) as (sets, vocabulary, before, after):
        looked_at = states_compared(sets, vocabulary, spec, sets.either(before.decided, after.decided))
        changed = sets.both(looked_at, states_changed(sets, before, after))
        found = Difference(
            vocabulary.variables,
            names_changed(old.vocabulary, new.vocabulary),
            sets.count(looked_at),
            sets.count(changed),
            (),
            tuple(_by_action(sets, vocabulary, before, after, looked_at)),
        )
        if changed == NOTHING:
            return found
        return _Describing(sets, vocabulary, (before, after), looked_at, changed, context).described(found, most)


def _by_action(
    sets: Sets, vocabulary: Vocabulary, before: Placed, after: Placed, looked_at: Reference
) -> Iterator[ByAction]:
    for name, one, other in zip(vocabulary.actions, before.executed, after.executed, strict=True):
        started, stopped = (
            sets.count(sets.both(looked_at, sets.without(these, those)))
            for these, those in ((other, one), (one, other))
        )
        if started or stopped:
            yield ByAction(name, started, stopped)


class _Describing(Struct, frozen=True):
    """Says which changes there are in the states `changed`, of those that are looked at, and where."""

    _sets: Sets
    _vocabulary: Vocabulary
    _placed: tuple[Placed, Placed]
    _looked_at: Reference
    _changed: Reference
    _context: Context

    def described(self, found: Difference, most: int) -> Difference:
        """With the changes, as far as limits allow."""
        try:
            joint = self._joint(self._by_difference(), whole=False)
            if len(joint.labels(joint.root)) <= _MANY:
                joint = self._finer(joint)
        except UserError:
            reason = "there are too many different changes to describe them"
            return self._with(found, (), None, reason)
        except LimitReachedError as reached:
            return self._with(found, (), None, str(reached))
        counts = sorted(joint.counts().items(), key=lambda each: -each[1])
        regions = _Regions(joint, self._within(joint), self._vocabulary, self._context)
        changes, limit = regions.changes(counts[:most])
        return self._with(found, changes, len(counts) - len(changes), limit)

    def _finer(self, coarse: Joint[_Label]) -> Joint[_Label]:
        """By whole decisions, if these are few as well."""
        try:
            found = self._joint([placed.executed for placed in self._placed], whole=True, most=_MANY)
        except UserError:
            return coarse
        return found

    def _by_difference(self) -> list[tuple[Reference, ...]]:
        """Where both decide, and only the one, or only the other, executes each action."""
        sets, (before, after) = self._sets, self._placed
        both = sets.both(before.decided, after.decided)
        pairs = list(zip(before.executed, after.executed, strict=True))
        return [
            tuple([sets.both(both, sets.without(one, other)) for one, other in pairs]),
            tuple([sets.both(both, sets.without(other, one)) for one, other in pairs]),
        ]

    def _with(self, found: Difference, changes: Sequence[Change], left: int | None, limit: str | None) -> Difference:
        names = found.variables, found.names, found.compared, found.changed
        return Difference(*names, tuple(changes), found.by_action, left, limit)

    def _joint(self, executed: Sequence[Sequence[Reference]], *, whole: bool, most: int = MOST_LABELS) -> Joint[_Label]:
        """What is decided before and after where that differs, of which `executed` says what is to be told."""
        numbered = [
            (side, action, states)
            for side, each in enumerate(executed)
            for action, states in enumerate(each)
            if self._sets.both(states, self._changed) != NOTHING
        ]
        names = self._vocabulary.actions
        given = [states for placed in self._placed for states in (placed.known, placed.decided)]
        given += [states for _, _, states in numbered]

        def label(where: Sequence[bool]) -> _Label:
            chosen: tuple[list[str], list[str]] = [], []
            for (side, action, _), there in zip(numbered, where[4:], strict=True):
                if there:
                    chosen[side].append(names[action])
            before, after = (
                Decided(tuple(chosen[side]) if where[2 * side + 1] else None, where[2 * side], whole) for side in (0, 1)
            )
            return before, after

        return Joint(self._sets, self._changed, given, label, context=self._context, most=most)

    def _within(self, joint: Joint[_Label]) -> Reference:
        """The states that are compared, in the sets of the changes."""
        diagram, roots = self._sets.as_diagram([self._looked_at])
        (found,) = joint.sets.take(diagram, roots, {False: NOTHING, True: EVERYTHING})
        return found


class _Regions:
    """Describes sets of states by cubes, which may hold states that are not looked at."""

    def __init__(self, joint: Joint[_Label], looked_at: Reference, vocabulary: Vocabulary, context: Context) -> None:
        self._joint, self._sets, self._looked_at = joint, joint.sets, looked_at
        self._vocabulary, self._context = vocabulary, context
        self._coverer = Coverer(self._sets, context)

    def changes(self, counts: Sequence[tuple[_Label, int]]) -> tuple[list[Change], str | None]:
        """Every change with its cubes; from the one on where a limit is met, without."""
        found: list[Change] = []
        limit: str | None = None
        self._context.enter("describing the changes")
        for (before, after), states in counts:
            region = self._joint.where((before, after))
            cubes: tuple[Values, ...] | None = None
            try:
                if limit is None:
                    cubes = self._cubes(region)
            except LimitReachedError as reached:
                limit = str(reached)
            found.append(Change(before, after, states, cubes, self._example(region)))
        return found, limit

    def _cubes(self, region: Reference) -> tuple[Values, ...] | None:
        sets = self._sets
        elsewhere = sets.without(EVERYTHING, self._looked_at)
        try:
            cubes = self._coverer.cover(region, sets.either(region, elsewhere), _MOST_CUBES)
        except TooManyCubes:
            return None
        return tuple(map(self._named, cubes))

    def _named(self, cube: Cube) -> Values:
        conditions = sorted((self._sets.order[level], values) for level, values in cube)
        named = ((*self._vocabulary.variables[variable], values) for variable, values in conditions)
        return tuple((name, tuple(known[value] for value in values)) for name, known, values in named)

    def _example(self, region: Reference) -> tuple[tuple[str, str], ...]:
        """The first state of a set."""
        sets, state = self._sets, [0] * len(self._sets.order)
        here = region
        while here != EVERYTHING:
            level = sets.top(here)
            value, here = next((v, below) for v, below in enumerate(sets.below(level, here)) if below != NOTHING)
            state[sets.order[level]] = value
        variables = zip(self._vocabulary.variables, state, strict=True)
        return tuple((name, values[value]) for (name, values), value in variables)
