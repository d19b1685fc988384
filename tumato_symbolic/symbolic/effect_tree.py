"""All effects of an action at once: effects that begin alike are looked at together.

An action whose alternatives are all values of four variables has ten thousand effects, which differ in one variable at
a time. What holds after each of them takes a step for each variable and value, where the set in question does not tell
the values apart.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.spec import Assignment
from tumato_symbolic.symbolic.manager import Bdd, Manager


class EffectTree(Struct, frozen=True, eq=False):
    """Effects by what they write first. `ends`: writing nothing (more) is one of them. Equal trees are one object."""

    ends: bool
    branches: tuple[tuple[Assignment, EffectTree], ...]


_DONE = EffectTree(True, ())


_Known: TypeAlias = dict[tuple[bool, tuple[tuple[Assignment, int], ...]], EffectTree]


@lru_cache(maxsize=1024)
def effect_tree(effects: tuple[Assignment, ...]) -> EffectTree:
    """The tree of some effects."""
    return _build(effects, {})


def _build(rests: Sequence[Assignment], known: _Known) -> EffectTree:
    """The tree of what is left of some effects; `known` has the trees that were built."""
    by_first: dict[tuple[int, int], list[Assignment]] = {}
    for rest in rests:
        if rest:
            by_first.setdefault(rest[0], []).append(rest[1:])
    branches = tuple(
        ((first, *rests[0]), _DONE) if len(rests) == 1 else ((first,), _build(rests, known))
        for first, rests in by_first.items()
    )
    ends = any(not rest for rest in rests)
    key = (ends, tuple((written, id(tree)) for written, tree in branches))
    return known.setdefault(key, EffectTree(ends, branches))


def after_every(
    manager: Manager, tree: EffectTree, target: Bdd, bits: Callable[[Assignment], Mapping[str, bool]]
) -> Bdd:
    """What leads into `target` by every effect of a tree; `bits` turns what is written into constants for bits."""
    return _after_every(manager, tree, target, bits, {})


def _after_every(
    manager: Manager,
    tree: EffectTree,
    target: Bdd,
    bits: Callable[[Assignment], Mapping[str, bool]],
    known: dict[tuple[EffectTree, Bdd], Bdd],
) -> Bdd:
    key = (tree, target)
    if key not in known:
        parts = [target] if tree.ends else []
        for written, below in tree.branches:
            parts.append(_after_every(manager, below, manager.cofactor(target, bits(written)), bits, known))
        known[key] = manager.intersection(parts)
    return known[key]
