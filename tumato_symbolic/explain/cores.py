"""Why states fail: minimal sets of elements that suffice for it, and all states that fail for the same ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Literal, TypeAlias

from msgspec import Struct, field
from msgspec.structs import replace

from tumato_symbolic.explain.cubes import disjoint_cubes, set_of
from tumato_symbolic.explain.elements import Element, Elements
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.semantics import State
from tumato_symbolic.symbolic import Bdd

FailingKind: TypeAlias = Literal["no-allowed-set", "no-restoration", "no-plan"]

Asked: TypeAlias = FailingKind | Literal["left-out"]
"""What cores are asked about; `left-out`: whatever a policy decides, it leaves the state out."""


class Cause(Struct, frozen=True):
    """States that fail in one way and have one core in common. `example` is one of them.

    `later`: they are starts, and fail only because of what follows them.
    """

    kind: FailingKind
    states: Bdd
    core: Elements
    example: State
    later: bool = False

    @property
    def asked(self) -> Asked:
        """What the core is about."""
        return "left-out" if self.later else self.kind


class Failing(Struct, frozen=True):
    """The valid states that fail, by kind; `later` are starts that fail only because of what follows them."""

    no_allowed_set: Bdd
    no_restoration: Bdd
    no_plan: Bdd
    later: Mapping[FailingKind, Bdd] = field(default_factory=dict)

    def among(self, states: Bdd) -> Failing:
        """Those of some states."""
        later = {kind: found & states for kind, found in self.later.items()}
        return Failing(self.no_allowed_set & states, self.no_restoration & states, self.no_plan & states, later)

    @property
    def at_once(self) -> Bdd:
        """The states that fail whatever follows."""
        return self.no_allowed_set | self.no_restoration | self.no_plan


def failing_states(oracle: FailingStates) -> Failing:
    """All states that fail (`docs/semantics.md`, section 7)."""
    requirements = oracle.requirements
    stuck, lost = requirements.stuck(requirements.everything), oracle.lost(requirements.everything)
    no_plan = oracle.failing(requirements.everything, requirements.valid & ~stuck & ~lost)
    return Failing(stuck & ~lost, lost, no_plan)


def causes(oracle: FailingStates, states: Failing) -> Iterator[Cause]:
    """The failing states by kind and core, in no order.

    A typical state gives a core, and the core gives all states that have it: as many rounds as there are cores.
    """
    yield from _by_core(oracle, "no-allowed-set", states.no_allowed_set)
    yield from _by_core(oracle, "no-restoration", states.no_restoration)
    yield from _no_plan(oracle, states.no_plan)
    for kind, starts in states.later.items():
        for cause in _by_core(oracle, "left-out", starts):
            yield replace(cause, kind=kind, later=True)


class Question(Struct, frozen=True):
    """Whether one state fails in one way when only some elements are kept, and which of some states do."""

    fails: Callable[[State, Elements], bool]
    failing: Callable[[Elements, Bdd], Bdd]

    @classmethod
    def of(cls, oracle: FailingStates, kind: Asked) -> Question:
        """The question about one way to fail."""
        requirements = oracle.requirements
        match kind:
            case "no-allowed-set":
                return cls(requirements.is_stuck, lambda kept, states: states & requirements.stuck(kept))
            case "no-restoration":
                contains = requirements.encoding.contains
                return cls(
                    lambda state, kept: contains(oracle.lost(kept), state),
                    lambda kept, states: states & oracle.lost(kept),
                )
            case "no-plan":
                return cls(oracle.fails, oracle.failing)
            case "left-out":
                cube, false = requirements.encoding.state_cube, requirements.false
                return cls(lambda state, kept: oracle.left_out(kept, cube(state)) != false, oracle.left_out)


def _by_core(oracle: FailingStates, kind: Asked, left: Bdd) -> Iterator[Cause]:
    requirements, question = oracle.requirements, Question.of(oracle, kind)
    while left != requirements.false:
        example = typical_state(requirements, left)
        core = core_of(oracle, kind, example, requirements.everything)
        alike = _having(core, left, question.failing)
        yield Cause("no-plan" if kind == "left-out" else kind, alike, core, example)
        left = left & ~alike


def _no_plan(oracle: FailingStates, left: Bdd) -> Iterator[Cause]:
    """What fails even with nothing kept, then what does with the assumptions alone, which no repair drops."""
    requirements = oracle.requirements
    unavoidable = oracle.failing(frozenset(), left)
    for region in requirements.regions.values():
        here = region & unavoidable
        if here != requirements.false:
            yield Cause("no-plan", here, frozenset(), typical_state(requirements, here))
    left = left & ~unavoidable
    assumptions = frozenset(each for each in requirements.elements if each.kind == "assumption")
    for blamed in (assumptions, requirements.everything):
        while (these := oracle.failing(blamed, left)) != requirements.false:
            example = typical_state(requirements, these)
            core = core_of(oracle, "no-plan", example, blamed)
            alike = _having(core, left, oracle.failing)
            yield Cause("no-plan", alike, core, example)
            left = left & ~alike


def _having(core: Elements, left: Bdd, fail: Callable[[Elements, Bdd], Bdd]) -> Bdd:
    """Those of some states for which `core` is sufficient and minimal."""
    states = fail(core, left)
    for element in core:
        states = states & ~fail(core - {element}, states)
    return states


def core_of(oracle: FailingStates, kind: Asked, state: State, among: Elements) -> Elements:
    """A minimal set of elements, out of some that suffice, because of which a state fails in one way."""
    question = Question.of(oracle, kind)
    items = [each for each in oracle.requirements.elements if each in among]
    return minimal(items, lambda kept: question.fails(state, kept))


def more_cores(
    requirements: Requirements, first: Elements, wanted: int, find: Callable[[Elements], Elements | None]
) -> tuple[Elements, ...]:
    """Up to `wanted` cores, `first` among them: one element of a known core after another is dropped.

    `find` gives a core among some elements, None where these do not suffice. All cores are found where there are fewer
    (Reiter's hitting set tree).
    """
    found = [first]
    waiting: list[Elements] = [frozenset()]
    seen: set[Elements] = set()
    while waiting and len(found) < wanted:
        dropped = waiting.pop(0)
        core = next((core for core in found if not core & dropped), None)
        if core is None:
            core = find(requirements.everything - dropped)
            if core is None:
                continue
            found.append(core)
        for element in sorted(core, key=requirements.elements.index):
            following = dropped | {element}
            if following not in seen:
                seen.add(following)
                waiting.append(following)
    return tuple(found)


def core_finder(oracle: FailingStates, cause: Cause) -> Callable[[Elements], Elements | None]:
    """A core of a cause's example among some elements, None where these do not suffice."""
    question, example = Question.of(oracle, cause.asked), cause.example

    def find(among: Elements) -> Elements | None:
        return core_of(oracle, cause.asked, example, among) if question.fails(example, among) else None

    return find


def typical_state(requirements: Requirements, states: Bdd) -> State:
    """A state of the largest cube of a set, preferably one like most others: the first one there."""
    encoding = requirements.encoding
    cover = disjoint_cubes(encoding, states, encoding.domain() & ~requirements.valid, 1)
    return encoding.first_state(states & set_of(encoding, cover.cubes[0]))


def element_list(requirements: Requirements, core: Elements) -> tuple[Element, ...]:
    """A core in the order of the specification's elements."""
    return tuple(each for each in requirements.elements if each in core)
