"""What to drop so that there is a policy: every minimal way, the smallest first, each one tried."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Literal, TypeAlias

from tumato_symbolic.explain.conflicts import conflict_core
from tumato_symbolic.explain.cores import core_of, element_list, typical_state
from tumato_symbolic.explain.elements import Element, ElementKind, Elements, without
from tumato_symbolic.explain.explanation import Change, Explanation, Repair
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import trial
from tumato_symbolic.explain.weaken import weakening
from tumato_symbolic.explain.work import Work
from tumato_symbolic.synthesis import Realizable, Unrealizable
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

Unavoidable: TypeAlias = Literal["failing", "conflict"]
"""Why nothing helps: with everything dropped but the assumptions, states still fail, or goals conflict."""

MOST_WEAKENED = 3
"""A repair of more elements is of no practical use."""


def repairs_found(work: Work, found: Explanation) -> Iterator[Explanation]:
    """Inclusion-minimal sets of elements whose dropping makes the specification realizable, the smallest first.

    A repair hits every core. Smallest sets that hit all known cores are tried; one that does not do shows a new core.
    Single elements, and the first repair where it is small, are weakened as well.
    """
    requirements, wanted = work.requirements, work.wanted_repairs
    work.context.tell("repairs: finding out whether there is one")
    unavoidable = _unavoidable(requirements)
    if unavoidable is not None or wanted < 1:
        yield replace(found, unavoidable=unavoidable, repairs_complete=unavoidable is not None)
        return
    search = _Search(work.oracle, (frozenset(reason.core) for reason in found.reasons))
    for number in range(wanted):
        work.context.tell(f"repairs: {number + 1} of {wanted}")
        dropped = search.next()
        if dropped is None:
            yield replace(found, repairs_complete=search.complete)
            return
        elements = element_list(requirements, dropped)
        found = replace(found, repairs=(*found.repairs, Repair(tuple(Change(each, None) for each in elements))))
        yield found
        worth_it = len(dropped) <= (MOST_WEAKENED if number == 0 else 1)
        weaker = weakening(requirements, dropped) if worth_it else None
        if weaker is not None:
            texts: dict[Element, str | None] = {edit.element: edit.text for edit in weaker.edits}
            changes = tuple(Change(each, texts.get(each)) for each in elements)
            found = replace(found, repairs=(*found.repairs, Repair(changes)))
            yield found


def _droppable(elements: Iterable[Element]) -> list[Element]:
    """Never assumptions: without them there are more states."""
    return [each for each in elements if each.kind != "assumption"]


def _unavoidable(requirements: Requirements) -> Unavoidable | None:
    outcome = trial(requirements, without(requirements.spec, _droppable(requirements.elements)))
    if isinstance(outcome, Realizable):
        return None
    conflicts = not isinstance(outcome, Unrealizable) or outcome.failures[0].kind == "conflict"
    return "conflict" if conflicts else "failing"


class _Search:
    """Implicit hitting sets: candidates, and the cores that they miss."""

    def __init__(self, oracle: FailingStates, cores: Iterable[Elements]) -> None:
        self._oracle = oracle
        requirements = oracle.requirements
        self._numbers = {element: number for number, element in enumerate(_droppable(requirements.elements))}
        penalties = [_PENALTIES[element.kind] for element in self._numbers]
        self._hitting = HittingSets(penalties, requirements.manager.context.seconds_left)
        self._rounds = ROUNDS
        self.complete = False
        """Whether there are no other repairs than those that were found."""
        for core in cores:
            self._must_hit(core)

    def next(self) -> Elements | None:
        """The smallest repair that was not found yet; None where there is none, or none is found in so many rounds."""
        elements = list(self._numbers)
        while self._rounds:
            self._rounds -= 1
            self._oracle.requirements.manager.context.check()
            candidate = self._hitting.smallest()
            if candidate is None:
                self.complete = True
                return None
            dropped = frozenset(elements[number] for number in candidate)
            missed = self._missed_core(dropped)
            if missed is None:
                self._hitting.exclude(sorted(candidate))
                return dropped
            self._must_hit(missed)
        return None

    def _must_hit(self, core: Elements) -> None:
        self._hitting.require([self._numbers[element] for element in _droppable(core)])

    def _missed_core(self, dropped: Elements) -> Elements | None:
        """A core without any dropped element; None where the specification without them is realizable."""
        requirements = self._oracle.requirements
        kept = requirements.everything - dropped
        stuck = requirements.stuck(kept)
        if stuck != requirements.false:
            return core_of(self._oracle, "no-allowed-set", typical_state(requirements, stuck), kept)
        failing = self._oracle.failing(kept, requirements.valid)
        if failing != requirements.false:
            return core_of(self._oracle, "no-plan", typical_state(requirements, failing), kept)
        outcome = trial(requirements, without(requirements.spec, dropped))
        if isinstance(outcome, Realizable):
            return None
        if isinstance(outcome, Unrealizable):
            return conflict_core(requirements, outcome.failures[0].states, kept)
        return kept  # whatever is kept is to blame: the next candidate has to drop more
