"""What a page carries: a specification and a policy as plain data, for the judge in JavaScript and for the reader."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

from tumato_symbolic.diagnostics import CopySpan, Source, Span
from tumato_symbolic.diagnostics.wording import one_line
from tumato_symbolic.diagrams import rebuild
from tumato_symbolic.explain.elements import Element
from tumato_symbolic.policy import Policy, as_diagram, count_defined
from tumato_symbolic.semantics import count_states
from tumato_symbolic.spec import (
    And,
    Assignment,
    ConditionalGoal,
    Constant,
    Executing,
    Formula,
    Goal,
    GoalList,
    Iff,
    Is,
    Not,
    Or,
    Ordering,
    Rule,
    SimpleGoal,
    Spec,
    executing_actions,
)

Json: TypeAlias = Any
"""What `json.dumps` takes."""


def spec_record(spec: Spec, source: Source, ordering: Ordering) -> dict[str, Json]:
    """The specification, with effects in an ordering; `text` is how it was written.

    Actions are those of the text: their cases are told apart by `guard`, and `x` in predicates names an action.
    """
    record = _Predicates(spec)
    return {
        "file": source.name,
        "text": source.text,
        "states": f"{count_states(spec):,}",
        "variables": [[variable.name, list(variable.values)] for variable in spec.variables],
        "environment": sorted(spec.environment),
        "resources": list(spec.resources),
        "actions": [_action(record, cases) for cases in spec.cases],
        "reaction_rules": record.rules(spec.reaction_rules),
        "state_rules": [{**record.rule(rule), "severity": rule.severity} for rule in spec.state_rules],
        "assumptions": record.rules(spec.assumptions),
        "starts": record.rules(spec.starts),
        "bodies": record.rules(spec.bodies),
        "goals": None if spec.goals is None else _goal(record, spec.goals),
        "bound": spec.max_plan_length,
        "ordering": ordering,
        "restoration": spec.restoration,
        "preconditions": spec.preconditions,
    }


def policy_record(policy: Policy, name: str) -> dict[str, Json]:
    """The decisions of a policy that has the vocabulary of the specification, as a diagram; `name` is its file.

    References 0 and 1 are false and true, others are nodes, counted from 2.
    """
    decisions = as_diagram(policy)
    diagram, (*roots, defined) = rebuild(decisions.diagram, (*decisions.roots, decisions.defined))
    return {
        "file": name,
        "decided": f"{count_defined(policy):,}",
        "order": list(diagram.order),
        "nodes": [[level, list(below)] for level, below in diagram.nodes],
        "roots": roots,
        "defined": defined,
    }


def alternatives_record(spec: Spec) -> Json:
    """For each case of each action, and each alternative, the numbers of the effects that it may have."""
    return [
        [
            [[case.effects.index(outcome) for outcome in entry.outcomes if case.effects] for entry in case.alternatives]
            for case in (spec.actions[number] for number in cases)
        ]
        for cases in spec.cases
    ]


def elements_record(spec: Spec, elements: Iterable[Element]) -> list[Json]:
    """Elements in the numbers of the page: kind, number of the rule or the action, part."""
    of_actions = ("precondition", "alternative", "resource")
    return [
        [each.kind, spec.action_of(each.number) if each.kind in of_actions else each.number, each.part]
        for each in elements
    ]


class _Predicates:
    """Predicates and rules as data, in the numbers of variables, values and actions."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec

    def rules(self, rules: Iterable[Rule]) -> list[Json]:
        """Each with its text and its place."""
        return [self.rule(rule) for rule in rules]

    def rule(self, rule: Rule) -> dict[str, Json]:
        """A rule; `with` are the parameters of a copy."""
        return {"is": self.formula(rule.formula), "text": one_line(rule.text), **place(rule.span)}

    def formula(self, formula: Formula) -> Json:
        """`true`, `[variable, value, …]`, `["x", action]`, `["!", p]`, `["&", …]`, `["|", …]` or `["=", p, q]`."""
        return self._data(executing_actions(self.spec, formula))

    def _data(self, formula: Formula) -> Json:
        match formula:
            case Constant(value):
                return value
            case Is(variable, value):
                return [variable, value]
            case Executing(action):
                return ["x", self.spec.action_of(action)]
            case Not(operand):
                return ["!", self._data(operand)]
            case And(operands):
                return ["&", *map(self._data, operands)]
            case Or(operands):
                return _one_of(operands) or ["|", *map(self._data, operands)]
            case Iff(left, right):
                return ["=", self._data(left), self._data(right)]


def _one_of(operands: Sequence[Formula]) -> list[int] | None:
    """Several values of one variable."""
    found = [each for each in operands if isinstance(each, Is)]
    if len(found) < len(operands) or len({each.variable for each in found}) > 1:
        return None
    return [found[0].variable, *(each.value for each in found)]


def place(span: Span) -> dict[str, Json]:
    """The line of a text, and the parameters of a copy that stands there."""
    return {"line": span.line, **({"with": span.worded} if isinstance(span, CopySpan) else {})}


def _action(record: _Predicates, cases: range) -> dict[str, Json]:
    spec = record.spec
    first = spec.actions[cases[0]]
    return {
        "name": first.name,
        "duration": first.duration,
        "resources": sorted(first.resources),
        "pre": record.rules(first.preconditions),
        "cases": [
            {
                **({} if (guard := spec.actions[case].guard) is None else {"guard": record.formula(guard.formula)}),
                "effects": [_effect(effect) for effect in spec.actions[case].effects],
            }
            for case in cases
        ],
        **place(first.span),
    }


def _effect(effect: Assignment) -> list[int]:
    """Variable, value, variable, value, …"""
    return [number for pair in effect for number in pair]


def _goal(record: _Predicates, goal: Goal) -> Json:
    match goal:
        case SimpleGoal(body):
            own = record.spec.as_written(goal)
            return {"body": body, "text": one_line(own.text), **place(own.span)}
        case ConditionalGoal(condition, inner):
            return {"when": record.rule(condition), "then": _goal(record, inner)}
        case GoalList(kind, members):
            return {"kind": kind, "members": [_goal(record, member) for member in members]}
