"""Which lines are dropped so that there is a policy: the fewest, and which kind of line rather than another."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from tumato_symbolic.explain.conflicts import conflict_core
from tumato_symbolic.explain.cores import core_of, typical_state
from tumato_symbolic.explain.elements import Element, ElementKind, Elements, rule_of, without
from tumato_symbolic.explain.failing_states import FailingStates
from tumato_symbolic.explain.hitting_sets import SearchedHittingSets
from tumato_symbolic.explain.minimize import minimal
from tumato_symbolic.explain.requirements import Requirements
from tumato_symbolic.explain.trial import is_realizable, trial
from tumato_symbolic.limits import has_z3
from tumato_symbolic.spec import Spec, variables_of
from tumato_symbolic.synthesis import Realizable, Unrealizable

if TYPE_CHECKING:
    from tumato_symbolic.synthesis.solver import HittingSets

ROUNDS = 300
"""So many candidates are tried at most."""

_PENALTIES: dict[ElementKind, int] = {
    "plan-bound": 0,
    "assumption": 0,
    "precondition": 1,
    "alternative": 3,
    "resource": 4,
    "reaction-rule": 5,
    "state-rule": 50,
}
"""Of repairs of one size, those come first that add what the robot can do, and last those that give up safety."""

_TOLD = 10
"""What speaks against a kind of line that is told: of one size, each kind comes once before any comes again."""


def _hitting_sets(
    penalties: Sequence[int], seconds_left: Callable[[], float | None]
) -> HittingSets | SearchedHittingSets:
    """Found by Z3, where there is one."""
    if not has_z3():
        return SearchedHittingSets(penalties, seconds_left)
    from tumato_symbolic.synthesis.solver import HittingSets

    return HittingSets(penalties, seconds_left)


class Search:
    """Implicit hitting sets: candidates, and the cores that they miss.

    Of the elements to choose from, `droppable`, some of `among` are in every repair, where these are given.
    """

    def __init__(
        self,
        oracle: FailingStates,
        cores: Iterable[Elements],
        droppable: Iterable[Element],
        among: Elements | None = None,
    ) -> None:
        self._oracle = oracle
        requirements = oracle.requirements
        self._numbers = {element: number for number, element in enumerate(droppable)}
        penalties = [_penalty(requirements.spec, element) for element in self._numbers]
        self._hitting = _hitting_sets(penalties, requirements.manager.context.seconds_left)
        self._rounds = ROUNDS
        self._untold: set[ElementKind] = {element.kind for element in self._numbers}
        self._among = among
        self.complete = False
        """Whether there are no other repairs than those that were found."""
        for core in cores:
            self._must_hit(core)
        if among is not None:
            self._must_hit(among)

    def exclude(self, repair: Elements) -> None:
        """Look for no repair that contains this one."""
        self._hitting.exclude(sorted(self._numbers[element] for element in repair))

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
            if missed is not None:
                self._must_hit(missed)
                continue
            self.exclude(dropped)
            if self._among is None or not serves_without(self._oracle.requirements, dropped - self._among):
                self._tell({element.kind for element in dropped})
                return dropped
            self.exclude(dropped - self._among)
        return None

    def _tell(self, kinds: set[ElementKind]) -> None:
        new = kinds & self._untold
        self._untold -= new
        self._hitting.penalize((number for element, number in self._numbers.items() if element.kind in new), _TOLD)

    def any_repair(self) -> Elements:
        """A minimal repair of whatever size; dropping everything that can be chosen must be one."""
        requirements = self._oracle.requirements
        items = sorted(self._numbers, key=lambda element: _penalty(requirements.spec, element))
        return minimal(items, lambda dropped: serves_without(requirements, dropped))

    def _must_hit(self, core: Elements) -> None:
        self._hitting.require([self._numbers[element] for element in core if element in self._numbers])

    def _missed_core(self, dropped: Elements) -> Elements | None:
        """A core without any dropped element; None where the specification without them is realizable."""
        requirements = self._oracle.requirements
        kept = requirements.everything - dropped
        if requirements.spec.starts:
            lost = self._oracle.left_out(kept, requirements.starts)
            if lost != requirements.false:
                return core_of(self._oracle, "left-out", typical_state(requirements, lost), kept)
            return self._missed_in_trial(dropped, kept)
        stuck = requirements.stuck(kept)
        if stuck != requirements.false:
            return core_of(self._oracle, "no-allowed-set", typical_state(requirements, stuck), kept)
        failing = self._oracle.failing(kept, requirements.valid)
        if failing != requirements.false:
            return core_of(self._oracle, "no-plan", typical_state(requirements, failing), kept)
        return self._missed_in_trial(dropped, kept)

    def _missed_in_trial(self, dropped: Elements, kept: Elements) -> Elements | None:
        """What synthesis says, where no state fails alone."""
        requirements = self._oracle.requirements
        outcome = trial(requirements, without(requirements.spec, dropped))
        if isinstance(outcome, Realizable):
            return None
        if isinstance(outcome, Unrealizable):
            return conflict_core(requirements, outcome.failures[0].states, kept)
        return kept  # whatever is kept is to blame: the next candidate has to drop more


def droppable(requirements: Requirements) -> tuple[Element, ...]:
    """Never assumptions: without them there are more states."""
    return tuple(each for each in requirements.elements if each.kind != "assumption")


def harmless(requirements: Requirements) -> tuple[Element, ...]:
    """What can be dropped while all state rules are kept."""
    return tuple(each for each in droppable(requirements) if each.kind != "state-rule")


def serves_without(requirements: Requirements, dropped: Iterable[Element]) -> bool:
    """Whether there is a policy when some elements are dropped."""
    return is_realizable(requirements, without(requirements.spec, dropped))


def _penalty(spec: Spec, element: Element) -> int:
    """What speaks against an element; against a precondition, that the action changes all that it is about."""
    penalty = _PENALTIES[element.kind]
    if element.kind != "precondition":
        return penalty
    rule = rule_of(spec, element)
    written = {variable for variable, _ in spec.actions[element.number].nominal}
    return penalty + 1 if rule is not None and variables_of(rule.formula) <= written else penalty
