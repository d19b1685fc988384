"""A policy in the numbers of a specification, and what does not fit there: names, ordering, restoration."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice

from msgspec import Struct
from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagrams import rebuild
from tumato_symbolic.policy.decisions.cases import by_case
from tumato_symbolic.policy.policy import Policy
from tumato_symbolic.policy.records import (
    Certificate,
    DecisionDiagram,
    Deviation,
    Restoring,
    SomeDrawn,
    Table,
    Vocabulary,
)
from tumato_symbolic.policy.text import MOST, show, way_out
from tumato_symbolic.semantics import ActionSet, State
from tumato_symbolic.spec import Assignment, Spec


def bind(policy: Policy, spec: Spec) -> Policy:
    """The same policy in the numbers of `spec`, where an action with clauses is executed by its cases.

    Raises `UserError` as `fitted` does.
    """
    return by_case(fitted(policy, spec), spec)


def fitted(policy: Policy, spec: Spec) -> Policy:
    """The same policy, renumbered so that its vocabulary is that of `spec`.

    Raises `UserError` with (at most 20 of) the variables, values and actions that only one side has (TUM503, TUM504,
    TUM505). A certificate that mentions unknown actions is set aside.
    """
    target = Vocabulary.of(spec)
    renumbering = Renumbering.between(policy.vocabulary, target, "policy")
    certificate, problem = _certificate(policy, target)
    if certificate is not None:
        certificate = renumbering.certificate(certificate)
    decisions = policy.decisions
    bound = renumbering.table(decisions) if isinstance(decisions, Table) else renumbering.decisions(decisions)
    return replace(policy, vocabulary=target, decisions=bound, certificate=certificate, certificate_problem=problem)


def made_for_less(policy: Policy, spec: Spec) -> bool:
    """Whether a policy records the effect ordering `first` where the specification means `any`.

    It was made for a weaker meaning of *safe*, and is no policy for this specification, unless the user says so.
    """
    return (policy.ordering, spec.ordering) == ("first", "any")


def restores_less(policy: Policy, spec: Spec) -> bool:
    """Whether a policy records a weaker way to restore safety than the specification means."""
    strengths = ("fair", "bounded", "one_step")
    return strengths.index(policy.restoration) < strengths.index(spec.restoration)


def _problems(source: Vocabulary, target: Vocabulary, what: str) -> Iterator[Diagnostic]:
    ours, theirs = dict(target.variables), dict(source.variables)
    for name, known in source.variables:
        if name not in ours:
            message = f"the {what} mentions the variable {show(name)}, which the specification does not have"
            yield Diagnostic(Code.TUM503, message, help=way_out(name, ours, "variables of the specification"))
            continue
        for value in known:
            if value not in ours[name]:
                message = f"the {what} has a value {show(value)} of {show(name)}, which the specification does not have"
                yield Diagnostic(Code.TUM504, message, help=way_out(value, ours[name], "values in the specification"))
    for name, values in target.variables:
        if name not in theirs:
            message = f"the {what} lacks the variable {show(name)} of the specification"
            yield Diagnostic(Code.TUM503, message, help="synthesize again")
            continue
        for value in values:
            if value not in theirs[name]:
                message = f"the {what} lacks the value {show(value)} of {show(name)} in the specification"
                yield Diagnostic(Code.TUM504, message, help="add it to `States`, or synthesize again")
    for action in source.actions:
        if action not in target.actions:
            message = f"the {what} mentions the action {show(action)}, which the specification does not have"
            yield Diagnostic(Code.TUM505, message, help=way_out(action, target.actions, "actions of the specification"))
    for action in target.actions:
        if action not in source.actions:
            message = f"the {what} lacks the action {show(action)} of the specification"
            yield Diagnostic(Code.TUM505, message, help="add it to `Actions`, or synthesize again")


def _certificate(policy: Policy, target: Vocabulary) -> tuple[Certificate | None, str | None]:
    certificate = policy.certificate
    if certificate is not None:
        for goal in certificate.goals:
            for name in goal.executed:
                if name not in target.actions:
                    return None, f"`Certificate` mentions the unknown action {show(name)}"
    return certificate, policy.certificate_problem


class Renumbering(Struct, frozen=True):
    """`variables[old]` and `actions[old]` are new numbers; `values[old]` lists, for new value numbers, the old ones."""

    variables: tuple[int, ...]
    values: tuple[tuple[int, ...], ...]
    actions: tuple[int, ...]

    @classmethod
    def between(cls, source: Vocabulary, target: Vocabulary, what: str) -> Renumbering:
        """From one vocabulary to another with the same names. Raises `UserError` where they differ.

        `what` is what the owner of `source` is called in messages.
        """
        problems = tuple(islice(_problems(source, target, what), MOST))
        if problems:
            raise UserError(problems)
        places = {name: number for number, (name, _) in enumerate(target.variables)}
        wanted = dict(target.variables)
        return cls(
            tuple(places[name] for name, _ in source.variables),
            tuple(tuple(map(values.index, wanted[name])) for name, values in source.variables),
            tuple(target.actions.index(name) for name in source.actions),
        )

    @property
    def _changes_nothing(self) -> bool:
        """Whether all numbers stay as they are."""
        numbers = (self.variables, *self.values, self.actions)
        return all(each == tuple(range(len(each))) for each in numbers)

    def assignment(self, assignment: Iterable[tuple[int, int]]) -> Assignment:
        """The same variables with the same values."""
        return tuple(sorted((self.variables[old], self.values[old].index(value)) for old, value in assignment))

    def state(self, state: State) -> State:
        """The same state."""
        return tuple(value for _, value in self.assignment(enumerate(state)))

    def action_set(self, chosen: Iterable[int]) -> ActionSet:
        """The same actions."""
        return frozenset(self.actions[old] for old in chosen)

    def table(self, table: Table) -> Table:
        """Every row with new numbers, in row-major order."""
        if self._changes_nothing:
            return table
        places = [self.variables.index(new) for new in range(len(self.variables))]
        new_values = [{old: new for new, old in enumerate(values)} for values in self.values]
        decisions = {chosen: self.action_set(chosen) for chosen in set(table.rows.values())}
        columns = [(place, new_values[place]) for place in places]
        rows = {
            tuple([values[state[place]] for place, values in columns]): decisions[chosen]
            for state, chosen in table.rows.items()
        }
        return Table(dict(sorted(rows.items())))

    def decisions(self, decisions: DecisionDiagram) -> DecisionDiagram:
        """Roots in the new order of actions; the order of tests stays as it is."""
        by_action = dict(zip(self.actions, decisions.roots, strict=True))
        wanted = tuple(by_action[action] for action in range(len(self.actions)))
        return self.drawn(replace(decisions, roots=wanted))

    def certificate(self, certificate: Certificate) -> Certificate:
        """The ranks of the same states."""
        restoring = None if certificate.restoring is None else self.restoring(certificate.restoring)
        return self.drawn(replace(certificate, restoring=restoring))

    def restoring(self, restoring: Restoring) -> Restoring:
        """The efforts of the same states."""
        deviations = (
            Deviation(self.state(each.state), self.action_set(each.better), self.state(each.missed))
            for each in restoring.deviations
        )
        return self.drawn(replace(restoring, deviations=tuple(deviations)))

    def drawn(self, record: SomeDrawn) -> SomeDrawn:
        """The same functions of states with new numbers; the order of tests stays as it is."""
        if self._changes_nothing:
            return record
        diagram, roots = record.drawing
        order = [self.variables[variable] for variable in diagram.order]
        return record.drawn(*rebuild(diagram, roots, order, [self.values[variable] for variable in diagram.order]))
