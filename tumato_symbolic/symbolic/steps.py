"""The safe controllable predecessor: allowed steps and where they lead, for all states and sets of actions at once.

Effects are constant assignments, so the predecessor under an effect is a cofactor; there are no primed bits. Everything
is composed group by group (`docs/semantics.md`, section 3).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate, pairwise
from operator import and_

from msgspec import Struct

from tumato_symbolic.semantics import contested_resources, contested_values
from tumato_symbolic.spec import Assignment, Ordering, Spec
from tumato_symbolic.symbolic.encoding import Encoding
from tumato_symbolic.symbolic.layout import Group, Layout
from tumato_symbolic.symbolic.manager import Bdd

LARGE = 20_000
"""Nodes of a relation that is not multiplied by many more at once."""


class Steps(Struct, frozen=True):
    """The step relation of a specification.

    `valid` and `safe` are sets of states; `candidates` relates valid states to sets of actions that satisfy conditions
    1 to 3 of section 3, and `allowed` is `Ok(s, A)`, or `Keep(s, A)` where safety may take several steps to restore.
    `tiers` has `S_0` to `S_m`, from the valid states to the safe ones (section 10). With `one_at_a_time`, the only
    sets in safe states are some of `few_sets`; `candidates` are then no more than `allowed`.
    """

    encoding: Encoding
    ordering: Ordering
    valid: Bdd
    safe: Bdd
    candidates: Bdd
    allowed: Bdd
    tiers: tuple[Bdd, ...]
    one_at_a_time: bool = False

    @property
    def unsafe(self) -> Bdd:
        """`V \\ S`."""
        return self.valid & ~self.safe

    @property
    def levels(self) -> tuple[tuple[Bdd, Bdd], ...]:
        """The unsafe states of each level, from 0 on, with the states that satisfy a tier more."""
        return tuple((lower & ~upper, upper) for lower, upper in pairwise(self.tiers))

    def before(self, target: Bdd) -> Bdd:
        """`{(s, A) : δ(s, A) ∈ target}` for sets whose nominal effects agree; `target` is a set of states."""
        return self.encoding.before(target)

    def states_of(self, relation: Bdd) -> Bdd:
        """`{s : ∃ A. (s, A) ∈ relation}`."""
        return self.encoding.manager.exists(self.encoding.all_choice_bits, relation)

    def predecessor(self, relation: Bdd, target: Bdd) -> Bdd:
        """`{s : ∃ A. (s, A) ∈ relation ∧ δ(s, A) ∈ target}`."""
        return self.encoding.manager.and_exists(self.encoding.all_choice_bits, relation, self.before(target))

    def successors(self, relation: Bdd) -> Bdd:
        """`{δ(s, A) : (s, A) ∈ relation}` for sets whose nominal effects agree."""
        encoding, manager = self.encoding, self.encoding.manager
        for number, moves in enumerate(encoding.nominal_writes):
            nothing = next(choices for written, choices in moves if not written)
            if relation & ~nothing != manager.false:
                parts = encoding.parts_by_writes(number, relation)
                relation = manager.union(
                    manager.exists(written, part) & manager.cube(written) for written, part in parts
                )
        return self.states_of(relation)

    def moves(self, relation: Bdd, most: int, *, keep_sets: bool = False) -> dict[Assignment, Bdd] | None:
        """The states of a relation by what its sets nominally write, all effects together; None if that is too much.

        With `keep_sets` its pairs, instead of their states alone. `most` is the largest number of moves that is not too
        much.
        """
        manager = self.encoding.manager
        found: dict[Assignment, Bdd] = {(): relation}
        for group, options in zip(self.encoding.groups, self.encoding.nominal_moves, strict=True):
            split: dict[Assignment, Bdd] = {}
            for written, pairs in found.items():
                acting = (pairs & ~options[0][1]) != manager.false
                for effect, choices in options if acting else options[:1]:
                    part = pairs & choices if keep_sets else manager.and_exists(group.bits, pairs, choices)
                    if part != manager.false:
                        both = tuple(sorted({*written, *effect}))
                        split[both] = split.get(both, manager.false) | part
                        if len(split) > most:
                            return None
            found = split
        return found


def build_steps(layout: Layout, spec: Spec, ordering: Ordering, within: Bdd | None = None) -> Steps:
    """The step relation of a specification in a layout, under an effect ordering.

    `within` is one more assumption, as a set of states.
    """
    encoding = Encoding.of(layout, spec)
    valid = encoding.states_where(rule.formula for rule in spec.assumptions)
    valid = valid if within is None else valid & within
    tiers = tiers_within(encoding, valid)
    safe = tiers[-1]
    compatible, applicable = compatible_sets(encoding), applicable_sets(encoding)
    bounded = encoding.manager.bounded
    candidates = bounded(bounded(valid & compatible & applicable) & meant_sets(encoding))
    allowed = candidates & encoding.all_of(rule.formula for rule in spec.reaction_rules)
    pending = compatible & applicable if spec.preconditions == "throughout" else compatible
    if spec.restores_stepwise:
        allowed = _keeping(encoding, ordering, tiers, pending, allowed)
    else:
        allowed = allowed & staying_in(encoding, ordering, safe, pending, allowed)
    return Steps(encoding, ordering, valid, safe, candidates, allowed, tiers)


def tiers_within(encoding: Encoding, valid: Bdd) -> tuple[Bdd, ...]:
    """`S_0` to `S_m`: the valid states that satisfy more and more tiers of state rules, severe ones first."""
    each = (encoding.states_where(rule.formula for rule in tier) for tier in encoding.spec.tiers)
    return tuple(accumulate(each, and_, initial=valid))


def _keeping(encoding: Encoding, ordering: Ordering, tiers: tuple[Bdd, ...], pending: Bdd, asked: Bdd) -> Bdd:
    """Those of the pairs asked about after which all rules hold that have to (sections 9 and 10)."""
    spec, false = encoding.spec, encoding.manager.false

    def into(target: Bdd, pairs: Bdd) -> Bdd:
        return pairs & staying_in(encoding, ordering, target, pending, pairs)

    kept = into(tiers[-1], asked & tiers[-1])
    for tier, (lower, upper) in zip(spec.tiers, pairwise(tiers), strict=True):
        here = asked & lower & ~upper
        if here == false:
            continue
        here = into(upper if spec.restoration == "one_step" else lower, here)
        for rule in tier if spec.restoration != "one_step" else ():
            holds = encoding.states_where([rule.formula])
            here = (here & ~holds) | into(holds, here & holds)
        kept = kept | here
    return kept


def staying_in(encoding: Encoding, ordering: Ordering, safe: Bdd, pending: Bdd, asked: Bdd | None = None) -> Bdd:
    """The sets whose outcomes are all in `safe`: conditions 5 and 6.

    Right for compatible sets only, and for the pairs that are `asked` about (None: all). `pending` is what has to hold
    of a state on the way and of the actions that have not taken effect there: preconditions, where they have to hold
    throughout. It also tells which sets are compatible, but may hold others, if that is smaller.
    """
    acting = ~without_effect(encoding)
    asked = acting if asked is None else asked & acting
    if ordering == "first":
        found = _after_any_first_effect(encoding, safe & pending, asked) & encoding.before(safe)
        return found | (safe & ~acting)
    stays_safe = _always_safe(encoding, safe & pending)
    return stays_safe | _after_any_first_effect(encoding, stays_safe, asked & ~safe)


def applicable_sets(encoding: Encoding) -> Bdd:
    """The pairs in which every precondition of the chosen actions holds (condition 1).

    One group after the other, the lowest first, and action by action once that is large: so what is found grows by
    degrees, and is seen to be too large before it is far too large.
    """
    manager, found = encoding.manager, encoding.manager.true
    of_group: dict[int, list[Bdd]] = {}
    for cases, part in zip(encoding.spec.cases, applicable_parts(encoding), strict=True):
        of_group.setdefault(encoding.choice_of[cases[0]][0], []).append(part)
    for group in encoding.lowest_first:
        parts = of_group.get(group, [])
        for part in parts if manager.nodes(found) > LARGE else [manager.intersection(parts)]:
            found = manager.bounded(found & part)
    return found


def applicable_parts(encoding: Encoding) -> Iterator[Bdd]:
    """For every action, the pairs without it or in which its preconditions hold."""
    spec = encoding.spec
    for cases in spec.cases:
        holds = encoding.all_of(rule.formula for rule in spec.actions[cases[0]].preconditions)
        yield ~encoding.executing_any(cases) | holds


def meant_sets(encoding: Encoding) -> Bdd:
    """The pairs in which every chosen case is that of the state."""
    manager, parts = encoding.manager, []
    for group in encoding.groups:
        actions = [(action, encoding.spec.actions[action].guard) for action in group.actions]
        if any(guard is not None for _, guard in actions):
            met = [manager.true if guard is None else encoding.formula(guard.formula) for _, guard in actions]
            chosen = [encoding.executing(action) & here for (action, _), here in zip(actions, met, strict=True)]
            parts.append(manager.union([encoding.idle(group), *chosen]))
    return manager.intersection(parts)


def compatible_sets(encoding: Encoding) -> Bdd:
    """Choices without two actions that share a resource or disagree nominally (conditions 2 and 3)."""
    manager, result = encoding.manager, encoding.choice_domain()
    for contest in (*contested_resources(encoding.spec), *contested_values(encoding.spec)):
        taken = manager.false
        for side in contest:
            chosen = encoding.executing_any(side)
            both = taken & chosen
            result = result if both == manager.false else result & ~both
            taken = taken | chosen
    return result


def _always_safe(encoding: Encoding, safe: Bdd) -> Bdd:
    r"""`{(s, R) : s and all that any further effects of the actions R, each at most once, can lead to are safe}`.

    The greatest fixpoint `W(s, R) = safe(s) ∧ ∀ a ∈ R, e ∈ effects(a): W(e(s), R \ {a})`: an action that took effect
    is idle afterwards. Groups are taken in turn until none changes anything; the lowest in the order first, which keeps
    what is found small for longest. A group that has been taken is not taken again because of one that writes nothing
    of what it writes: their effects commute.
    """
    written = [_written_by(encoding, group) for group in encoding.groups]
    result, waiting = safe, dict.fromkeys(encoding.lowest_first)
    while waiting:
        taken = next(iter(waiting))
        del waiting[taken]
        stronger = encoding.manager.bounded(result & _after_effect_of(encoding, encoding.groups[taken], result))
        if stronger != result:
            others = (other for other in range(len(written)) if other != taken)
            waiting |= dict.fromkeys(other for other in others if written[other] & written[taken])
        result = stronger
    return result


def _written_by(encoding: Encoding, group: Group) -> frozenset[int]:
    """The variables that some effect of a group's actions writes."""
    actions = (encoding.spec.actions[action] for action in group.actions)
    return frozenset(variable for action in actions for effect in action.effects for variable, _ in effect)


def _after_any_first_effect(encoding: Encoding, stays_safe: Bdd, asked: Bdd) -> Bdd:
    r"""`{(s, A) ∈ asked : (e(s), A \ {a}) ∈ stays_safe for every a ∈ A and every effect e of a}`."""
    for group in encoding.groups:
        if asked == encoding.manager.false:
            break
        asked = encoding.manager.bounded(asked & _after_effect_of(encoding, group, stays_safe))
    return asked


def without_effect(encoding: Encoding) -> Bdd:
    """The sets that add no outcome: every group is idle, or its action has no effects."""
    parts = []
    for group in encoding.groups:
        actions = (action for action in group.actions if not encoding.spec.actions[action].effects)
        parts.append(encoding.manager.union([encoding.idle(group), *map(encoding.executing, actions)]))
    return encoding.manager.intersection(parts)


def _after_effect_of(encoding: Encoding, group: Group, following: Bdd) -> Bdd:
    """`{(s, A) : the group is idle, or every effect of its action leads into following, where the group is idle}`."""
    manager = encoding.manager
    rest = manager.cofactor(following, encoding.idle_bits(group))
    parts = [encoding.executing(action) & encoding.after_every_effect(action, rest) for action in group.actions]
    return manager.union([encoding.idle(group), *parts])
