"""Predicates with names resolved and aliases expanded, and how large they may be."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, CopySpan, Note, Span
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.spec.alias_uses import Cycle, definitions, mentioned, reachable
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.comparisons import Comparisons, ValuePredicate
from tumato_symbolic.spec.formula import FALSE, TRUE, And, Executing, Formula, Iff, Not, Or
from tumato_symbolic.spec.names import Declared, Kind, Names, article
from tumato_symbolic.spec.specification import Rule
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.excerpts import Excerpts

MAX_DEPTH = 100
"""The most levels of a formula with its aliases expanded; an implication counts as two."""

MAX_TERMS = 100_000
"""The most atoms and operators of one predicate with its aliases expanded."""

MAX_TERMS_IN_ALL = 1_000_000
"""The same, for all predicates of a specification together."""

_NONE = {
    "an effect": "`none` stands alone: an outcome without change is a line of its own, `alternative effects: none`",
    "a precondition": "leave it out",
    "a list of resources": "leave it out",
}
"""The way out where `none` is one of several."""


class Mention(Struct, frozen=True):
    """Where a predicate says `executing`: `place` is in the predicate, `origin` in the alias that it came through."""

    place: Span
    origin: Span | None


class Resolved(Struct, frozen=True):
    """A formula, its size, and its first `executing`."""

    formula: Formula
    terms: int
    depth: int
    executing: Mention | None


class Predicates:
    """Resolves predicates one by one; remembers the aliases and which names were used."""

    def __init__(self, names: Names, excerpts: Excerpts, findings: Findings, lost: frozenset[str]) -> None:
        self._names = names
        self._excerpts = excerpts
        self._findings = findings
        self._lost = lost
        self._comparisons = Comparisons(names, self.named, findings, lost, MAX_TERMS)
        self._aliases: dict[int, Resolved | None] = {}
        self._terms = 0
        self._written = 0
        self._gave_up = False
        self._meant: dict[Span, str | None] = {}
        self._where: str | None = None
        self.used_aliases: set[int] = set()
        self.used_variables: set[int] = set()
        self._uses = tuple(mentioned(each.predicate, names) for each in names.aliases)
        self._define_aliases()

    def rule(self, predicate: ast.Predicate, no_executing_in: str | None) -> Rule | None:
        """A predicate of the user with its text; None where it is in error.

        `no_executing_in` names the place where `executing` has no meaning, or is None where it has one.
        """
        self._where = no_executing_in
        resolved = self._resolve(predicate)
        self.used_aliases |= reachable(mentioned(predicate, self._names), self._uses, self.used_aliases)
        if resolved is None:
            return None
        self._terms += resolved.terms
        if self._terms > MAX_TERMS_IN_ALL:
            self._too_many(predicate.span)
            return None
        if no_executing_in is not None and resolved.executing is not None:
            self._misplaced(resolved.executing, no_executing_in)
            return None
        return Rule(resolved.formula, self._excerpts.of(predicate.span), predicate.span)

    def named(self, name: ast.Name, kind: Kind) -> Declared | None:
        """The declaration of a name that has to be of one kind; None, and a report, where it is not."""
        declared = self._names.table.get(name.text)
        if declared is not None and declared.kind == kind:
            if kind == "state variable":
                self.used_variables.add(declared.number)
            return declared
        if declared is not None:
            self._findings.add(
                Code.TUM207,
                f"{quoted(name.text)} is not {article(kind)} but {article(declared.kind)}",
                name.span,
                self._instead(name.text, declared.kind, kind),
                (Note("it is declared here", declared.span),),
            )
        elif name.text not in self._lost:
            self._unknown(name, kind)
        return None

    def look_for_values(self, predicates: tuple[ast.Predicate, ...]) -> None:
        """Look through predicates that are joined for values that stand alone, as in `S is a OR b`."""
        if any(isinstance(each, ast.Reference) and each.name.text not in self._names.table for each in predicates):
            from tumato_symbolic.spec.lone_values import lone_values

            self._meant.update(lone_values(predicates, self._names))

    def _unknown(self, name: ast.Name, kind: Kind) -> None:
        if kind == "alias" and name.span in self._meant:
            meant = self._meant[name.span]
            if meant is not None:
                self._findings.add(Code.TUM201, f"there is no alias {quoted(name.text)}", name.span, f"write `{meant}`")
            return
        if isinstance(name.span, CopySpan) and name.text in dict(name.span.parameters):
            way_out = f"write `{{{name.text}}}`: parameters stand in braces"
            self._findings.add(Code.TUM201, f"there is no {kind} {quoted(name.text)}", name.span, way_out)
            return
        where = "a list of resources" if kind == "resource" else self._where
        if name.text in ("none", "nothing") and where in _NONE:
            way_out = _NONE[where] if name.text == "none" else "write `none`, which stands alone"
            self._findings.add(Code.TUM201, f"there is no {kind} {quoted(name.text)}", name.span, way_out)
            return
        near = self._findings.similar(name.text, self._names.of_kind(kind))
        if near is None and kind == "alias":
            near = self._findings.similar(name.text, self._names.of_kind("state variable"))
            if near is not None:
                near = f"{near} is …"
            owners = [number for number, values in enumerate(self._names.values) if name.text in values]
            if len(owners) == 1:
                near = f"{self._names.variables[owners[0]].name} is {name.text}"
        known = self._names.of_kind(kind)
        way_out = f"did you mean `{near}`?" if near else f"there is no {kind} at all"
        if near is None and known:
            way_out = f"the {'aliases' if kind == 'alias' else kind + 's'} are {listed(known)}"
        self._findings.add(Code.TUM201, f"there is no {kind} {quoted(name.text)}", name.span, way_out)

    def _instead(self, name: str, actual: Kind, wanted: Kind) -> str | None:
        if wanted == "alias" and actual == "state variable":
            values = self._names.variables[self._names.table[name].number].values
            return f"write `{name} is {values[0]}`" if values else None
        if wanted == "alias" and actual == "action":
            return f"write `executing {name}`"
        near = self._findings.similar(name, self._names.of_kind(wanted))
        return f"did you mean `{near}`?" if near else None

    def _resolve(self, predicate: ast.Predicate) -> Resolved | None:
        """A predicate of the text or a part of one; None, and a report, where it is in error.

        What is written out may be much longer than the text, also where nothing uses it: that is counted here.
        """
        if self._gave_up:
            return None
        self._written += 1
        if self._written > MAX_TERMS_IN_ALL:
            self._too_many(predicate.span)
            return None
        match predicate:
            case ast.Truth(value):
                return Resolved(TRUE if value else FALSE, 1, 1, None)
            case ast.Comparison() | ast.Difference() | ast.Membership() | ast.Ordering():
                return self._about_values(predicate)
            case ast.Quantifier():
                raise AssertionError("quantifiers are written out before names are resolved")
            case ast.Execution(action, span=span):
                declared = self.named(action, "action")
                return None if declared is None else Resolved(Executing(declared.number), 1, 1, Mention(span, None))
            case ast.Reference(name, span=span):
                return self._reference(name, span)
            case ast.Negation(operand):
                return self._combined(predicate, (operand,))
            case ast.Conjunction(operands) | ast.Disjunction(operands):
                self.look_for_values(operands)
                return self._combined(predicate, operands)
            case ast.Implication(left, right) | ast.Equivalence(left, right):
                return self._combined(predicate, (left, right))

    def _about_values(self, predicate: ValuePredicate) -> Resolved | None:
        found = self._comparisons.written(predicate)
        if found is None:
            return None
        self._written += found.terms - 1
        return self._within(Resolved(found.formula, found.terms, found.depth, None), predicate.span)

    def _within(self, resolved: Resolved, span: Span) -> Resolved | None:
        """What was resolved, unless it is too large: that is reported."""
        if resolved.terms <= MAX_TERMS and resolved.depth <= MAX_DEPTH:
            return resolved
        large = resolved.terms > MAX_TERMS
        what = f"has more than {MAX_TERMS:,} terms" if large else f"is more than {MAX_DEPTH} levels deep"
        self._too_large(span, f"{'with its aliases expanded' if self._uses else 'written out'}, this {what}")
        return None

    def _reference(self, name: ast.Name, span: Span) -> Resolved | None:
        declared = self.named(name, "alias")
        found = self._aliases.get(declared.number) if declared is not None else None
        if found is None or found.executing is None:
            return found
        return Resolved(
            found.formula, found.terms, found.depth, Mention(span, found.executing.origin or found.executing.place)
        )

    def _combined(self, predicate: ast.Predicate, operands: tuple[ast.Predicate, ...]) -> Resolved | None:
        """An operator over its operands; every operand is looked at, so that every mistake in them is found."""
        found = [self._resolve(each) for each in operands]
        parts = [each for each in found if each is not None]
        if len(parts) < len(found):
            return None
        terms, depth = 1 + sum(each.terms for each in parts), 1 + max(each.depth for each in parts)
        formulas = tuple(each.formula for each in parts)
        formula: Formula
        match predicate:
            case ast.Negation():
                formula = Not(formulas[0])
            case ast.Conjunction():
                formula = And(formulas)
            case ast.Disjunction():
                formula = Or(formulas)
            case ast.Implication():
                formula = Or((Not(formulas[0]), formulas[1]))
                self._written += 1
                terms, depth = terms + 1, max(parts[0].depth + 2, parts[1].depth + 1)
            case _:
                formula = Iff(*formulas)
        executing = next((each.executing for each in parts if each.executing), None)
        return self._within(Resolved(formula, terms, depth, executing), predicate.span)

    def _too_many(self, span: Span) -> None:
        """Report, once, that all predicates together are too large, and resolve no more of them."""
        if not self._gave_up:
            self._too_large(span, f"all predicates together have more than {MAX_TERMS_IN_ALL:,} terms")
            self._gave_up = True

    def _too_large(self, span: Span, message: str) -> None:
        copies = "copies and comparisons are written out; use shorter lists and ranges"
        aliases = "aliases that use aliases grow quickly; use fewer of them"
        self._findings.add(Code.TUM308, message, span, aliases if self._uses else copies)

    def _misplaced(self, mention: Mention, where: str) -> None:
        notes = (Note("the alias says `executing` here", mention.origin),) if mention.origin else ()
        message = "this alias says `executing`, which" if mention.origin else "`executing`"
        self._findings.add(
            Code.TUM304,
            f"{message} has no meaning in {where}",
            mention.place,
            "`executing` belongs in reaction rules and goal bodies",
            notes,
        )

    def _define_aliases(self) -> None:
        """Resolve every alias after those that it uses; those that are defined by themselves stand for nothing."""
        for found in definitions(self._uses):
            if isinstance(found, Cycle):
                self._aliases |= dict.fromkeys(found.aliases)
                self._circular(found.aliases)
            else:
                self._aliases[found] = self._resolve(self._names.aliases[found].predicate)

    def _circular(self, cycle: Sequence[int]) -> None:
        names = [self._names.aliases[each].name for each in cycle]
        around = " → ".join(quoted(name.text) for name in [*names[:9], names[0]])
        self._findings.add(
            Code.TUM206,
            f"the alias {quoted(names[0].text)} is defined by itself: {around}"
            if len(names) > 1
            else f"the alias {quoted(names[0].text)} is defined by itself",
            names[0].span,
            "an alias may use other aliases, never itself",
            tuple(Note(f"{quoted(name.text)} is part of the cycle", name.span) for name in names[1:9]),
        )
