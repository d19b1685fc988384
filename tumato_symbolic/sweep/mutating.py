"""Variants with one small change each, such as a person might make by mistake: mutations.

What is changed are values, comparisons, connectives and lists in effects, preconditions, rules, assumptions, goals and
aliases; resources that are controlled; the order of goals, and the plan bound. Durations are left alone: they choose
between decisions that are all as right.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Literal, TypeAlias

from tumato_symbolic.diagnostics import Source, Span
from tumato_symbolic.sweep.dropping import RULES, Written, predicates_in
from tumato_symbolic.sweep.tree import below
from tumato_symbolic.sweep.variants import Change, Variant, numbered
from tumato_symbolic.sweep.wrong_predicates import Domains, wrong_effects, wrong_predicates
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.edits import Edit

Mutation: TypeAlias = tuple[Change, tuple[Edit, ...]]
"""What is changed, and how."""


def mutated(source: Source, number: int | Literal["all"], seed: int) -> tuple[tuple[Variant, ...], int]:
    """A variant for each of so many mutations, in the order of the text, and how many there are to draw from.

    Which ones are drawn depends on `seed`.
    """
    found = mutations(source)
    possible = len(found)
    if number != "all" and number < len(found):
        drawn = sorted(range(len(found)), key=lambda place: hashlib.sha256(f"{seed} {place}".encode()).digest())
        found = [found[place] for place in sorted(drawn[:number])]
    return numbered([((change,), edits) for change, edits in found]), possible


def mutations(source: Source) -> list[Mutation]:
    """All of them, in the order of the text, none twice."""
    text = _Mutating(source)
    found = {edits: change for change, edits in text.all()}
    return sorted(((change, edits) for edits, change in found.items()), key=lambda each: _place(each[1]))


def _place(edits: tuple[Edit, ...]) -> tuple[int, int, int, int, str]:
    span = edits[0].span
    return span.line, span.column, span.end_line, span.end_column, edits[0].text


class _Mutating:
    """The mutations of one specification."""

    def __init__(self, source: Source) -> None:
        self._text = Written(source)
        self._domains = Domains(self._text.tree)

    def all(self) -> Iterator[Mutation]:
        """Block by block."""
        for action in below(self._text.tree, ast.ActionDeclaration):
            yield from self._action(action)
        for block in self._text.tree.blocks:
            if type(block) in RULES or isinstance(block, ast.Start):
                yield from self._rules(block)
        for alias in below(self._text.tree, ast.AliasDefinition):
            yield from self._condition(f"alias {alias.name.text}", alias.predicate)
        for goals in below(self._text.tree, ast.GoalList):
            yield from self._goals(goals)
        for goal in below(self._text.tree, ast.SimpleGoal):
            yield from self._condition("goal", goal.predicate)
        for when in below(self._text.tree, ast.ConditionalGoal):
            yield from self._condition("condition of a goal", when.condition)
        for bound in below(self._text.tree, ast.MaxPlanLength):
            if isinstance(bound.value, int) and bound.value > 1:
                yield self._replaced("plan bound", bound.span, f"max_plan_length: {bound.value - 1}")

    def _action(self, action: ast.ActionDeclaration) -> Iterator[Mutation]:
        of = f"of {action.name.text}"
        for held in below(action, ast.ControlledResources):
            for name in held.names:
                yield self._one(self._text.without_member(f"resource {of}", name.span))
        for field in below(action, ast.Preconditions):
            yield from self._list(f"precondition {of}", field.predicates)
            for predicate in field.predicates:
                yield from self._condition(f"precondition {of}", predicate)
        for nominal in below(action, ast.NominalEffects):
            yield from self._effects(f"nominal effect {of}", nominal)
        for entry in below(action, ast.AlternativeEffects):
            yield self._one(self._text.without_alternative(action, entry))
            yield from self._effects(f"alternative effect {of}", entry)

    def _effects(self, what: str, field: ast.NominalEffects | ast.AlternativeEffects) -> Iterator[Mutation]:
        for effects in (field, *below(field.clauses, ast.Clause)):
            yield from self._list(what, effects.effects)
            for effect in effects.effects:
                for span, text in wrong_effects(effect, self._domains):
                    yield self._replaced(what, span, text)
            if isinstance(effects, ast.Clause):
                yield self._one(self._text.without_line(what, effects.span))
                yield from self._condition(f"condition of a {what}", effects.condition)

    def _rules(self, block: ast.Block) -> Iterator[Mutation]:
        what = RULES.get(type(block), "start")
        for predicate in predicates_in(block):
            yield self._one(self._text.without_entry(what, predicate.span))
            yield from self._condition(what, predicate)

    def _goals(self, goals: ast.GoalList) -> Iterator[Mutation]:
        members = [each for each in goals.members if not isinstance(each, ast.Copies)]
        if len(goals.members) > 1:
            yield from (self._one(self._text.without_line("goal", each.span)) for each in members)
        if goals.kind == "priority":
            for one, other in pairwise(members):
                texts = [_text_at(self._text.lines, each.span) for each in (one, other)]
                change = self._text.changed("order of goals", one.span, f"{self._excerpt(other.span)}, before it")
                yield change, (Edit(one.span, texts[1]), Edit(other.span, texts[0]))

    def _condition(self, what: str, predicate: ast.Predicate) -> Iterator[Mutation]:
        for span, text in wrong_predicates(predicate, self._domains):
            yield self._replaced(what, span, text)

    def _list(self, what: str, members: Sequence[ast.Effect]) -> Iterator[Mutation]:
        yield from (self._one(self._text.without_member(what, each.span)) for each in members)

    def _replaced(self, what: str, span: Span, text: str) -> Mutation:
        return self._text.changed(what, span, text), (Edit(span, text),)

    def _one(self, dropped: tuple[Change, Edit]) -> Mutation:
        change, edit = dropped
        return change, (edit,)

    def _excerpt(self, span: Span) -> str:
        return self._text.excerpts.of(span)


def _text_at(lines: Sequence[str], span: Span) -> str:
    """The text of a span as it stands, comments and all."""
    found = list(lines[span.line - 1 : span.end_line])
    found[-1] = found[-1][: span.end_column - 1]
    found[0] = found[0][span.column - 1 :]
    return "\n".join(found)
