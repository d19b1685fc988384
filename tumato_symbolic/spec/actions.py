"""Actions with their fields resolved: duration, resources, preconditions, effects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tumato_symbolic.diagnostics import Code, Note, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.spec.cases import Cases, Unfinished
from tumato_symbolic.spec.clauses import NO_EFFECTS, Clauses, ClauseSet, joined
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
        self._clauses = Clauses(names, predicates, findings)

    def resolve(self) -> tuple[Action | Unfinished, ...]:
        """Every action; what is in error is left out of it, and reported. `cases` makes what is unfinished."""
        return tuple(self._action(each) for each in self._names.actions)

    def cases(self, unfinished: tuple[Action | Unfinished, ...], assumptions: tuple[Rule, ...]) -> tuple[Action, ...]:
        """Every action, those with clauses by their cases."""
        cases = Cases(self._names.variables, assumptions, self._effects, self._findings)
        found = (cases.of(each) if isinstance(each, Unfinished) else (each,) for each in unfinished)
        return tuple(action for actions in found for action in actions)

    def _action(self, declaration: ast.ActionDeclaration) -> Action | Unfinished:
        name = declaration.name.text
        conditional = any(map(_is_conditional, declaration.fields))
        sets: list[ClauseSet | None] = []
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
                case ast.ControlledResources(names, span=span):
                    resources, resource_span = self._resources(names), span
                case ast.Preconditions(predicates):
                    preconditions = self._parts(predicates, "a precondition")[0]
                case ast.NominalEffects() | ast.AlternativeEffects() if conditional:
                    sets.append(self._clauses.set_of(field, self._text((*field.effects, *field.clauses))))
                case ast.NominalEffects(effects, span=span):
                    nominal = self._nominal(effects, name, span)
                case ast.AlternativeEffects(effects, span=span):
                    alternatives.extend(self._alternative(effects, name, span))
        written = tuple(alternatives)
        span = declaration.name.span
        action = Action(name, duration, resources, preconditions, nominal, written, span, resource_span)
        right = [each for each in sets if each is not None]
        if not conditional or len(right) < len(sets):
            return action
        if not any(isinstance(field, ast.NominalEffects) for field in declaration.fields):
            right.insert(0, NO_EFFECTS)
        return Unfinished(action, tuple(sorted(right, key=lambda each: not each.is_nominal)))

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

    def _parts(self, predicates: Sequence[ast.Effect], where: str) -> tuple[tuple[Rule, ...], bool]:
        """The predicates of a list, and whether all of them are right."""
        written = tuple(each for each in predicates if not isinstance(each, ast.Change))
        self._predicates.look_for_values(written)
        found = [self._predicates.rule(each, where) for each in written]
        right = tuple(each for each in found if each is not None)
        return right, len(right) == len(found)

    def _nominal(self, predicates: tuple[ast.Effect, ...], action: str, span: Span) -> Assignment:
        parts, right = self._parts(predicates, "an effect")
        conditional = any(isinstance(each, ast.Implication) for each in predicates)
        return (self._effects.nominal(parts, action, span, conditional) if right else None) or ()

    def _alternative(self, predicates: tuple[ast.Effect, ...], action: str, span: Span) -> list[Alternative]:
        parts, right = self._parts(predicates, "an effect")
        outcomes = self._effects.alternative(parts, action, span) if right else None
        return [] if outcomes is None else [Alternative(outcomes, self._text(predicates), span)]

    def _text(self, parts: Sequence[ast.Effect | ast.Clause | ast.Copies]) -> str:
        span = joined(parts)
        return "none" if span is None else self._excerpts.of(span)


def _is_conditional(field: ast.Field | ast.Copies) -> bool:
    """Whether what a set of effects does depends on the state in which the action starts."""
    if not isinstance(field, ast.NominalEffects | ast.AlternativeEffects):
        return False
    return bool(field.clauses) or any(isinstance(effect, ast.Change) for effect in field.effects)
