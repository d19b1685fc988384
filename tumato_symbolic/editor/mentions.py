"""Every name in a specification: what it stands for, where it is declared, and what is done with it where."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Final, Literal, NamedTuple, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import CopySpan, Source, Span
from tumato_symbolic.editor.parameters import parameter_places
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.copies import copies_in, written_out
from tumato_symbolic.spec.names import KINDS
from tumato_symbolic.syntax import Parsed, ast, parse

SymbolKind: TypeAlias = Literal["state variable", "value", "alias", "named list", "resource", "action", "parameter"]

Use: TypeAlias = Literal["declared", "read", "written", "needed", "executed"]
"""What is done with a symbol: an action needs resources, and rules and goals ask what is executed."""

MAX_RANGE: Final = 1_000
"""Of a longer range of values none is a symbol."""


class Symbol(NamedTuple):
    """What a name stands for; `of` is the state variable that has a value, and where a parameter is declared."""

    kind: SymbolKind
    name: str
    of: str = ""


class Mention(NamedTuple):
    """A symbol at a place: of a name among copies, one mention for each copy. `inside` is the entry that it is in."""

    symbol: Symbol
    span: Span
    use: Use
    inside: str


class Index(Struct, frozen=True, dict=True):
    """A text with its tree, copies written out where they can be, and all that is mentioned in it."""

    source: Source
    parsed: Parsed

    @cached_property
    def tree(self) -> ast.Specification:
        """The tree with copies written out, or, where they are wrong, as it stands."""
        tree = self.parsed.tree or ast.Specification(())
        if not copies_in(tree):
            return tree
        return written_out(tree, Findings(), self.parsed.lost) or tree

    @cached_property
    def mentions(self) -> tuple[Mention, ...]:
        """Every mention, in the order of the text but for named lists and parameters, which come last."""
        names = dict(_declared(self.tree))
        lists, parameters = _lists_used(self.parsed.tree, names), _parameters(self.parsed.tree)
        return (*_Walk(names).tree(self.tree), *lists, *parameters)

    @cached_property
    def of_symbol(self) -> Mapping[Symbol, tuple[Mention, ...]]:
        """The mentions of each symbol."""
        found: dict[Symbol, list[Mention]] = {}
        for each in self.mentions:
            found.setdefault(each.symbol, []).append(each)
        return {symbol: tuple(mentions) for symbol, mentions in found.items()}

    def at(self, line: int, column: int) -> list[Mention]:
        """The mentions around a place, or just before it; several where there are copies."""
        touching = [each for each in self.mentions if _touches(each.span, line, column)]
        shortest = min((each.span.end_column - each.span.column for each in touching), default=0)
        return [each for each in touching if each.span.end_column - each.span.column == shortest]

    def declarations(self, symbol: Symbol) -> tuple[Span, ...]:
        """Where a symbol is declared."""
        return tuple(each.span for each in self.of_symbol.get(symbol, ()) if each.use == "declared")

    def named(self, *kinds: SymbolKind) -> list[str]:
        """The names of all symbols of some kinds, in the order of their declarations."""
        return [symbol.name for symbol in self.of_symbol if symbol.kind in kinds and self.declarations(symbol)]

    def values(self, variable: str) -> list[str]:
        """The values of a state variable."""
        return [
            symbol.name
            for symbol in self.of_symbol
            if symbol.kind == "value" and symbol.of == variable and self.declarations(symbol)
        ]


def index(source: Source) -> Index:
    """Look at a text, which may have mistakes."""
    return Index(source, parse(source))


def _touches(span: Span, line: int, column: int) -> bool:
    return span.line == line and span.column <= column <= span.end_column


def _declared(node: object) -> Iterator[tuple[str, SymbolKind]]:
    """Every declared name with its kind."""
    if isinstance(node, tuple):
        for each in node:
            yield from _declared(each)
    elif type(node) in KINDS:
        yield node.name.text, KINDS[type(node)]  # type: ignore[attr-defined]
    elif isinstance(node, ast.Copies):
        yield from _declared(node.entries)
    elif isinstance(node, ast.Specification):
        yield from _declared(node.blocks)
    elif isinstance(node, ast.StateVector | ast.Aliases | ast.Resources | ast.Actions):
        yield from _declared(getattr(node, node.__struct_fields__[0]))


def _lists_used(tree: ast.Specification | None, names: Mapping[str, SymbolKind]) -> Iterator[Mention]:
    """Named lists, which are declared and used where nothing is written out."""
    waiting: list[object] = [tree] if tree is not None else []
    lists = {name for name, kind in _declared(tree) if kind == "named list"}
    while waiting:
        node = waiting.pop()
        if isinstance(node, tuple):
            waiting += node
        elif isinstance(node, ast.Parameter):
            for item in node.items:
                if isinstance(item, ast.Name) and item.text in lists and not node.braced:
                    yield Mention(Symbol("named list", item.text), item.span, "read", "copies")
        elif isinstance(node, ast.NamedList) and names.get(node.name.text) != "named list":
            yield Mention(Symbol("named list", node.name.text), node.name.span, "declared", f"`{node.name.text}`")
        elif isinstance(node, ast.Node) and not isinstance(node, ast.Name):
            waiting += [getattr(node, each) for each in node.__struct_fields__ if each != "span"]


def _parameters(tree: ast.Specification | None) -> Iterator[Mention]:
    for each in parameter_places(tree):
        symbol = Symbol("parameter", each.name, f"{each.declared.line}:{each.declared.column}")
        yield Mention(symbol, each.span, "declared" if each.span == each.declared else "read", "copies")


class _Walk:
    """One pass over a tree."""

    def __init__(self, names: Mapping[str, SymbolKind]) -> None:
        self._names = names

    def tree(self, tree: ast.Specification) -> Iterator[Mention]:
        """Every mention in it."""
        for block in tree.blocks:
            match block:
                case ast.StateVector(entries) | ast.Aliases(entries) | ast.Resources(entries) | ast.Actions(entries):
                    yield from self._entries(entries, "")
                case ast.ReactionRules(entries):
                    yield from self._entries(entries, "a reaction rule")
                case ast.StateRules(entries):
                    yield from self._entries(entries, "a state rule")
                case ast.Assumptions(entries):
                    yield from self._entries(entries, "an assumption")
                case ast.Start(entries):
                    yield from self._entries(entries, "a start condition")
                case ast.Goals(goals):
                    yield from self._entries((goals,), "a goal")

    def _entries(self, entries: Iterable[object], inside: str) -> Iterator[Mention]:
        for each in entries:
            match each:
                case ast.Copies(_, copied):
                    yield from self._entries(copied, inside)
                case ast.VariableDeclaration(name, values):
                    yield self._symbol("state variable", name, "declared", f"`{name.text}`")
                    yield from self._values(name.text, values, "declared", f"`{name.text}`")
                case ast.AliasDefinition(name, predicate):
                    yield self._symbol("alias", name, "declared", f"alias `{name.text}`")
                    yield from self._predicate(predicate, "read", f"alias `{name.text}`")
                case ast.NamedList(name):
                    yield self._symbol("named list", name, "declared", f"`{name.text}`")
                case ast.ResourceDeclaration(name):
                    yield self._symbol("resource", name, "declared", f"`{name.text}`")
                case ast.ActionDeclaration(name, fields):
                    yield self._symbol("action", name, "declared", f"action `{name.text}`")
                    yield from self._entries(fields, f"action `{name.text}`")
                case (
                    ast.ControlledResources()
                    | ast.Preconditions()
                    | ast.NominalEffects()
                    | ast.AlternativeEffects()
                    | ast.Clause()
                ):
                    yield from self._field(each, inside)
                case ast.SimpleGoal(predicate):
                    yield from self._predicate(predicate, "read", inside)
                case ast.ConditionalGoal(condition, goal):
                    yield from self._predicate(condition, "read", inside)
                    yield from self._entries((goal,), inside)
                case ast.GoalList(_, members):
                    yield from self._entries(members, inside)
                case _ if isinstance(each, ast.Predicate):
                    yield from self._predicate(each, "read", inside)

    def _field(self, field: ast.Field | ast.Clause, inside: str) -> Iterator[Mention]:
        match field:
            case ast.ControlledResources(names):
                yield from (self._symbol("resource", name, "needed", inside) for name in names)
            case ast.Preconditions(predicates):
                for predicate in predicates:
                    yield from self._predicate(predicate, "read", inside)
            case ast.NominalEffects() | ast.AlternativeEffects() | ast.Clause():
                yield from self._effects(field, inside)

    def _effects(
        self, effects: ast.NominalEffects | ast.AlternativeEffects | ast.Clause, inside: str
    ) -> Iterator[Mention]:
        if isinstance(effects, ast.Clause):
            yield from self._predicate(effects.condition, "read", inside)
        for each in effects.effects:
            if isinstance(each, ast.Change):
                yield self._symbol("state variable", each.variable, "written", inside)
                yield self._symbol("state variable", each.origin, "read", inside)
            else:
                yield from self._predicate(each, "written", inside)
        if not isinstance(effects, ast.Clause):
            yield from self._entries(effects.clauses, inside)

    def _predicate(self, predicate: ast.Predicate, use: Use, inside: str) -> Iterator[Mention]:
        match predicate:
            case ast.Comparison(variable, value) | ast.Difference(variable, value):
                yield self._symbol("state variable", variable, use, inside)
                yield from self._values(variable.text, (value,), use, inside)
            case ast.Membership(variable, items):
                yield self._symbol("state variable", variable, use, inside)
                yield from self._values(variable.text, items, use, inside)
            case ast.Ordering(variable, _, other):
                yield self._symbol("state variable", variable, use, inside)
                if self._names.get(other.text) == "state variable":
                    yield self._symbol("state variable", other, use, inside)
                else:
                    yield from self._values(variable.text, (other,), use, inside)
            case ast.Execution(action):
                yield self._symbol("action", action, "executed", inside)
            case ast.Reference(name):
                yield self._symbol(self._names.get(name.text, "alias"), name, use, inside)
            case ast.Negation(operand):
                yield from self._predicate(operand, use, inside)
            case ast.Conjunction(operands) | ast.Disjunction(operands):
                for each in operands:
                    yield from self._predicate(each, use, inside)
            case ast.Implication(left, right) | ast.Equivalence(left, right):
                yield from self._predicate(left, use, inside)
                yield from self._predicate(right, use, inside)
            case ast.Quantifier(_, _, body):
                yield from self._predicate(body, use, inside)

    def _values(self, variable: str, items: Iterable[ast.Item], use: Use, inside: str) -> Iterator[Mention]:
        for item in items:
            names = [item] if isinstance(item, ast.Name) else _names_in(item)
            for name in names:
                yield Mention(Symbol("value", name.text, variable), _in_text(name.span), use, inside)

    def _symbol(self, kind: SymbolKind, name: ast.Name, use: Use, inside: str) -> Mention:
        return Mention(Symbol(kind, name.text), _in_text(name.span), use, inside)


def _names_in(item: ast.Range) -> list[ast.Name]:
    """The values of a range, each standing for itself where the range is written."""
    try:
        low, high = int(item.low.text), int(item.high.text)
    except ValueError:
        return []
    return [ast.Name(str(value), span=item.span) for value in range(low, high + 1)] if high - low < MAX_RANGE else []


def _in_text(span: Span) -> Span:
    return span.in_text if isinstance(span, CopySpan) else span
