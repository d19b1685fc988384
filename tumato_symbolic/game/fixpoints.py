"""Where steps lead, and the fixpoints over them: attractors, distances, closed loops."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.game.problem import Problem
from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic import Bdd, Leading, Target, Turn, in_turns

Layers: TypeAlias = list[Bdd]
"""Disjoint sets of safe states: in layer `j` are those that reach the target in `j` steps and not earlier."""

Predecessor: TypeAlias = Callable[[Bdd, Bdd], Bdd]
"""Those states of the first set from where one step leads into the second."""

MOST_MOVES = 100
"""A relation whose sets do more different things is taken as a whole."""

MANY_COMPOSED = 200_000
"""Nodes of a set times nodes of the largest function of its bits: above, what leads into it is found in turns."""

MOST_COMPOSED = 1_000_000
"""The same where there are no turns: above, the relational product is tried instead of a composition."""


def attractor(problem: Problem, target: Bdd, predecessor: Predecessor, within: Bdd, limit: int | None) -> Layers:
    """Backward layers of `target`: `μ Z. target ∪ (within ∩ pre(Z))`, at most `limit` steps deep.

    With a policy's predecessor these are the exact ranks of its runs; with that of all allowed pairs, the distances.
    Raises `LimitReachedError` when time is up.
    """
    layers = [target]
    left = within & ~target
    while layers[-1] != problem.false and (limit is None or len(layers) <= limit):
        problem.encoding.manager.context.check()
        layer = predecessor(left, layers[-1])
        layers.append(layer)
        left = left & ~layer
    return layers


def by_any_step(problem: Problem, relation: Bdd) -> Predecessor:
    """The predecessor when any pair of a relation may be taken."""
    moves = problem.steps.moves(relation, most_moves(problem))
    if moves is None:
        return lambda states, target: states & problem.steps.predecessor(relation & states, target)
    leading = _leading(problem, moves, often=True)
    return lambda states, target: states & leading.into(target)


def _leading(problem: Problem, moves: Mapping[Assignment, Bdd], *, often: bool = False) -> Leading:
    return Leading(problem.encoding.manager, moves.items(), problem.encoding.assignment_bits, often=often)


def most_moves(problem: Problem) -> int:
    """How many different things the sets of a relation may do so that it is taken move by move.

    Those of a single group always are, however many: taking them as a whole would try each of its moves as well.
    """
    return max(MOST_MOVES, *map(len, problem.encoding.nominal_moves), 0)


def preimage(problem: Problem, relation: Bdd) -> Callable[[Bdd], Bdd]:
    """Those pairs of a relation that lead into a set of states.

    Where the pairs do few different things they are taken move by move: the predecessor under one is a cofactor.
    """
    moves = problem.steps.moves(relation, most_moves(problem), keep_sets=True)
    if moves is None:
        return lambda target: relation & problem.steps.before(target)
    return _leading(problem, moves).into


def turns_of(problem: Problem, relation: Bdd) -> Turn | None:
    """A relation that is not taken move by move, taken in turns; None where it is, or cannot be."""
    if problem.steps.moves(relation, most_moves(problem)) is not None:
        return None
    return in_turns(problem.encoding, relation)


def distances(problem: Problem, pairs: Bdd | None = None) -> tuple[Layers, ...]:
    """How far every state is from each target by some pairs; safe states by any allowed ones, where none are given."""
    step = by_any_step(problem, problem.steps.allowed if pairs is None else pairs)
    within = problem.steps.safe if pairs is None else problem.steps.valid
    return tuple(attractor(problem, target.states, step, within, problem.last_layer) for target in problem.targets)


class ClosedLoop(Struct, frozen=True, dict=True):
    """The closed loop of a policy: its nominal successor function and each state's target.

    A policy that does few different things is taken move by move: `moves` has the states by what is written there, and
    the predecessor is a union of cofactors. Otherwise `moves` is None, and `following` has the next value of every bit
    that some action writes: the predecessor is a composition. Where that would be large it is found in turns, group by
    group, or by the relational product.
    `pending` has, for every target, the states whose decision leaves it to be reached; `meaning` what its goal bits are
    in these states.
    """

    problem: Problem
    policy: Bdd
    decided: Bdd
    pending: tuple[Bdd, ...]
    meaning: tuple[Mapping[str, Bdd], ...]
    moves: Mapping[Assignment, Bdd] | None
    following: Mapping[str, Bdd]

    @cached_property
    def _acting(self) -> Leading:
        return _leading(self.problem, self.moves or {})

    @cached_property
    def _size(self) -> int:
        """Nodes of the largest function in `following`."""
        return max(map(self.problem.encoding.manager.nodes, self.following.values()), default=0)

    @cached_property
    def _turn(self) -> Turn | None:
        return in_turns(self.problem.encoding, self.policy)

    def predecessor(self, states: Bdd, target: Bdd) -> Bdd:
        """Those of some states that the policy leads into a set in one step."""
        manager = self.problem.encoding.manager
        if self.moves is not None:
            return states & self._acting.into(target)
        work = self._size * manager.nodes(target)
        if work > MANY_COMPOSED and self._turn is not None:
            return states & self._turn.into(target)
        if work > MOST_COMPOSED:
            return self.problem.steps.predecessor(self.policy & states, target)
        return states & self.decided & manager.compose(target, self.following)

    def first_steps(self, number: int, near: Bdd) -> Bdd:
        """The states whose decision has a target, by number, and leads to where it is near."""
        found = self.predecessor(self.pending[number], near)
        return self.problem.encoding.manager.compose(found, self.meaning[number])


def closed_loop(problem: Problem, policy: Bdd, most: int | None = None) -> ClosedLoop:
    """The closed loop of a policy, which is a function where it is defined; `moves` where there are at most so many.

    None stands for `most_moves`.
    """
    steps = problem.steps
    moves = steps.moves(policy, most_moves(problem) if most is None else most)
    following = problem.encoding.next_state(policy) if moves is None else {}
    pending = tuple(steps.states_of(policy & target.pending) for target in problem.targets)
    meaning = tuple(_decided_meaning(problem, policy, target) for target in problem.targets)
    return ClosedLoop(problem, policy, steps.states_of(policy), pending, meaning, moves, following)


def _decided_meaning(problem: Problem, policy: Bdd, target: Target) -> Mapping[str, Bdd]:
    """What the goal bits of a target are in the states that a policy decides."""
    bits = problem.encoding.goal_bits
    executed = frozenset() if bits is None else frozenset(bits.actions.values())
    return {
        bit: problem.steps.states_of(policy & where) if bit in executed else where
        for bit, where in target.meaning.items()
    }


def mixed(one: ClosedLoop, other: ClosedLoop, states: Bdd) -> ClosedLoop:
    """The closed loop of the policy that follows `other` in some states, else `one`; both have `moves`, or neither."""
    problem = one.problem

    def spliced(elsewhere: Bdd, there: Bdd) -> Bdd:
        return (elsewhere & ~states) | (there & states)

    moves = None
    if one.moves is not None and other.moves is not None:
        moves = {
            effect: spliced(one.moves.get(effect, problem.false), other.moves.get(effect, problem.false))
            for effect in {**one.moves, **other.moves}
        }
    following = {bit: spliced(function, other.following[bit]) for bit, function in one.following.items()}
    meaning = tuple(
        {bit: spliced(function, after[bit]) for bit, function in before.items()}
        for before, after in zip(one.meaning, other.meaning, strict=True)
    )
    return ClosedLoop(
        problem,
        spliced(one.policy, other.policy),
        spliced(one.decided, other.decided),
        tuple(map(spliced, one.pending, other.pending)),
        meaning,
        moves,
        following,
    )
