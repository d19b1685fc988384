"""Looking a state up in a policy."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Protocol

from tumato_symbolic.diagnostics import Code, Diagnostic, UserError
from tumato_symbolic.diagnostics.wording import listed
from tumato_symbolic.policy.model import DecisionDiagram, Policy, Table, Vocabulary
from tumato_symbolic.policy.problems import MOST, described, fault, show, way_out
from tumato_symbolic.policy.shape import as_object, as_text, parse_json


class UndecidedState(ValueError):  # noqa: N818 - no error of the user: a state may be undecided rightly
    """The policy says nothing of a state: one that the assumptions exclude, or one that the policy forgot."""

    def __init__(self, state: Mapping[str, str]) -> None:
        super().__init__(f"the policy does not decide this state: {described(state)}")
        self.state = dict(state)


class Decider(Protocol):
    """A policy prepared for being asked many times."""

    def decide(self, state: Mapping[str, str]) -> tuple[str, ...]:
        """See `Policy.decide`."""


def make_decider(policy: Policy) -> Decider:
    """Prepare a policy for `Policy.decide`."""
    if isinstance(policy.decisions, Table):
        return _by_table(policy.vocabulary, policy.decisions)
    return _by_diagram(policy.vocabulary, policy.decisions)


@dataclass(frozen=True, slots=True)
class _TableDecider:
    vocabulary: Vocabulary
    names: tuple[str, ...]
    answers: dict[tuple[str, ...], tuple[str, ...]]

    def decide(self, state: Mapping[str, str]) -> tuple[str, ...]:
        try:
            if len(state) == len(self.names):
                return self.answers[tuple([state[name] for name in self.names])]
        except (KeyError, TypeError):
            pass
        check_state(self.vocabulary, state)
        raise UndecidedState(state)


def _by_table(vocabulary: Vocabulary, table: Table) -> _TableDecider:
    texts: dict[frozenset[int], tuple[str, ...]] = {}
    answers = {}
    for state, chosen in table.rows.items():
        key = tuple([values[value] for (_, values), value in zip(vocabulary.variables, state, strict=True)])
        if chosen not in texts:
            texts[chosen] = tuple(vocabulary.actions[action] for action in sorted(chosen))
        answers[key] = texts[chosen]
    return _TableDecider(vocabulary, tuple(name for name, _ in vocabulary.variables), answers)


@dataclass(frozen=True, slots=True)
class _DiagramDecider:
    vocabulary: Vocabulary
    numbers: tuple[tuple[str, dict[str, int]], ...]
    decisions: DecisionDiagram

    def decide(self, state: Mapping[str, str]) -> tuple[str, ...]:
        try:
            values = [known[state[name]] for name, known in self.numbers] if len(state) == len(self.numbers) else None
        except (KeyError, TypeError):
            values = None
        if values is None:
            check_state(self.vocabulary, state)
            raise UndecidedState(state)
        diagram = self.decisions.diagram
        if not diagram.evaluate(self.decisions.defined, values):
            raise UndecidedState(state)
        chosen = zip(self.vocabulary.actions, self.decisions.roots, strict=True)
        return tuple([name for name, root in chosen if diagram.evaluate(root, values)])


def _by_diagram(vocabulary: Vocabulary, decisions: DecisionDiagram) -> _DiagramDecider:
    numbers = ((name, {value: at for at, value in enumerate(values)}) for name, values in vocabulary.variables)
    return _DiagramDecider(vocabulary, tuple(numbers), decisions)


def check_state(vocabulary: Vocabulary, state: Mapping[str, str]) -> None:
    """Raise `UserError` with what keeps `state` from being one of the policy's states (TUM503, TUM504)."""
    problems = tuple(islice(_problems(vocabulary, state), MOST))
    if problems:
        raise UserError(problems)


def _problems(vocabulary: Vocabulary, state: Mapping[str, str]) -> Iterator[Diagnostic]:
    known = dict(vocabulary.variables)
    for name, value in state.items():
        if name not in known:
            message = f"the policy has no variable {show(name)}"
            yield Diagnostic(Code.TUM503, message, help=way_out(name, known, "variables"))
        elif value not in known[name]:
            message = f"{show(name)} has no value {show(value)}"
            yield Diagnostic(Code.TUM504, message, help=way_out(value, known[name], "values"))
    for name, values in known.items():
        if name not in state:
            yield Diagnostic(Code.TUM503, f"{show(name)} has no value", help=f"its values: {listed(values)}")


def parse_assignments(policy: Policy, words: Sequence[str]) -> dict[str, str]:
    """The state that words such as `S_Location=corridor` describe.

    Raises `UserError` (TUM503, TUM504, TUM509) where they do not give every variable exactly one of its values.
    """
    state: dict[str, str] = {}
    problems = []
    for word in words:
        name, equals, value = word.partition("=")
        name, value = name.strip(), value.strip()
        if not equals:
            problems.append(Diagnostic(Code.TUM509, f"{show(word)} is not of the form VARIABLE=VALUE"))
        elif state.setdefault(name, value) != value:
            message = f"{show(name)} is given two values, {show(state[name])} and {show(value)}"
            problems.append(Diagnostic(Code.TUM509, message))
    problems.extend(islice(_problems(policy.vocabulary, state), MOST))
    if problems:
        raise UserError(tuple(problems[:MOST]))
    return state


def parse_state(policy: Policy, line: str) -> dict[str, str]:
    """The state that one JSON object such as `{"S_Location": "corridor"}` describes.

    Raises `UserError` (TUM503, TUM504, TUM509) like `parse_assignments`.
    """
    try:
        section = as_object(parse_json(line, "state"), "the state")
        state = {name: as_text(value, f"the value of {show(name)}") for name, value in section.items()}
    except UserError as error:
        message = error.diagnostics[0].message
        example = json.dumps({name: values[0] for name, values in policy.vocabulary.variables[:2]})
        raise fault(Code.TUM509, f"the line is not a state: {message}", f"write one like {example}") from None
    check_state(policy.vocabulary, state)
    return state
