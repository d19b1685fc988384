"""Actions with their fields resolved."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics import Code, CopySpan, Note, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.effects import Effects
from tumato_symbolic.spec.names import Names
from tumato_symbolic.spec.predicates import Predicates
from tumato_symbolic.spec.specification import Action, Alternative, Assignment, Rule
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.excerpts import Excerpts

MAX_DURATION = 1_000_000_000
"""The longest duration."""

_FIELDS = {
    ast.Duration: "duration:",
    ast.ControlledResources: "controlled resources:",
    ast.Preconditions: "preconditions:",
    ast.NominalEffects: "nominal effects:",
}


class Actions:
    """Resolves the actions one by one."""

    def __init__(self, names: Names, predicates: Predicates, excerpts: Excerpts, findings: Findings) -> None:
        self._names = names
        self._predicates = predicates
        self._excerpts = excerpts
        self._findings = findings
        self._effects = Effects(names.variables, findings)

    def resolve(self) -> tuple[Action, ...]:
        """Every action; what is in error is left out of it, and reported."""
        return tuple(self._action(each) for each in self._names.actions)

    def _action(self, declaration: ast.ActionDeclaration) -> Action:
        name = declaration.name.text
        self._once_each(declaration)
        duration = 0
        resources: frozenset[int] = frozenset()
        preconditions: tuple[Rule, ...] = ()
        nominal: Assignment = ()
        alternatives: list[Alternative] = []
        resource_span: Span | None = None
        fields: Iterator[ast.Field] = ast.one_by_one(declaration.fields)
        for field in fields:
            match field:
                case ast.Duration(value):
                    duration = self._duration(field, ast.number(value))
                case ast.ControlledResources(names, span):
                    resources, resource_span = self._resources(names), span
                case ast.Preconditions(predicates):
                    preconditions = self._parts(predicates, "a precondition")[0]
                case ast.NominalEffects(predicates, span):
                    nominal = self._nominal(predicates, name, span)
                case ast.AlternativeEffects(predicates, span):
                    alternatives.extend(self._alternative(predicates, name, span))
        written = tuple(alternatives)
        span = declaration.name.span
        return Action(name, duration, resources, preconditions, nominal, written, span, resource_span)

    def _once_each(self, declaration: ast.ActionDeclaration) -> None:
        first: dict[str, Span] = {}
        fields: Iterator[ast.Field] = ast.one_by_one(declaration.fields)
        for field in fields:
            title = _FIELDS.get(type(field))
            if title is None:
                continue
            if title in first:
                self._findings.add(
                    Code.TUM303,
                    f"the action {quoted(declaration.name.text)} has two fields `{title}`",
                    field.span,
                    "join them into one" if title != "duration:" else "remove one",
                    (Note("the first one is here", first[title]),),
                )
            first.setdefault(title, field.span)

    def _duration(self, field: ast.Duration, value: int) -> int:
        if not 0 <= value <= MAX_DURATION:
            self._findings.add(
                Code.TUM309,
                f"the duration is {value}; it has to be from 0 to {MAX_DURATION:,}",
                field.span,
                "durations are whole numbers of a unit of your choice",
            )
        return value

    def _resources(self, names: tuple[ast.Name, ...]) -> frozenset[int]:
        first: dict[str, Span] = {}
        for name in names:
            if name.text in first:
                notes = (Note("it is listed first here", first[name.text]),)
                self._findings.add(Code.TUM328, f"{quoted(name.text)} is listed twice", name.span, "remove one", notes)
            first.setdefault(name.text, name.span)
        found = (self._predicates.named(name, "resource") for name in dict.fromkeys(names))
        return frozenset(declared.number for declared in found if declared is not None)

    def _parts(self, predicates: tuple[ast.Predicate, ...], where: str) -> tuple[tuple[Rule, ...], bool]:
        """The predicates of a list, and whether all of them are right."""
        self._predicates.look_for_values(predicates)
        found = [self._predicates.rule(each, where) for each in predicates]
        right = tuple(each for each in found if each is not None)
        return right, len(right) == len(found)

    def _nominal(self, predicates: tuple[ast.Predicate, ...], action: str, span: Span) -> Assignment:
        parts, right = self._parts(predicates, "an effect")
        conditional = any(isinstance(each, ast.Implication) for each in predicates)
        return (self._effects.nominal(parts, action, span, conditional) if right else None) or ()

    def _alternative(self, predicates: tuple[ast.Predicate, ...], action: str, span: Span) -> list[Alternative]:
        parts, right = self._parts(predicates, "an effect")
        outcomes = self._effects.alternative(parts, action, span) if right else None
        return [] if outcomes is None else [Alternative(outcomes, self._text(predicates), span)]

    def _text(self, predicates: Sequence[ast.Predicate]) -> str:
        if not predicates:
            return "none"
        first, last = predicates[0].span, predicates[-1].span
        if not isinstance(first, CopySpan) or not isinstance(last, CopySpan):
            return self._excerpts.of(Span(first.line, first.column, last.end_line, last.end_column))
        return self._excerpts.of(CopySpan(first.line, first.column, last.end_line, last.end_column, first.parameters))
