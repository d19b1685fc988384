"""Certificates of unrealizability: right ones, changed ones, and what is true of them by the explicit meaning."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache
from itertools import combinations
from random import Random
from typing import Literal, TypeVar

from msgspec.structs import replace

from tests.generate import ALL_PROFILES, random_spec
from tests.oracle import Together, World
from tumato_symbolic.diagrams import rebuild
from tumato_symbolic.policy import Vocabulary
from tumato_symbolic.policy.unrealizability import (
    Choice,
    Conflict,
    Cube,
    Cut,
    NoAllowedSet,
    NoPart,
    NoPlan,
    NoRestoration,
    Unrealizability,
    Violation,
)
from tumato_symbolic.semantics import State, allowed, is_valid
from tumato_symbolic.spec import Ordering, Spec
from tumato_symbolic.synthesis import Unrealizable, synthesize
from tumato_symbolic.verify import verify_unrealizable

CONFLICTS = (48, 189, 241, 316, 350)
"""Seeds of the profile `interacting` whose goals conflict."""

Entry = TypeVar("Entry")
ReasonKind = TypeVar("ReasonKind", NoAllowedSet, NoPlan, Conflict)

VIOLATIONS: tuple[Literal["precondition", "resource", "nominal-conflict", "unsafe", "idle", "nominal-unsafe"], ...] = (
    "precondition",
    "resource",
    "nominal-conflict",
    "unsafe",
    "idle",
    "nominal-unsafe",
)
"""What is tried in the place of a violation; a rule would have to be named."""


def certified(spec: Spec, ordering: Ordering) -> Unrealizability | None:
    """The certificate that there is no policy; None where there is one."""
    outcome = synthesize(spec, ordering)
    return outcome.certificate if isinstance(outcome, Unrealizable) else None


def unrealizable(spec: Spec, kind: type[ReasonKind]) -> tuple[Unrealizability, ReasonKind]:
    """The certificate of a specification that has no policy, and its reason, which is of this kind."""
    certificate = certified(spec, "any")
    assert certificate is not None
    assert isinstance(certificate.reason, kind)
    return certificate, certificate.reason


def unrealizable_specs(profile: str, seeds: range, ordering: Ordering) -> Iterator[tuple[Spec, Unrealizability]]:
    """Generated specifications without a policy, with their certificates."""
    for seed in seeds:
        spec, certificate = _generated(profile, seed, ordering)
        if certificate is not None:
            yield spec, certificate


@lru_cache(maxsize=256)
def _generated(profile: str, seed: int, ordering: Ordering) -> tuple[Spec, Unrealizability | None]:
    spec = random_spec(seed, ALL_PROFILES[profile])
    return spec, certified(spec, ordering)


def claim_is_true(world: World, certificate: Unrealizability) -> bool:
    """Whether what the certificate claims of its states is so, whatever it says to prove it."""
    match certificate.reason:
        case NoAllowedSet(state):
            return is_valid(world.spec, state) and not world.options[state]
        case NoRestoration():
            return False  # these specifications restore safety in one step
        case NoPlan(state):
            return is_valid(world.spec, state) and not any(map(world.has_plan, world.options[state]))
        case Conflict(starts, choices):
            states = [choices[start].state for start in starts]
            if not all(is_valid(world.spec, state) for state in states):
                return False
            return any(not found for found in world.options.values()) or Together(world).serve(states) is None
        case NoPart():
            raise NotImplementedError("of starts `tests.starts` has the truth")


def cubes_are_true(spec: Spec, ordering: Ordering, reason: NoAllowedSet) -> bool:
    """Whether every set is in exactly one cube and allowed nowhere: by looking at each."""
    for size in range(len(spec.actions) + 1):
        for chosen in map(frozenset, combinations(range(len(spec.actions)), size)):
            mine = [cube for cube in reason.cubes or () if cube.executed <= chosen and not cube.idle & chosen]
            if len(mine) != 1 or allowed(spec, reason.state, chosen, ordering):
                return False
    return True


def assert_never_wrong(world: World, certificate: Unrealizability) -> str:
    """What is proved is true, cube by cube; a witness is an allowed set. Returns the verdict."""
    spec, ordering = world.spec, world.ordering
    verdict = verify_unrealizable(certificate, spec, ordering=ordering)
    if verdict.verdict == "proved":
        assert claim_is_true(world, certificate)
        reason = certificate.reason
        if isinstance(reason, NoAllowedSet) and reason.cubes is not None:
            assert cubes_are_true(spec, ordering, reason)
    else:
        assert verdict.verdict == "refuted"
        assert verdict.reason
    if verdict.state is not None:
        assert verdict.chosen is not None
        assert allowed(spec, verdict.state, verdict.chosen, ordering)
    return verdict.verdict


def changed(certificate: Unrealizability, dice: Random) -> Unrealizability:
    """The certificate with one thing changed."""
    match certificate.reason:
        case NoAllowedSet() as reason:
            return replace(certificate, reason=_changed_cubes(reason, certificate.vocabulary, dice))
        case NoRestoration(state, diagram, root):
            other = dice.randrange(len(diagram.leaves) + len(diagram.nodes))
            somewhere = _any_state(certificate.vocabulary, dice)
            changed_trap = NoRestoration(
                *((somewhere, diagram, root) if dice.random() < 0.5 else (state, diagram, other))
            )
            return replace(certificate, reason=changed_trap)
        case NoPlan() as reason:
            return replace(certificate, reason=_changed_layers(reason, certificate.vocabulary, dice))
        case Conflict() as reason:
            return replace(certificate, reason=_changed_conflict(reason, certificate.vocabulary, dice))
        case NoPart():
            raise NotImplementedError("`tests.starts` changes them as JSON")


def _any_state(vocabulary: Vocabulary, dice: Random) -> State:
    return tuple(dice.randrange(size) for size in vocabulary.sizes)


def _without(entries: tuple[Entry, ...], dice: Random) -> tuple[Entry, ...]:
    place = dice.randrange(len(entries))
    return entries[:place] + entries[place + 1 :]


def _exchanged(entries: tuple[Entry, ...], dice: Random, change: Callable[[Entry], Entry]) -> tuple[Entry, ...]:
    place = dice.randrange(len(entries))
    return (*entries[:place], change(entries[place]), *entries[place + 1 :])


def _changed_cubes(reason: NoAllowedSet, vocabulary: Vocabulary, dice: Random) -> NoAllowedSet:
    actions = range(len(vocabulary.actions))
    cubes = reason.cubes or ()

    def moved(cube: Cube) -> Cube:
        action = dice.choice(actions)
        executed = cube.executed ^ {action} if dice.random() < 0.5 else cube.executed - {action}
        idle = cube.idle ^ {action} if dice.random() < 0.5 else cube.idle - {action}
        return replace(cube, executed=executed, idle=idle)

    def violated(cube: Cube) -> Cube:
        kind = dice.choice(VIOLATIONS)
        number = 1 if kind == "precondition" else 2
        named = tuple(dice.sample(actions, min(number, len(actions)))) if kind[0] in "prn" else ()
        return replace(cube, violation=Violation(kind, named, cube.violation.rule, cube.violation.outcome))

    def applied(cube: Cube) -> Cube:
        way = cube.violation.outcome
        if len(way) < 2:
            return violated(cube)
        other = dice.choice((way[:-1], way[1:], way[::-1], (*way, way[0])))
        return replace(cube, violation=replace(cube.violation, outcome=other))

    match dice.randrange(6):
        case 0:
            return replace(reason, cubes=_without(cubes, dice))
        case 1:
            return replace(reason, cubes=(*cubes, dice.choice(cubes)))
        case 2:
            return replace(reason, cubes=_exchanged(cubes, dice, moved))
        case 3:
            return replace(reason, cubes=_exchanged(cubes, dice, applied))
        case 4:
            return replace(reason, cubes=_exchanged(cubes, dice, violated))
        case _:
            return replace(reason, state=_any_state(vocabulary, dice), cubes=dice.choice((None, reason.cubes)))


def _changed_layers(reason: NoPlan, vocabulary: Vocabulary, dice: Random) -> NoPlan:
    goals, references = reason.goals, 2 + len(reason.diagram.nodes)
    match dice.randrange(6) if goals else 5:
        case 0:
            return replace(reason, goals=_without(goals, dice))
        case 1:
            return replace(
                reason, goals=_exchanged(goals, dice, lambda goal: replace(goal, roots=_without(goal.roots, dice)))
            )
        case 2:
            return replace(
                reason, goals=_exchanged(goals, dice, lambda goal: replace(goal, roots=(*goal.roots, goal.roots[-1])))
            )
        case 3:
            node = dice.randrange(len(reason.diagram.nodes)) if reason.diagram.nodes else None
            if node is None:
                flipped = replace(reason.diagram, leaves=reason.diagram.leaves[::-1])
                return replace(reason, diagram=flipped)
            level, below = reason.diagram.nodes[node]
            turned = (level, _exchanged(below, dice, lambda child: 1 - child if child < 2 else dice.randrange(2)))
            nodes = (*reason.diagram.nodes[:node], turned, *reason.diagram.nodes[node + 1 :])
            return replace(reason, diagram=replace(reason.diagram, nodes=nodes))
        case 4:
            diagram, roots = reason.drawing
            place = dice.randrange(len(roots))
            return reason.drawn(diagram, (*roots[:place], dice.randrange(references), *roots[place + 1 :]))
        case _:
            return replace(reason, state=_any_state(vocabulary, dice))


def _changed_conflict(reason: Conflict, vocabulary: Vocabulary, dice: Random) -> Conflict:
    def fewer(choice: Choice) -> Choice:
        return replace(choice, options=_without(choice.options, dice)) if choice.options else choice

    def led(choice: Choice) -> Choice:
        def other(option: tuple[State, int]) -> tuple[State, int]:
            if dice.random() < 0.5:
                return _any_state(vocabulary, dice), option[1]
            return option[0], dice.randrange(len(reason.goals))

        return replace(choice, options=_exchanged(choice.options, dice, other)) if choice.options else choice

    def cut_otherwise(cut: Cut) -> Cut:
        match dice.randrange(5):
            case 0:
                return replace(cut, goal=dice.randrange(len(reason.goals)))
            case 1 if len(cut.states) > 1:
                return replace(cut, states=_without(cut.states, dice))
            case 2:
                return replace(cut, states=_exchanged(cut.states, dice, lambda _: dice.randrange(len(reason.choices))))
            case 3:
                end = _any_state(vocabulary, dice) if cut.kind == "loop" else None
                return replace(cut, kind="path" if cut.kind == "loop" else "loop", end=end)
            case _:
                return replace(cut, end=_any_state(vocabulary, dice)) if cut.kind == "path" else replace(cut, goal=0)

    match dice.randrange(7):
        case 0:
            return replace(reason, choices=_exchanged(reason.choices, dice, fewer))
        case 1:
            return replace(reason, choices=_exchanged(reason.choices, dice, led))
        case 2:
            return replace(reason, cuts=_without(reason.cuts, dice))
        case 3:
            return replace(reason, cuts=_exchanged(reason.cuts, dice, cut_otherwise))
        case 4:
            leaves = list(reason.distances.leaves)
            first, second = dice.sample(range(len(leaves)), 2) if len(leaves) > 1 else (0, 0)
            leaves[first], leaves[second] = leaves[second], leaves[first]
            return replace(reason, distances=replace(reason.distances, leaves=tuple(leaves)))
        case 5 if reason.distances.nodes:
            node = dice.randrange(len(reason.distances.nodes))
            level, below = reason.distances.nodes[node]
            turned = (level, _exchanged(below, dice, lambda _: dice.randrange(len(reason.distances.leaves))))
            nodes = (*reason.distances.nodes[:node], turned, *reason.distances.nodes[node + 1 :])
            diagram, roots = rebuild(replace(reason.distances, nodes=nodes), [goal.root for goal in reason.goals])
            goals = tuple(replace(goal, root=root) for goal, root in zip(reason.goals, roots, strict=True))
            return replace(reason, distances=diagram, goals=goals)
        case _:
            choice = Choice(_any_state(vocabulary, dice), reason.choices[0].options)
            return replace(reason, choices=(choice, *reason.choices[1:]))
