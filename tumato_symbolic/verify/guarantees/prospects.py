"""What becomes of a residual goal under a policy, for all states at once (`docs/semantics.md`, section 11)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import inf

from tumato_symbolic.semantics import NOTHING, Guarantee, Residual, State
from tumato_symbolic.verify.by_diagrams.closed_loop import ClosedLoop
from tumato_symbolic.verify.by_diagrams.functions import FALSE, TRUE, Function
from tumato_symbolic.verify.by_diagrams.goals import WalkGoals

NO_RANK = -1
"""In place of a number of steps: there is none."""


class WalkProspects:
    """The fixpoints of `semantics.Prospects` as functions for the walk.

    `D(t) ⊆ W_k` is `Next ⊆ W_k` wherever `δ` leads into `W_{k+1}`, which is a part of `W_k`.
    """

    def __init__(self, model: ClosedLoop, goals: WalkGoals, goal: Residual) -> None:
        self._model, self._walk = model, model.walk
        self._met = goals.reached(goal)

    @cached_property
    def surviving(self) -> list[Function]:
        """`W_0, W_1, …` up to `W_ω`, each once."""
        found = [self._nominal_layers[-1]]
        while (smaller := self._nominally(self._leads_into(found[-1]))) != found[-1]:
            found.append(smaller)
        return found

    def _leads_into(self, target: Function) -> Function:
        self._walk.make_room()
        return self._model.leads_into(target)

    @cached_property
    def _nominal_layers(self) -> list[Function]:
        """The states of `W_0` by the number of nominal steps after which the goal is met, and all with fewer."""
        return list(self._growing(self._model.acting))

    def _nominally(self, where: Function) -> Function:
        """`μX. c ∪ {t ∈ where : δ ∈ X}`."""
        *_, found = self._growing(where)
        return found

    def _growing(self, where: Function) -> Iterator[Function]:
        found, before = self._met, None
        while found != before:
            yield found
            before = found
            found = self._walk.any_of((self._met, self._walk.all_of((where, self._model.next(found)))))

    @cached_property
    def layers(self) -> list[Function]:
        """The states of `G` by the number of steps after which the goal is met at worst, and all with fewer."""
        found = [self._met]
        while (more := self._walk.any_of((self._met, self._leads_into(found[-1])))) != found[-1]:
            found.append(more)
        return found

    def levels(self, pending: Function) -> Iterator[tuple[Guarantee | None, Function]]:
        """The parts of `pending`, states with this residual goal, by what their first step guarantees.

        None where not even its nominal run meets the goal.
        """
        for steps, layer in enumerate(self.layers, 1):
            now, pending = self._split(pending, self._leads_into(layer))
            if now != FALSE:
                yield Guarantee("guaranteed", steps=steps), now
            if pending == FALSE:
                return
        fair, pending = self._split(pending, self._leads_into(self.surviving[-1]))
        if fair != FALSE:
            yield Guarantee("fair"), fair
        for deviations in range(len(self.surviving) - 1, -1, -1):
            survives = self._model.next(self.surviving[deviations])
            if deviations:
                survives = self._walk.all_of((survives, self._leads_into(self.surviving[deviations - 1])))
            now, pending = self._split(pending, self._walk.all_of((self._model.acting, survives)))
            if now != FALSE:
                yield Guarantee("survives", deviations=deviations) if deviations else Guarantee("nominal"), now
        if pending != FALSE:
            yield None, pending

    def _split(self, states: Function, predicate: Function) -> tuple[Function, Function]:
        return self._walk.all_of((states, predicate)), self._walk.without(states, predicate)

    def ranks(self) -> tuple[list[Function], Function]:
        """For every `W_k` the number of nominal steps to the goal, for `G` that at worst; `NO_RANK` outside."""
        nominal = self._numbered(self._nominal_layers)
        nowhere = self._walk.constant(NO_RANK)
        surviving = [self._walk.select(each, (nowhere, nominal)) for each in self.surviving]
        return surviving, self._numbered(self.layers)

    def _numbered(self, layers: list[Function]) -> Function:
        found = self._walk.constant(NO_RANK)
        for steps in reversed(range(len(layers))):
            found = self._walk.select(layers[steps], (found, self._walk.constant(steps)))
        return found

    def endures(self, state: State) -> float:
        """As `semantics.Prospects.endures`."""
        if self._holds(self.surviving[-1], state):
            return inf
        return sum(self._holds(each, state) for each in self.surviving) - 1

    def forced(self, state: State) -> bool:
        """Whether the goal is met from `state` whatever happens."""
        return self._holds(self.layers[-1], state)

    def _holds(self, function: Function, state: State) -> bool:
        return function == TRUE or self._model.holds(function, state, NOTHING)
