"""From the actions of a policy to their cases: the prover asks about cases, files and reports name actions."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from tumato_symbolic.diagrams import EVERYTHING, LEAVES, Reference, Sets, room_for
from tumato_symbolic.policy.decisions.state_sets import StateSets
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import DecisionDiagram, Restoring, Table, Vocabulary
from tumato_symbolic.semantics import cases_in
from tumato_symbolic.spec import Spec


def by_case(policy: Policy, spec: Spec) -> Policy:
    """A policy with the vocabulary of `spec`, each action of it replaced by the case that is meant in the state.

    In its vocabulary, the cases of an action have the name of the action.
    """
    if not spec.has_cases:
        return policy
    vocabulary = Vocabulary(policy.vocabulary.variables, tuple(action.name for action in spec.actions))
    decisions, certificate = policy.decisions, policy.certificate
    if isinstance(decisions, Table):
        rows = {state: cases_in(spec, chosen, state) for state, chosen in decisions.rows.items()}
        decisions = Table(rows)
    else:
        with room_for(len(spec.variables)):
            decisions = _Lifting(decisions, spec).decisions()
    if certificate is not None and certificate.restoring is not None:
        certificate = replace(certificate, restoring=_restoring(certificate.restoring, spec))
    return replace(policy, vocabulary=vocabulary, decisions=decisions, certificate=certificate)


def _restoring(restoring: Restoring, spec: Spec) -> Restoring:
    deviations = (replace(each, better=cases_in(spec, each.better, each.state)) for each in restoring.deviations)
    return replace(restoring, deviations=tuple(deviations))


class _Lifting:
    """The decisions of a diagram by cases."""

    def __init__(self, decisions: DecisionDiagram, spec: Spec) -> None:
        order = decisions.diagram.order
        others = (variable for variable in range(len(spec.variables)) if variable not in order)
        self._spec = spec
        self._sets = Sets([*order, *others], [len(variable.values) for variable in spec.variables])
        roots = (*decisions.roots, decisions.defined)
        *self._actions, self._defined = self._sets.take(decisions.diagram, roots, LEAVES)
        self._formulas = StateSets.of(self._sets, spec)

    def decisions(self) -> DecisionDiagram:
        """All cases of all actions, in their order."""
        each = zip(self._actions, self._spec.cases, strict=True)
        roots = [root for action, cases in each for root in self._of(action, cases)]
        diagram, found = self._sets.as_diagram([*roots, self._defined])
        return DecisionDiagram(diagram, found[:-1], found[-1])

    def _of(self, action: Reference, cases: range) -> Iterator[Reference]:
        """Where each case of an action is executed: the first one also where none is meant."""
        if len(cases) == 1:
            yield action
            return
        guards = [self._guard(case) for case in cases]
        if sum(map(self._sets.count, guards)) < self._sets.count(EVERYTHING):
            guards[0] = self._sets.without(EVERYTHING, self._formulas.any_of(guards[1:]))
        for guard in guards:
            yield self._sets.both(action, guard)

    def _guard(self, case: int) -> Reference:
        guard = self._spec.actions[case].guard
        return EVERYTHING if guard is None else self._formulas.states(guard.formula)
