"""One set of actions for every state, by the preferences of `docs/semantics.md`, section 6."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd

MANY_ACTIONS = 256
"""Up to so many actions, looking at each by itself takes less than a pass over the bits of the groups."""


def preferred(encoding: Encoding, relation: Bdd) -> Bdd:
    """The functional part of a relation: for each related state the smallest set, then the one declared first."""
    manager = encoding.manager
    nothing = manager.cube(_all_idle(encoding))
    result = relation & nothing
    undecided = relation & ~manager.cofactor(relation, _all_idle(encoding))
    for size, exactly in enumerate(encoding.sets_by_size[1:], start=1):
        if undecided == manager.false:
            break
        first = _first_alone if size == 1 and len(encoding.spec.cases) <= MANY_ACTIONS else _first_declared
        smallest = first(encoding, undecided & exactly)
        undecided = undecided & ~manager.exists(encoding.all_choice_bits, smallest)
        result = result | smallest
    return result


def _all_idle(encoding: Encoding) -> dict[str, bool]:
    """The empty set, as constants for the choice bits."""
    return dict.fromkeys(encoding.all_choice_bits, False)


def _first_alone(encoding: Encoding, relation: Bdd) -> Bdd:
    """`_first_declared` for sets of one action: each is looked at by itself."""
    manager = encoding.manager
    result = decided = manager.false
    for alone in encoding.alone:
        chosen = relation & alone & ~decided
        if chosen != manager.false:
            result = result | chosen
            decided = decided | manager.exists(encoding.all_choice_bits, chosen)
    return result


def _first_declared(encoding: Encoding, relation: Bdd) -> Bdd:
    """For each state the first of its sets, which are all of one size.

    Sets of one size are compared as sorted lists of declaration positions; the smaller list is the one that holds the
    first action in which they differ, so a pass over the actions decides. Of actions of one group that follow each
    other at most one is in a set, and the first has the smallest number: a pass over the bits decides.
    """
    manager, choice_bits = encoding.manager, encoding.all_choice_bits
    for choices, bits in encoding.declared:
        with_it = relation & choices
        if with_it != manager.false:
            there = manager.exists([bit for bit in choice_bits if bit not in bits], with_it)
            others = relation & ~manager.exists(bits, there)
            relation = (with_it & _smallest(encoding, there, bits) if bits else with_it) | others
    return relation


def _smallest(encoding: Encoding, relation: Bdd, bits: Sequence[str]) -> Bdd:
    """For each state the smallest of the numbers that these bits have in a relation between states and them."""
    manager = encoding.manager
    for bit in bits:
        without = relation & manager.cube({bit: False})
        relation = without | (relation & ~manager.exists(bits, without))
    return relation


def by_duration(encoding: Encoding, choices: Bdd) -> dict[int, Bdd]:
    """Sets of actions by the sum of their durations, the smallest first."""
    manager, spec = encoding.manager, encoding.spec
    sums = {0: choices}
    for group in encoding.groups:
        following: dict[int, Bdd] = {}
        for so_far, some in sums.items():
            parts = [(so_far, encoding.idle(group))]
            parts += [(so_far + spec.actions[action].duration, encoding.executing(action)) for action in group.actions]
            for longer, part in parts:
                if (lasting_so := some & part) != manager.false:
                    following[longer] = following.get(longer, manager.false) | lasting_so
        sums = following
    return dict(sorted(sums.items()))


def least_duration(encoding: Encoding, choices: Bdd) -> int | None:
    """The smallest sum of durations of some sets of actions; None where there are none."""
    manager, spec = encoding.manager, encoding.spec
    left = {} if choices == manager.false else {choices: 0}
    for group in encoding.groups:
        parts: list[tuple[int, Mapping[str, bool]]] = [(0, encoding.idle_bits(group))]
        parts += [(spec.actions[action].duration, encoding.action_bits(action)) for action in group.actions]
        following: dict[Bdd, int] = {}
        for some, so_far in left.items():
            for duration, bits in parts:
                rest = manager.cofactor(some, bits)
                if rest != manager.false:
                    following[rest] = min(so_far + duration, following.get(rest, so_far + duration))
        left = following
    return min(left.values(), default=None)


def lasting(encoding: Encoding, total: int) -> Bdd:
    """The sets of actions whose durations sum up to `total`."""
    manager, spec = encoding.manager, encoding.spec
    sums = {0: manager.true}
    for group in encoding.groups:
        following: dict[int, Bdd] = {}
        for so_far, choices in sums.items():
            parts = [(so_far, encoding.idle(group))]
            parts += [(so_far + spec.actions[action].duration, encoding.executing(action)) for action in group.actions]
            for longer, part in parts:
                if longer <= total:
                    following[longer] = following.get(longer, manager.false) | (choices & part)
        sums = following
    return sums.get(total, manager.false)
