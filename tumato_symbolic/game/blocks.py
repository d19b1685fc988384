"""Relations between states and single actions, by blocks of actions of which a state has one at most.

What is done in the states of a block is told by the state: a fixpoint looks at states alone, at all actions of a block
together, and the actions come back in the end. Where actions are many, and most exclude each other by their
preconditions, that is much less than a look at each in every round.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from msgspec import Struct

from tumato_symbolic.game.problem import Problem
from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic import Bdd, Leading

LEAST_ACTIONS = 64
"""With fewer actions each is looked at by itself."""

LEAST_TOGETHER = 8
"""So many actions a block has to have on average."""


class Block(Struct, frozen=True):
    """Actions next to each other in the order of declaration, or none of them, with their pairs in a relation.

    No state has two of these pairs. `leading` tells which states have one that leads into a set.
    """

    pairs: Bdd
    leading: Leading


def blocks_of(problem: Problem, relation: Bdd) -> list[Block] | None:
    """A relation by blocks in the order of preference: doing nothing, then what is declared first.

    None where sets may have several actions, where there are few actions, and where few are in a block.
    """
    encoding, manager = problem.encoding, problem.encoding.manager
    number_of_actions = len(problem.spec.actions)
    if len(encoding.groups) != 1 or number_of_actions < LEAST_ACTIONS:
        return None
    blocks: list[tuple[list[Bdd], dict[Assignment, Bdd]]] = []
    taken = manager.true
    for written, choice, states in _choices(problem, relation):
        if (taken & states) != problem.false:
            blocks.append(([], {}))
            taken = problem.false
            if len(blocks) * LEAST_TOGETHER > number_of_actions:
                return None
        taken = taken | states
        pairs, moves = blocks[-1]
        pairs.append(choice & states)
        moves[written] = moves.get(written, problem.false) | states
    return [_block(problem, pairs, moves) for pairs, moves in blocks]


def _choices(problem: Problem, relation: Bdd) -> Iterator[tuple[Assignment, Bdd, Bdd]]:
    """What is written, how it is chosen, and where: for no action, and for each that a state has."""
    encoding, (group,) = problem.encoding, problem.encoding.groups
    every: list[tuple[Assignment, Mapping[str, bool]]] = [((), encoding.idle_bits(group))]
    every += [(problem.spec.actions[action].nominal, encoding.action_bits(action)) for action in sorted(group.actions)]
    for written, bits in every:
        states = encoding.manager.cofactor(relation, bits)
        if states != problem.false:
            yield written, encoding.manager.cube(bits), states


def _block(problem: Problem, pairs: list[Bdd], moves: Mapping[Assignment, Bdd]) -> Block:
    encoding = problem.encoding
    leading = Leading(encoding.manager, moves.items(), encoding.assignment_bits, often=True)
    return Block(encoding.manager.union(pairs), leading)
