"""Sets of effects with clauses, their names resolved (`docs/semantics.md`, section 2)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, CopySpan, Note, Span
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.formula import TRUE, And, Formula, Is
from tumato_symbolic.spec.names import Names
from tumato_symbolic.spec.numbers import numbers_of
from tumato_symbolic.spec.predicates import Predicates
from tumato_symbolic.spec.specification import EffectSet
from tumato_symbolic.syntax import ast

MAX_CHANGE = 1_000_000_000
"""The most by which a relative effect changes a value."""


class Change(Struct, frozen=True):
    """A relative effect: `results[value]` is what a value becomes; at the values `clipped` it stays at its end."""

    variable: int
    results: tuple[int, ...]
    clipped: tuple[int, ...]
    rises: bool
    span: Span


class Clause(Struct, frozen=True):
    """Effects under a condition: `fixed` are predicates. The condition of what stands before all clauses is `TRUE`."""

    condition: Formula
    fixed: tuple[Formula, ...]
    changes: tuple[Change, ...]
    span: Span

    def written(self) -> Iterator[tuple[Formula, tuple[Formula, ...]]]:
        """The same with one clause for each value that a relative effect changes."""
        if self.fixed or not self.changes:
            yield self.condition, self.fixed
        for change in self.changes:
            for value, result in enumerate(change.results):
                here: Formula = Is(change.variable, value)
                condition = here if self.condition == TRUE else And((self.condition, here))
                yield condition, (Is(change.variable, result),)


class ClauseSet(Struct, frozen=True):
    """A set of effects: the first clause holds what stands before all others."""

    is_nominal: bool
    clauses: tuple[Clause, ...]
    text: str
    span: Span

    def written(self) -> EffectSet:
        """The set as the digest of a specification covers it."""
        base, *others = self.clauses
        relative = Clause(TRUE, (), base.changes, base.span).written() if base.changes else ()
        return EffectSet(base.fixed, (*relative, *(pair for clause in others for pair in clause.written())))


NO_EFFECTS = ClauseSet(True, (Clause(TRUE, (), (), ast.NOWHERE),), "none", ast.NOWHERE)
"""The nominal effects of an action that has none."""


def joined(nodes: Sequence[ast.Node]) -> Span | None:
    """From the first to the last of some nodes; None where there is none."""
    if not nodes:
        return None
    first, last = nodes[0].span, nodes[-1].span
    if isinstance(first, CopySpan) and isinstance(last, CopySpan):
        return CopySpan(first.line, first.column, last.end_line, last.end_column, first.parameters)
    return Span(first.line, first.column, last.end_line, last.end_column)


class Clauses:
    """Resolves clauses one by one."""

    def __init__(self, names: Names, predicates: Predicates, findings: Findings) -> None:
        self._names = names
        self._predicates = predicates
        self._findings = findings

    def set_of(self, field: ast.NominalEffects | ast.AlternativeEffects, text: str) -> ClauseSet | None:
        """A set of effects; None, and reports, where something in it is in error."""
        base = self._clause(TRUE, field.effects, joined(field.effects) or field.span)
        found = [base, *map(self._conditional, ast.one_by_one(field.clauses))]
        right = tuple(each for each in found if each is not None)
        is_nominal = isinstance(field, ast.NominalEffects)
        return ClauseSet(is_nominal, right, text, field.span) if len(right) == len(found) else None

    def _conditional(self, clause: ast.Clause) -> Clause | None:
        condition = self._predicates.rule(clause.condition, "the condition of an effect")
        found = self._clause(TRUE if condition is None else condition.formula, clause.effects, clause.span)
        return None if condition is None else found

    def _clause(self, condition: Formula, effects: Sequence[ast.Effect], span: Span) -> Clause | None:
        fixed: list[Formula] = []
        changes: list[Change] = []
        for effect in effects:
            if isinstance(effect, ast.Change):
                change = self._change(effect)
                changes += [] if change is None else [change]
            else:
                rule = self._predicates.rule(effect, "an effect")
                fixed += [] if rule is None else [rule.formula]
        right = len(fixed) + len(changes) == len(effects)
        return Clause(condition, tuple(fixed), tuple(changes), span) if right else None

    def _change(self, effect: ast.Change) -> Change | None:
        declared = self._predicates.named(effect.variable, "state variable")
        amount = ast.number(effect.value)
        if not 1 <= amount <= MAX_CHANGE:
            message = f"a value changes by 1 to {MAX_CHANGE:,}, not by {amount}"
            self._findings.add(Code.TUM318, message, effect.span, "leave the effect out where nothing changes")
            return None
        if declared is None or declared.number in self._names.unsettled:
            return None
        name = effect.variable.text
        if effect.origin.text != name:
            message = f"{quoted(name)} changes relative to another variable, {quoted(effect.origin.text)}"
            self._findings.add(
                Code.TUM318,
                message,
                effect.span,
                f"write `{name} is {name} {effect.sign} {amount}`, or one clause `when … : {name} is …` for each value",
            )
            return None
        values = self._names.variables[declared.number].values
        numbers = numbers_of(values)
        notes = (Note(f"{quoted(name)} is declared here", declared.span),)
        if numbers is None:
            message = f"{quoted(name)} has values that are not numbers"
            way_out = f"its values are {listed(values)}; write one clause `when {name} is …: {name} is …` for each"
            self._findings.add(Code.TUM318, message, effect.span, way_out, notes)
            return None
        step = amount if effect.sign == "+" else -amount
        places = {number: place for place, number in enumerate(numbers)}
        low, high = min(numbers), max(numbers)
        clipped = tuple(place for place, number in enumerate(numbers) if not low <= number + step <= high)
        results = tuple(places.get(min(max(number + step, low), high), -1) for number in numbers)
        if -1 in results:
            number = numbers[results.index(-1)]
            message = f"from {number}, {quoted(name)} would become {number + step}, which is none of its values"
            self._findings.add(Code.TUM318, message, effect.span, f"its values are {listed(values)}", notes)
            return None
        return Change(declared.number, results, clipped, step > 0, effect.span)
