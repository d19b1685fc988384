"""Certificates of unrealizability, as data (`docs/certificate.md`): why a specification has no policy.

One failing state, or one conflict, is enough for the answer; the report of all failing states is another matter.
States, values and actions are numbers of the vocabulary; rules are named by their canonical text.
"""

from __future__ import annotations

from typing import ClassVar, Literal, TypeAlias

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagrams import Diagram, Reference
from tumato_symbolic.policy.records import Drawing, RankedGoal, Vocabulary, rooted
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Assignment, Ordering, Restoration

ActionEffect: TypeAlias = tuple[int, Assignment]
"""An action taking one of its effects."""


ViolationKind: TypeAlias = Literal[
    "precondition",
    "resource",
    "nominal-conflict",
    "reaction-rule",
    "unsafe",
    "falsified",
    "idle",
    "nominal-unsafe",
]


class Violation(Struct, frozen=True):
    """The condition of `docs/semantics.md`, section 3, that no set of a cube meets.

    `precondition`: the executed action of `actions` has a precondition that is false. `resource`, `nominal-conflict`:
    the two executed actions of `actions` exclude each other. `reaction-rule`: `rule` is false however the open actions
    are chosen. `unsafe`: the executed actions of `outcome` can happen in this order, and lead to a state that is not
    safe. `falsified`: so they can, and what they lead to falsifies a precondition of the executed action of `actions`,
    which has not taken effect; preconditions have to hold throughout. `idle`: the state is not safe, and every action
    that has effects is idle. `nominal-unsafe`: all nominal effects together lead to a state that is not safe; every
    action is settled.
    """

    kind: ViolationKind
    actions: tuple[int, ...] = ()
    rule: str | None = None
    outcome: tuple[ActionEffect, ...] = ()


class Cube(Struct, frozen=True):
    """All sets that contain `executed` and nothing of `idle`; the other actions are open."""

    executed: ActionSet
    idle: ActionSet
    violation: Violation


class NoAllowedSet(Struct, frozen=True):
    """No set is allowed in `state`: disjoint cubes cover all sets.

    Where there are too many, `cubes` is None, and *no set is allowed in this state* is left as an obligation.
    """

    kind: ClassVar = "no-allowed-set"
    state: State
    cubes: tuple[Cube, ...] | None


class NoRestoration(Struct, frozen=True):
    """From `state` safety is never surely restored: `root` leads to a set that nothing surely leaves.

    Of the set only the valid states of the level of `state` count. Whatever may be executed in one of them has an
    outcome in the set, or, under `fair`, the state after all nominal effects.
    """

    kind: ClassVar = "no-restoration"
    state: State
    diagram: Diagram[bool]
    root: Reference

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.diagram, (self.root,)

    def drawn(self, diagram: Diagram[bool], roots: tuple[Reference, ...]) -> NoRestoration:
        """See `Drawn`."""
        return NoRestoration(self.state, diagram, *roots)


class Layers(Struct, frozen=True):
    """Sets of states that hold the runs from a state that have one residual goal (named as in `RankedGoal`).

    `roots` lead to the sets: the first holds every first successor; every allowed successor of a state in one is in it,
    in an earlier one or in the next. None meets the goal. There are as many as the plan bound allows, or the successors
    of the last are in none but these. One set that no step leaves is enough, where there is one.
    """

    bodies: tuple[str, ...]
    executed: tuple[str, ...]
    roots: tuple[Reference, ...]


class NoPlan(Struct, frozen=True):
    """No run of allowed steps from `state` meets its residual goal: layers for every one that it can have."""

    kind: ClassVar = "no-plan"
    state: State
    diagram: Diagram[bool]
    goals: tuple[Layers, ...]

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`: the layers of all goals, one after the other."""
        return self.diagram, tuple(root for goal in self.goals for root in goal.roots)

    def drawn(self, diagram: Diagram[bool], roots: tuple[Reference, ...]) -> NoPlan:
        """See `Drawn`."""
        left = iter(roots)
        goals = (replace(goal, roots=tuple(next(left) for _ in goal.roots)) for goal in self.goals)
        return NoPlan(self.state, diagram, tuple(goals))


class Choice(Struct, frozen=True):
    """A state and everything that can be done in it: where each allowed set leads, and its residual goal.

    Where there are `outcomes`, they have for each option states to which, under `bounded`, its sets may lead as well.
    """

    state: State
    options: tuple[tuple[State, int], ...]
    outcomes: tuple[tuple[State, ...], ...] = ()


class Cut(Struct, frozen=True):
    """A run that misses its residual goal, which is number `goal`, as a claim about all policies.

    `path`: unless a state of the run turns off, to a state from which the goal is still near enough, the run comes to
    `end`, from where it is not. `loop`: unless a state of the run leaves these states, to where the goal is near
    enough, or hits the goal, the run stays among them for ever. `outcomes`: unless a state does what cannot lead to the
    one after it, outcomes lead along them, from the last one to that at the place `back`, for ever, and restore
    nothing; whatever the goal. `states` are numbers of choices.
    """

    kind: Literal["path", "loop", "outcomes"]
    goal: int
    states: tuple[int, ...]
    end: State | None
    back: int | None = None


class Conflict(Struct, frozen=True):
    """No policy serves the states `starts` (numbers of choices) together: every one breaks a cut.

    `distances` bound from below how many allowed steps a safe state is away from each goal; None: there is no way, or
    none that the plan bound leaves room for. Where safety may take several steps to restore and some choice is unsafe,
    they speak of all valid states. Goals with one root are one goal under several names.
    """

    kind: ClassVar = "conflict"
    starts: tuple[int, ...]
    choices: tuple[Choice, ...]
    cuts: tuple[Cut, ...]
    distances: Diagram[int | None]
    goals: tuple[RankedGoal, ...]

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`."""
        return self.distances, tuple(goal.root for goal in self.goals)

    def drawn(self, diagram: Diagram[int | None], roots: tuple[Reference, ...]) -> Conflict:
        """See `Drawn`."""
        return replace(self, distances=diagram, goals=rooted(self.goals, roots))


class Removal(Struct, frozen=True):
    """Valid states that no policy decides which decides none of those that were removed before.

    `root` leads to a number in them, and to None in others. `no-plan`: whatever is allowed in one of them leads where
    its residual goal, one of `goals`, is too far away; their roots are distances, as in `Conflict`. `no-restoration`:
    those of each level are a trap, as in `NoRestoration`.
    """

    kind: Literal["no-restoration", "no-plan"]
    diagram: Diagram[int | None]
    root: Reference
    goals: tuple[RankedGoal, ...] = ()

    @property
    def drawing(self) -> Drawing:
        """See `Drawn`: the set, then the distances of every goal."""
        return self.diagram, (self.root, *(goal.root for goal in self.goals))

    def drawn(self, diagram: Diagram[int | None], roots: tuple[Reference, ...]) -> Removal:
        """See `Drawn`."""
        return replace(self, diagram=diagram, root=roots[0], goals=rooted(self.goals, roots[1:]))


class Case(Struct, frozen=True):
    """Without `state`, what is left has no policy, as the argument with the number `part` says."""

    state: State
    part: int


class StartRemoved(Struct, frozen=True):
    """States are removed, one set after the other, and the start `state` is among them."""

    kind: ClassVar = "start"
    removals: tuple[Removal, ...]
    state: State


class Divided(Struct, frozen=True):
    """States are removed, and goals conflict in what is left: a policy leaves out one of the states of the conflict.

    There is a case for each of these that is no start.
    """

    kind: ClassVar = "conflict"
    removals: tuple[Removal, ...]
    conflict: Conflict
    cases: tuple[Case, ...]


class NoPart(Struct, frozen=True):
    """No part of the valid states that has all starts has a policy.

    The first of the arguments in `parts` is about all valid states, every other one about a case of an earlier one.
    """

    kind: ClassVar = "no-part"
    parts: tuple[StartRemoved | Divided, ...]


Reason: TypeAlias = NoAllowedSet | NoRestoration | NoPlan | Conflict | NoPart


class Unrealizability(Struct, frozen=True):
    """The certificate that a specification, known by its digest, has no policy under an effect ordering.

    `restoration` is how safety was to be restored.
    """

    vocabulary: Vocabulary
    ordering: Ordering
    digest: str
    reason: Reason
    restoration: Restoration = "one_step"
