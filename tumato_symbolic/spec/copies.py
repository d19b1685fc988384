"""Copies and quantifiers written out: a tree in which each copy stands for itself (`docs/language.md`).

What a copy holds has a `CopySpan`: its place in the text, and the parameters that it was made with.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from msgspec.structs import replace

from tumato_symbolic.diagnostics import Code, CopySpan, Span
from tumato_symbolic.diagnostics.wording import listed, quoted
from tumato_symbolic.spec.collector import Findings
from tumato_symbolic.spec.numbers import is_right
from tumato_symbolic.spec.parameters import (
    BRACES,
    MAX_COMBINATIONS,
    Binding,
    Combinations,
    CopyError,
    Scope,
    bindings,
    combinations,
    domain_of,
    filled,
    too_many,
)
from tumato_symbolic.spec.predicates import MAX_TERMS_IN_ALL
from tumato_symbolic.syntax import ast

MAX_DECLARATIONS = 100_000
"""The most declarations, fields, rules, goals and settings of a text, copies counted one by one."""

_DECLARATIONS, _COMBINATIONS, _TERMS = range(3)
"""What is counted."""

_LIMITS = (MAX_DECLARATIONS, MAX_COMBINATIONS, MAX_TERMS_IN_ALL)

_ENTRIES = (
    *(ast.VariableDeclaration, ast.AliasDefinition, ast.NamedList, ast.ResourceDeclaration, ast.ActionDeclaration),
    *(ast.Duration, ast.ControlledResources, ast.Preconditions, ast.NominalEffects, ast.AlternativeEffects, ast.Clause),
    *(ast.SimpleGoal, ast.ConditionalGoal, ast.GoalList),
    *(ast.Severity, ast.MaxPlanLength, ast.EffectOrdering, ast.Restoration, ast.PreconditionsHold),
)
_RULES = (ast.ReactionRules, ast.StateRules, ast.Assumptions, ast.Start)
_NOT_RULES = (*_ENTRIES, ast.Copies)
_WITH_NUMBERS = (ast.Duration, ast.MaxPlanLength, ast.Change)
_NUMBER_SLOTS = {"value", "other", "low", "high", "values", "items"}
"""Where a number may stand for a name."""


def written_out(
    tree: ast.Specification, findings: Findings, lost: frozenset[str] = frozenset()
) -> ast.Specification | None:
    """The tree without copies and quantifiers; None, and reports, where they cannot be made.

    Parameters whose names were lost in a passage that could not be read are not reported as unknown.
    """
    copier = _Copier(tree, findings, lost)
    if not copier.is_right():
        return None
    try:
        copier.count(tree, {}, 1)
        found: ast.Specification = copier.node(tree, {}, ())
    except CopyError:
        return None
    return found


def copies_in(node: object) -> bool:
    """Whether there are copies or quantifiers below a node."""
    if isinstance(node, tuple):
        return any(copies_in(each) for each in node)
    if isinstance(node, ast.Copies | ast.Quantifier):
        return True
    return isinstance(node, ast.Node) and any(copies_in(getattr(node, each)) for each in node.__struct_fields__)


class _Copier:
    """One pass that checks the headers, one that counts, and one that makes the copies."""

    def __init__(self, tree: ast.Specification, findings: Findings, lost: frozenset[str]) -> None:
        self._tree = tree
        self._lost = lost
        self._findings = findings
        self._lists = _named_lists(tree)
        self._combinations: dict[int, Combinations] = {}
        self._scopes: dict[int, Scope] = {}
        self._varying: set[int] = set()
        self._made = [0, 0, 0]

    def is_right(self) -> bool:
        """Whether every header and every name in braces is right; reports what is not."""
        right = [domain_of(each.items, self._findings) is not None for each in self._lists.values()]
        return all(right) and self._check(self._tree, {}, set())

    def _check(self, node: object, scope: Scope, used: set[str]) -> bool:
        """Look at everything below a node; `used` gathers the parameters that are named."""
        if isinstance(node, ast.Name):
            return (
                self._is_known(node, scope, used) if "{" in node.text else not scope or is_right(node, self._findings)
            )
        if isinstance(node, tuple):
            return all([self._check(each, scope, used) for each in node])  # noqa: C419 - all are looked at
        if isinstance(node, ast.Copies | ast.Quantifier):
            return self._check_header(node, scope, used)
        if isinstance(node, ast.Node):
            return all([self._check(getattr(node, each), scope, used) for each in node.__struct_fields__])  # noqa: C419 - all are looked at
        return True

    def _is_known(self, name: ast.Name, scope: Scope, used: set[str]) -> bool:
        named = [braces[1] for braces in BRACES.finditer(name.text)]
        used.update(named)
        unknown = [each for each in named if each not in scope]
        if not unknown:
            return True
        if unknown[0] in self._lost:
            return False
        known = f"the parameters are {listed(list(scope))}" if scope else "braces stand inside `for` … `end for`"
        self._findings.add(Code.TUM201, f"there is no parameter {quoted(unknown[0])}", name.span, known)
        return False

    def _check_header(self, node: ast.Copies | ast.Quantifier, scope: Scope, used: set[str]) -> bool:
        found = combinations(node.header, scope, self._lists, self._findings)
        if found is None:
            return False
        inner = {**scope, **dict(zip(found.names, found.domains, strict=True))}
        self._combinations[id(node)], self._scopes[id(node)] = found, inner
        here = {side.name.text for each in node.header.conditions for side in (each.left, each.right)} & inner.keys()
        if here & scope.keys():
            self._varying.add(id(node))
        right = self._check(node.entries if isinstance(node, ast.Copies) else node.body, inner, here)
        for parameter in node.header.parameters:
            if parameter.name.text not in here and right:
                message = f"nothing uses the parameter {quoted(parameter.name.text)}"
                self._findings.add(Code.TUM329, message, parameter.name.span, "remove it, or use it in braces")
        used |= here - set(found.names)
        return right

    def count(self, node: object, binding: Binding, times: int) -> None:
        """Count what a node becomes, made so many times. Raises `CopyError`, and reports, where it is too much."""
        if isinstance(node, tuple):
            for each in node:
                self.count(each, binding, times)
        elif isinstance(node, ast.Copies | ast.Quantifier):
            self._count_copies(node, binding, times)
        elif isinstance(node, _ENTRIES):
            self._add(_DECLARATIONS, times, node)
            self._count_parts(node, binding, times)
        elif isinstance(node, _RULES):
            self._add(_DECLARATIONS, times * _rules_in(getattr(node, node.__struct_fields__[0])), node)
            self._count_parts(node, binding, times)
        elif isinstance(node, ast.Node) and not isinstance(node, ast.Name | ast.Range):
            self._add(_TERMS, times * (2 if isinstance(node, ast.Implication) else 1), node)
            self._count_parts(node, binding, times)

    def _count_parts(self, node: ast.Node, binding: Binding, times: int) -> None:
        for each in node.__struct_fields__:
            self.count(getattr(node, each), binding, times)

    def _count_copies(self, node: ast.Copies | ast.Quantifier, binding: Binding, times: int) -> None:
        found = self._combinations[id(node)]
        self._add(_COMBINATIONS, times * found.size, node.header)
        made = list(bindings(found, binding, self._scopes[id(node)], self._findings))
        if not made:
            self._findings.add(Code.TUM330, "no combination satisfies these conditions", node.header.span, _NO_COPY)
        if isinstance(node, ast.Copies):
            self._add(_DECLARATIONS, times * len(made) * _rules_in(node.entries), node.header)
        elif node.kind == "exactly one":
            times *= len(made)
        body = node.entries if isinstance(node, ast.Copies) else node.body
        if self._varies(body):
            for each in made:
                self.count(body, each, times)
        elif made:
            self.count(body, made[0], times * len(made))

    def _varies(self, node: object) -> bool:
        """Whether conditions further in depend on parameters further out."""
        if not self._varying or isinstance(node, ast.Name):
            return False
        if isinstance(node, tuple):
            return any(self._varies(each) for each in node)
        if id(node) in self._varying:
            return True
        return isinstance(node, ast.Node) and any(self._varies(getattr(node, each)) for each in node.__struct_fields__)

    def _add(self, what: int, number: int, place: Any) -> None:  # noqa: ANN401 - whatever has a span
        self._made[what] += number
        limit = _LIMITS[what]
        if self._made[what] <= limit:
            return
        if what == _COMBINATIONS:
            too_many(place, self._findings)
        else:
            noun = "declarations, rules and goals" if what == _DECLARATIONS else "terms of predicates"
            message = f"with its copies, the specification has more than {limit:,} {noun}"
            self._findings.add(Code.TUM311, message, place.span, "make fewer copies")
        raise CopyError

    def node(self, node: Any, binding: Binding, own: tuple[tuple[str, str], ...], numeric: bool = False) -> Any:  # noqa: ANN401
        """What a node becomes under a binding; `own` is the binding as messages show it."""
        if isinstance(node, Span):
            return node if not own else CopySpan(node.line, node.column, node.end_line, node.end_column, own)
        if isinstance(node, tuple):
            return tuple(self._members(node, binding, own, numeric))
        if isinstance(node, ast.Name):
            place = self.node(node.span, binding, own)
            if "{" not in node.text:
                return ast.Name(node.text, span=place)
            return ast.Name(filled(ast.Name(node.text, span=place), binding, numeric, self._findings), span=place)
        if isinstance(node, ast.Quantifier):
            return self._quantified(node, binding, own)
        if isinstance(node, ast.Node):
            return type(node)(**{each: self._part(node, each, binding, own) for each in node.__struct_fields__})
        return node

    def _part(self, node: ast.Node, slot: str, binding: Binding, own: tuple[tuple[str, str], ...]) -> Any:  # noqa: ANN401
        part = getattr(node, slot)
        if isinstance(part, ast.Name) and slot == "value" and isinstance(node, _WITH_NUMBERS):
            return self._number(part, binding, own)
        return self.node(part, binding, own, slot in _NUMBER_SLOTS)

    def _number(self, name: ast.Name, binding: Binding, own: tuple[tuple[str, str], ...]) -> int:
        found: ast.Name = self.node(name, binding, own, numeric=True)
        if not found.text.lstrip("-").isdigit():
            message = f"{quoted(found.text)}, which {quoted(name.text)} becomes, is not a whole number"
            self._findings.add(Code.TUM114, message, found.span)
            raise CopyError
        return int(found.text)

    def _members(
        self, nodes: Iterable[Any], binding: Binding, own: tuple[tuple[str, str], ...], numeric: bool
    ) -> Iterator[Any]:
        for each in nodes:
            if not isinstance(each, ast.Copies):
                yield self.node(each, binding, own, numeric)
                continue
            for inner in self._bindings(each, binding):
                yield from self._members(each.entries, inner, tuple(inner.items()), numeric)

    def _bindings(self, node: ast.Copies | ast.Quantifier, outer: Binding) -> Iterator[Binding]:
        return bindings(self._combinations[id(node)], outer, self._scopes[id(node)], self._findings)

    def _quantified(self, node: ast.Quantifier, binding: Binding, own: tuple[tuple[str, str], ...]) -> ast.Predicate:
        span = self.node(node.span, binding, own)
        copies = [self.node(node.body, inner, tuple(inner.items())) for inner in self._bindings(node, binding)]
        if not copies:
            return ast.Truth(node.kind == "all", span=span)
        if len(copies) == 1:
            only: ast.Predicate = replace(copies[0], span=span)
            return only
        if node.kind == "all":
            return ast.Conjunction(tuple(copies), span=span)
        if node.kind == "some":
            return ast.Disjunction(tuple(copies), span=span)
        denied = [ast.Negation(each, span=each.span) for each in copies]
        return ast.Disjunction(
            tuple(
                ast.Conjunction((each, *denied[:place], *denied[place + 1 :]), span=each.span)
                for place, each in enumerate(copies)
            ),
            span=span,
        )


def _rules_in(entries: tuple[object, ...]) -> int:
    return sum(not isinstance(each, _NOT_RULES) for each in entries)


_NO_COPY = "nothing is copied; correct them, or remove this"


def _named_lists(tree: ast.Specification) -> dict[str, ast.NamedList]:
    found: dict[str, ast.NamedList] = {}
    for block in tree.blocks:
        for each in block.definitions if isinstance(block, ast.Aliases) else ():
            if isinstance(each, ast.NamedList):
                found.setdefault(each.name.text, each)
    return found
