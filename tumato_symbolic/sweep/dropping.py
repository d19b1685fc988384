"""Variants without one element: a rule, a precondition, an alternative or an assumption."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Source, Span
from tumato_symbolic.sweep.tree import below
from tumato_symbolic.sweep.variants import Change, Variant, numbered
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.edits import Edit
from tumato_symbolic.syntax.excerpts import Excerpts
from tumato_symbolic.syntax.leaving_out import places_of, without_entry, without_line, without_member
from tumato_symbolic.syntax.parser import read_terminals

Dropped: TypeAlias = tuple[Change, Edit]
"""What is left out, and how."""

RULES: dict[type[ast.Block], str] = {
    ast.ReactionRules: "reaction rule",
    ast.StateRules: "state rule",
    ast.Assumptions: "assumption",
}
"""The blocks of predicates that are elements, with what one is called."""


def dropped(source: Source) -> tuple[Variant, ...]:
    """A variant without each element, in the order of the text; what stands in copies is left out of all of them."""
    text = Written(source)
    found = sorted(text.elements(), key=lambda each: (each[1].span.line, each[1].span.column))
    return numbered([((change,), (edit,)) for change, edit in found])


class Written:
    """A specification as it is written, entries of which are left out."""

    def __init__(self, source: Source) -> None:
        parsed, self.tokens, _ = read_terminals(source)
        assert parsed.tree is not None, "a specification without errors has a tree"
        self.tree, self.excerpts, self.lines = parsed.tree, Excerpts(source), source.text.split("\n")
        self._places = places_of(self.tokens)

    def elements(self) -> Iterator[Dropped]:
        """Every rule, precondition, alternative and assumption."""
        for block in self.tree.blocks:
            if type(block) in RULES:
                for predicate in predicates_in(block):
                    yield self.without_entry(RULES[type(block)], predicate.span)
        for action in below(self.tree, ast.ActionDeclaration):
            for field in below(action, ast.Preconditions):
                for predicate in field.predicates:
                    yield self.without_member(f"precondition of {action.name.text}", predicate.span)
            for entry in below(action, ast.AlternativeEffects):
                yield self.without_alternative(action, entry)

    def without_line(self, what: str, span: Span) -> Dropped:
        """What stands at a span is left out, with its lines."""
        return self.changed(what, span, None), without_line(self.lines, span)

    def without_alternative(self, action: ast.ActionDeclaration, entry: ast.AlternativeEffects) -> Dropped:
        """An alternative is left out with its clauses."""
        change, edit = self.without_line(f"alternative of {action.name.text}", entry.span)
        return replace(change, before=self.excerpts.of(entry.span).partition(":")[2].strip()), edit

    def without_entry(self, what: str, span: Span) -> Dropped:
        """A predicate is left out with its keyword."""
        return self.changed(what, span, None), without_entry(
            self.lines, self.tokens, self._places[span.line, span.column], span
        )

    def without_member(self, what: str, span: Span) -> Dropped:
        """A member of a list is left out with a comma."""
        return self.changed(what, span, None), without_member(self.tokens, self._places[span.line, span.column], span)

    def changed(self, what: str, span: Span, after: str | None) -> Change:
        """That something else stands at a span, or nothing."""
        return Change(what, self.excerpts.of(span), after, span.line, span.column)


def predicates_in(block: ast.Block) -> Iterator[ast.Predicate]:
    """The predicates of a block of rules, copies being looked into."""
    yield from _entries(getattr(block, block.__struct_fields__[0]))


def _entries(entries: tuple[ast.Entry, ...]) -> Iterator[ast.Predicate]:
    for each in entries:
        if isinstance(each, ast.Copies):
            yield from _entries(each.entries)
        elif not isinstance(each, ast.Severity):
            yield each  # type: ignore[misc]  # blocks of rules hold nothing else
