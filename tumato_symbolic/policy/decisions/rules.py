"""A policy as a short ordered list of rules: the first that matches decides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, UserError
from tumato_symbolic.diagrams import (
    EVERYTHING,
    LEAVES,
    MOST_CUBES,
    NOTHING,
    Coverer,
    Cube,
    Sets,
    TooManyCubes,
    room_for,
)
from tumato_symbolic.limits import Context, LimitReachedError
from tumato_symbolic.policy.decisions.convert import as_diagram
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import DecisionDiagram, Vocabulary
from tumato_symbolic.policy.text import fault
from tumato_symbolic.semantics import ActionSet

_Region: TypeAlias = tuple[ActionSet, int]
"""A set of actions, and the states where it is executed."""

_Listed: TypeAlias = tuple[Cube, ActionSet]


MOST_DECISIONS = 5_000
"""Policies with more different sets of actions are not made into rules."""

MANY_DECISIONS = 500
"""With more of them, they are listed from the rarest to the most common, and no shorter order is sought."""


class Rule(Struct, frozen=True):
    """Where every variable of `condition` has one of the values given, and no earlier rule matches, do `actions`.

    Variables, values and actions come in the order of declaration. The last rule of a list has no condition.
    """

    condition: tuple[tuple[str, tuple[str, ...]], ...]
    actions: tuple[str, ...]


class RuleList(Struct, frozen=True):
    """Rules that decide like a policy, but for `left` states. `limit` is why these, or shorter lists, were left out."""

    rules: tuple[Rule, ...]
    left: int = 0
    limit: str | None = None


def minimal_rules(policy: Policy) -> tuple[Rule, ...]:
    """The rules that `find_rules` finds without a limit."""
    return find_rules(policy, Context()).rules


def find_rules(policy: Policy, context: Context) -> RuleList:
    """Few rules that decide like `policy` in every state that it decides; none where it decides no state.

    What they say of other states means nothing. The same policy gives the same rules. States are never listed: the
    work grows with the size of the policy's diagram and the number of different sets of actions. Raises `UserError`
    (TUM508) where there are too many of these, or their states have no short description. Where a limit is met, the
    list that was found by then, which may leave out states.
    """
    decisions = as_diagram(policy)
    with room_for(len(decisions.diagram.order)):
        sets = Sets(decisions.diagram.order, policy.vocabulary.sizes)
        *executed, defined = sets.take(decisions.diagram, (*decisions.roots, decisions.defined), LEAVES)
        if defined == NOTHING:
            return RuleList(())
        context.tell("looking for a short list of rules")
        best, limit = _shortest(sets, _regions(sets, executed, defined, context), defined, context)
        left = sets.count(_left(sets, best, executed, defined))
        if left and limit is None:
            raise RuntimeError("the rules do not say what the policy says")
    return RuleList(tuple(_named(policy.vocabulary, decisions, rule) for rule in best), left, limit)


def _regions(sets: Sets, executed: Sequence[int], defined: int, context: Context) -> list[_Region]:
    """Every set of actions that is decided somewhere, the rarest first."""
    regions: list[tuple[tuple[int, ...], int]] = [((), defined)]
    for action, states in enumerate(executed):
        context.check()
        parts = [
            part
            for chosen, region in regions
            for part in (((*chosen, action), sets.both(region, states)), (chosen, sets.without(region, states)))
        ]
        regions = [(chosen, region) for chosen, region in parts if region != NOTHING]
        if len(regions) > MOST_DECISIONS:
            raise _too_many(f"it takes more than {MOST_DECISIONS:,} different decisions")
    regions.sort(key=lambda each: (sets.count(each[1]), each[0]))
    return [(frozenset(chosen), region) for chosen, region in regions]


def _shortest(
    sets: Sets, regions: Sequence[_Region], defined: int, context: Context
) -> tuple[list[_Listed], str | None]:
    """The shortest list that one of the orders of decisions gives, as far as it goes; and which limit was met."""
    orders = [_by_rarity, _by_simplicity] if len(regions) <= MANY_DECISIONS else [_by_rarity]
    lists: list[list[_Listed]] = []
    limit: str | None = None
    for order in orders:
        rules: list[_Listed] = []
        try:
            for part in order(sets, regions, defined, context):
                rules += part
        except TooManyCubes:
            continue
        except LimitReachedError as reached:
            limit = str(reached)
        if limit is None or not lists:
            lists.append(rules)
        if limit is not None:
            break
    if not lists:
        raise _too_many(f"one of its decisions needs more than {MOST_CUBES:,} rules")
    return min(lists, key=lambda rules: (len(rules), _mentioned(sets, rules))), limit


def _too_many(why: str) -> UserError:
    return fault(Code.TUM508, f"the policy has no list of rules that is short enough to read: {why}")


def _by_rarity(sets: Sets, regions: Sequence[_Region], defined: int, context: Context) -> Iterator[list[_Listed]]:
    """The rarest decision first; the most common one is what remains."""
    coverer = Coverer(sets, context)
    left = defined
    for chosen, region in regions[:-1]:
        others = sets.without(left, region)
        yield [(cube, chosen) for cube in coverer.cover(region, sets.without(EVERYTHING, others))]
        left = others
    yield [((), regions[-1][0])]


def _by_simplicity(sets: Sets, regions: Sequence[_Region], defined: int, context: Context) -> Iterator[list[_Listed]]:
    """In rounds: of the decisions that remain, those that take the fewest rules now, the shortest first."""
    coverer = Coverer(sets, context)
    left = defined
    waiting = dict(enumerate(regions))
    while len(waiting) > 1:
        lengths = _lengths(sets, coverer, left, waiting)
        fewest = min(number for number, _ in lengths.values())
        for place in sorted(lengths, key=lambda place: (lengths[place], place)):
            if lengths[place][0] == fewest and len(waiting) > 1:
                chosen, region = waiting.pop(place)
                yield [(cube, chosen) for cube in coverer.cover(region, _free(sets, left, region))]
                left = sets.without(left, region)
    yield [((), chosen) for chosen, _ in waiting.values()]


def _lengths(sets: Sets, coverer: Coverer, left: int, waiting: Mapping[int, _Region]) -> dict[int, tuple[int, int]]:
    """For the decisions that take few rules now, how many rules and conditions these are."""
    found: dict[int, tuple[int, int]] = {}
    limit = MOST_CUBES
    for place, (_, region) in waiting.items():
        with suppress(TooManyCubes):
            cubes = coverer.cover(region, _free(sets, left, region), limit)
            found[place] = len(cubes), sum(map(len, cubes))
            limit = min(limit, 2 * len(cubes))
    if not found:
        raise TooManyCubes
    return found


def _free(sets: Sets, left: int, region: int) -> int:
    """Where a rule for `region` may match when only the states of `left` still matter."""
    return sets.without(EVERYTHING, sets.without(left, region))


def _mentioned(sets: Sets, rules: Sequence[_Listed]) -> int:
    """How many values the rules name, or exclude where that is shorter."""
    return sum(min(len(values), sets.sizes[level] - len(values)) for cube, _ in rules for level, values in cube)


def _left(sets: Sets, rules: Sequence[_Listed], executed: Sequence[int], defined: int) -> int:
    """The states of `defined` that no rule matches.

    Raises `RuntimeError` unless first match decides like the policy in all others.
    """
    left, found = defined, [NOTHING] * len(executed)
    for cube, chosen in rules:
        matched = sets.both(left, sets.cube(cube))
        left = sets.without(left, matched)
        for action in chosen:
            found[action] = sets.either(found[action], matched)
    reached = sets.without(defined, left)
    if any(ours != sets.both(theirs, reached) for ours, theirs in zip(found, executed, strict=True)):
        raise RuntimeError("the rules do not say what the policy says")
    return left


def _named(vocabulary: Vocabulary, decisions: DecisionDiagram, rule: _Listed) -> Rule:
    cube, chosen = rule
    conditions = sorted((decisions.diagram.order[level], values) for level, values in cube)
    return Rule(
        tuple(_values(vocabulary, variable, values) for variable, values in conditions),
        tuple(vocabulary.actions[action] for action in sorted(chosen)),
    )


def _values(vocabulary: Vocabulary, variable: int, values: tuple[int, ...]) -> tuple[str, tuple[str, ...]]:
    name, known = vocabulary.variables[variable]
    return name, tuple(known[value] for value in values)
