"""The truth about starts: every closed set of states, every policy for it (`docs/semantics.md`, section 12)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from copy import copy
from itertools import combinations
from math import prod

from tests.restoration.truth import World
from tumato_symbolic.semantics import State, is_start

Part = frozenset[State]

MOST_OTHERS = 9
"""With more valid states that are no starts, not every set of states is tried."""


def starts(world: World) -> Part:
    """All starts."""
    return frozenset(state for state in world.valid if is_start(world.spec, state))


def within(world: World, part: Part) -> World:
    """The world in which policies decide just these states, and no step leaves them."""
    found = copy(world)
    for name in ("restorable",):
        found.__dict__.pop(name, None)
    found.valid = [state for state in world.valid if state in part]
    found.safe = world.safe & part
    found.options = {s: [o for o in world.options[s] if o.following <= part] for s in found.valid}
    return found


def parts(world: World, most_policies: int) -> Iterator[tuple[Part, bool]] | None:
    """Every set that has all starts, with whether it has a policy, by trying all; None where they are too many."""
    first, others = starts(world), [state for state in world.valid if state not in starts(world)]
    if len(others) > MOST_OTHERS:
        return None
    closed = [first | set(more) for size in range(len(others) + 1) for more in combinations(others, size)]
    worlds = [(part, within(world, part)) for part in map(frozenset, closed)]
    if sum(_different(each) for _, each in worlds) > most_policies:
        return None
    return ((part, each.has_policy()) for part, each in worlds)


def _different(world: World) -> int:
    """How many policies `has_policy` tries."""
    return prod(len({(o.after, o.goal, o.following) for o in options}) for options in world.options.values())


def greatest(world: World) -> tuple[Part, Counter[str], dict[State, str]]:
    """The greatest part in which no state fails; how many fail and why, stage by stage; and the starts among them."""
    part, counts, failing = frozenset(world.valid), Counter[str](), dict[State, str]()
    while True:
        here = within(world, part)
        kinds = {state: kind for state in here.valid if (kind := here.kind(state)) is not None}
        if not kinds:
            return part, counts, failing
        counts.update(kinds.values())
        failing.update((state, kind) for state, kind in kinds.items() if is_start(world.spec, state))
        part -= kinds.keys()
