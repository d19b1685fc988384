"""From the actions of a policy to their cases: the prover asks about cases, files and reports name actions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from tumato_symbolic.diagrams import EVERYTHING, LEAVES, NOTHING, Reference, Sets, room_for
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import DecisionDiagram, Restoring, Table, Vocabulary
from tumato_symbolic.semantics import cases_in
from tumato_symbolic.spec import Connectives, Executing, Formula, Is, Spec, fold


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
        self._levels = {variable: level for level, variable in enumerate(self._sets.order)}
        self._by: Connectives[Reference] = Connectives(
            constant=lambda value: EVERYTHING if value else NOTHING,
            negation=lambda states: self._sets.without(EVERYTHING, states),
            conjunction=self._all_of,
            disjunction=self._any_of,
            equivalence=lambda one, other: self._sets.choose(one, other, self._sets.without(EVERYTHING, other)),
        )

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
            guards[0] = self._sets.without(EVERYTHING, self._any_of(guards[1:]))
        for guard in guards:
            yield self._sets.both(action, guard)

    def _guard(self, case: int) -> Reference:
        guard = self._spec.actions[case].guard
        return EVERYTHING if guard is None else self._states(guard.formula)

    def _states(self, formula: Formula) -> Reference:
        def atom(atom: Is | Executing) -> Reference:
            assert isinstance(atom, Is), "guards speak of the state"
            return self._sets.cube(((self._levels[atom.variable], (atom.value,)),))

        return fold(formula, atom, self._by)

    def _all_of(self, parts: Sequence[Reference]) -> Reference:
        found = EVERYTHING
        for part in parts:
            found = self._sets.both(found, part)
        return found

    def _any_of(self, parts: Sequence[Reference]) -> Reference:
        found = NOTHING
        for part in parts:
            found = self._sets.either(found, part)
        return found
