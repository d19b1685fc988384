"""The step relation of one action at a time, for where the sets of several actions make too large a diagram.

In a safe state a set has at most one action that no reaction rule may force. Fewer sets are allowed than there are, so
a policy of these is as sound as any; only what it prefers, and *no*, would need the others. In an unsafe state all
allowed sets are there: the cheapest restoring set is the cheapest of all.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeAlias

from tumato_symbolic.spec import Connectives, Executing, Is, Ordering, Spec, fold
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.layout import Layout
from tumato_symbolic.symbolic.manager import Bdd
from tumato_symbolic.symbolic.steps import (
    Steps,
    applicable_parts,
    compatible_sets,
    meant_sets,
    staying_in,
    tiers_within,
)


def few_steps(layout: Layout, spec: Spec, ordering: Ordering) -> Steps:
    """The step relation with one action at a time in safe states, where safety is restored in one step."""
    encoding = Encoding.of(layout, spec)
    valid = encoding.states_where(rule.formula for rule in spec.assumptions)
    tiers = tiers_within(encoding, valid)
    safe, unsafe = tiers[-1], valid & ~tiers[-1]
    applicable, compatible = list(applicable_parts(encoding)), compatible_sets(encoding)
    meant = [meant_sets(encoding), *(encoding.formula(rule.formula) for rule in spec.reaction_rules)]

    def staying(compatible: Bdd, asked: Bdd) -> Bdd:
        pending = _all_of(encoding, compatible, applicable) if spec.preconditions == "throughout" else compatible
        return asked & staying_in(encoding, ordering, safe, pending, asked)

    few = encoding.manager.bounded(compatible & few_sets(encoding))
    allowed = staying(few, _all_of(encoding, safe & few, [*applicable, *meant]))
    if unsafe != encoding.manager.false:
        allowed = allowed | _all_of(encoding, staying(compatible, unsafe & compatible), [*applicable, *meant])
    return Steps(encoding, ordering, valid, safe, allowed, allowed, tiers, one_at_a_time=True)


def few_sets(encoding: Encoding) -> Bdd:
    """The sets with at most one action that reaction rules never ask for."""
    manager, forced = encoding.manager, forced_actions(encoding.spec)
    none, one = manager.true, manager.false
    for group in (encoding.groups[number] for number in encoding.lowest_first):
        asked_for = encoding.executing_any(action for action in group.actions if action in forced)
        without = encoding.idle(group) | asked_for
        none, one = none & without, (one & without) | (none & ~without)
    return none | one


_Signed: TypeAlias = tuple[frozenset[int], frozenset[int]]
"""The actions that a formula wants executed, and those that it wants not to be; an action may be among both."""


def forced_actions(spec: Spec) -> frozenset[int]:
    """The actions whose execution can make a reaction rule true."""
    wanted = (fold(rule.formula, _atom, _SIGNED)[0] for rule in spec.reaction_rules)
    return frozenset[int]().union(*wanted)


def _atom(atom: Is | Executing) -> _Signed:
    return (frozenset((atom.action,)) if isinstance(atom, Executing) else frozenset(), frozenset())


def _together(parts: Iterable[_Signed]) -> _Signed:
    found = tuple(parts)
    return frozenset[int]().union(*(one for one, _ in found)), frozenset[int]().union(*(other for _, other in found))


_SIGNED: Connectives[_Signed] = Connectives(
    constant=lambda _: (frozenset(), frozenset()),
    negation=lambda signed: signed[::-1],
    conjunction=_together,
    disjunction=_together,
    equivalence=lambda one, other: _together((one, one[::-1], other, other[::-1])),
)


def _all_of(encoding: Encoding, start: Bdd, parts: Iterable[Bdd]) -> Bdd:
    """What is left of a set that is small already, one part after the other."""
    for part in parts:
        start = encoding.manager.bounded(start & part)
    return start
