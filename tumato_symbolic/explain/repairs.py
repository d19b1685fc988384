"""What to drop so that there is a policy: every minimal way, the smallest first, each one tried."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from tumato_symbolic.explain.conditions import Conditions
from tumato_symbolic.explain.conflicts import conflict_core
from tumato_symbolic.explain.cores import core_without_plan, core_without_set, typical_state
from tumato_symbolic.explain.elements import Element, ElementKind, Elements, without
from tumato_symbolic.explain.plans import failing
from tumato_symbolic.synthesis import Realizable, Unrealizable, synthesize
from tumato_symbolic.synthesis.repair import RoundsExhaustedError
from tumato_symbolic.synthesis.solver import HittingSets

ROUNDS = 300
"""So many candidates are tried at most."""

_PENALTIES: dict[ElementKind, int] = {
    "plan-bound": 0,
    "state-rule": 2,
    "reaction-rule": 1,
    "alternative": 1,
    "precondition": 3,
    "resource": 3,
    "assumption": 0,
}
"""Of repairs of one size, those come first that do not pretend that the robot can do what it cannot."""

Hopeless: TypeAlias = Literal["failing", "conflict"]


@dataclass(frozen=True)
class Repairs:
    """Inclusion-minimal sets of elements whose dropping makes the specification realizable, the smallest first.

    `hopeless` tells why there is none: with everything dropped but the assumptions, states still `failing`, or goals in
    `conflict`. `complete`: there are no others.
    """

    found: tuple[Elements, ...]
    complete: bool
    hopeless: Hopeless | None


def repairs(conditions: Conditions, cores: Iterable[Elements], wanted: int) -> Repairs:
    """Up to `wanted` repairs; `cores` are known reasons for failing.

    A repair hits every core. Smallest sets that hit all known cores are tried; one that does not do shows a new core.
    """
    hopeless = _hopeless(conditions)
    if hopeless is not None or wanted < 1:
        return Repairs((), hopeless is not None, hopeless)
    return _Search(conditions, cores).run(wanted)


def _droppable(elements: Iterable[Element]) -> list[Element]:
    """Never assumptions: without them there are more states."""
    return [each for each in elements if each.kind != "assumption"]


def _hopeless(conditions: Conditions) -> Hopeless | None:
    dropped = _droppable(conditions.elements)
    kept = conditions.everything - frozenset(dropped)
    if (conditions.stuck(kept) | failing(conditions, kept, conditions.valid)) != conditions.false:
        return "failing"
    outcome = synthesize(without(conditions.spec, dropped), conditions.ordering, backend=conditions.manager.backend)
    return None if isinstance(outcome, Realizable) else "conflict"


class _Search:
    """Implicit hitting sets: candidates, and the cores that they miss."""

    def __init__(self, conditions: Conditions, cores: Iterable[Elements]) -> None:
        self._conditions = conditions
        self._numbers = {element: number for number, element in enumerate(_droppable(conditions.elements))}
        self._hitting = HittingSets([_PENALTIES[element.kind] for element in self._numbers])
        for core in cores:
            self._must_hit(core)

    def run(self, wanted: int) -> Repairs:
        """The smallest repairs."""
        found: list[Elements] = []
        elements = list(self._numbers)
        for _ in range(ROUNDS):
            candidate = self._hitting.smallest()
            if candidate is None:
                return Repairs(tuple(found), True, None)
            dropped = frozenset(elements[number] for number in candidate)
            missed = self._missed_core(dropped)
            if missed is not None:
                self._must_hit(missed)
                continue
            found.append(dropped)
            self._hitting.exclude(sorted(candidate))
            if len(found) == wanted:
                break
        return Repairs(tuple(found), False, None)

    def _must_hit(self, core: Elements) -> None:
        self._hitting.require([self._numbers[element] for element in _droppable(core)])

    def _missed_core(self, dropped: Elements) -> Elements | None:
        """A core without any dropped element; None where the specification without them is realizable."""
        conditions = self._conditions
        kept = conditions.everything - dropped
        stuck = conditions.stuck(kept)
        if stuck != conditions.false:
            return core_without_set(conditions, typical_state(conditions, stuck), kept)
        helpless = failing(conditions, kept, conditions.valid)
        if helpless != conditions.false:
            return core_without_plan(conditions, typical_state(conditions, helpless), kept)
        outcome = synthesize(without(conditions.spec, dropped), conditions.ordering, backend=conditions.manager.backend)
        if isinstance(outcome, Realizable):
            return None
        if isinstance(outcome, Unrealizable):
            try:
                return conflict_core(conditions, outcome.failures[0].states, kept)
            except RoundsExhaustedError:
                pass
        return kept  # whatever is kept is to blame: the next candidate has to drop more
