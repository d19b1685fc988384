"""One set of actions for every state, by the preferences of `docs/semantics.md`, section 6."""

from __future__ import annotations

from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.manager import Bdd


def preferred(encoding: Encoding, relation: Bdd) -> Bdd:
    """The functional part of a relation: for each related state the smallest set, then the one declared first.

    Two sets of one size are compared as sorted lists of declaration positions; the smaller list is the one that holds
    the first action in which they differ, so a pass over the actions decides.
    """
    manager = encoding.manager
    choice_bits = encoding.all_choice_bits
    undecided, result = relation, manager.false
    for exactly in _by_size(encoding):
        if undecided == manager.false:
            break
        smallest = undecided & exactly
        if smallest == manager.false:
            continue
        undecided = undecided & ~manager.exists(choice_bits, smallest)
        for action in range(len(encoding.spec.actions)):
            runs = encoding.executing(action)
            with_it = smallest & runs
            if with_it != manager.false:
                smallest = with_it | (smallest & ~manager.exists(choice_bits, with_it))
        result = result | smallest
    return result


def _by_size(encoding: Encoding) -> list[Bdd]:
    """The sets of 0, 1, 2, … actions."""
    sizes = [encoding.manager.true]
    for group in encoding.groups:
        idle = encoding.idle(group)
        longer = [*sizes, encoding.manager.false]
        sizes = [
            (longer[size] & idle) | ((sizes[size - 1] & ~idle) if size else encoding.manager.false)
            for size in range(len(longer))
        ]
    return sizes


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
