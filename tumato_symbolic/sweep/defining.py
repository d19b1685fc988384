"""Variants by other values of what has a name: lists of ALIASES, and settings of CONFIG."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import product
from math import prod
from typing import Final, NoReturn, TypeAlias

from msgspec import Struct

from tumato_symbolic.diagnostics import Code, Diagnostic, Source, Span, UserError
from tumato_symbolic.diagnostics.wording import listed, nearest, quoted
from tumato_symbolic.spec.resolve import SETTINGS
from tumato_symbolic.sweep.tree import below
from tumato_symbolic.sweep.variants import Change, Variant, numbered
from tumato_symbolic.syntax import ast
from tumato_symbolic.syntax.edits import Edit, at
from tumato_symbolic.syntax.excerpts import Excerpts
from tumato_symbolic.syntax.leaving_out import places_of
from tumato_symbolic.syntax.parser import read_terminals

MOST = 100_000
"""The most variants of one sweep."""

_ITEM: Final = re.compile(r"[A-Za-z_][A-Za-z0-9_]*|[+-]?[0-9]{1,18}(\.\.[+-]?[0-9]{1,18})?")
_PARTS: Final = re.compile(r"\s*(\{[^{}]*\}|[^{},]*)\s*(?:,|$)")

_SETTINGS: Final[dict[str, tuple[str, ...]]] = {
    "max_plan_length": (),
    "effect_ordering": ("any", "first"),
    "restoration": ("one_step", "bounded", "fair"),
    "preconditions": ("at_start", "throughout"),
}
"""The settings with the values that they may have; of the first, numbers."""


class Definition(Struct, frozen=True):
    """`NAME=VALUE,…` as it was typed."""

    name: str
    values: tuple[str, ...]


def definition(text: str) -> Definition:
    """Read `NAME=VALUE,…`; a VALUE may be a list in braces. Raises `UserError` (TUM113)."""
    name, sign, values = text.partition("=")
    name = name.strip()
    if not sign or not values.strip():
        _fail(Code.TUM113, f"{quoted(text)} is not NAME=VALUE,…", "such as `-D max_plan_length=3,4,5`")
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
        _fail(
            Code.TUM113, f"{quoted(name)} is not a name", "a value of a named list, or a setting, is given by its name"
        )
    found = tuple(_values(name, values))
    twice = next((each for place, each in enumerate(found) if each in found[:place]), None)
    if twice is not None:
        _fail(Code.TUM203, f"the value {quoted(twice)} of {quoted(name)} is given twice", "remove one")
    return Definition(name, found)


def _values(name: str, text: str) -> Iterator[str]:
    place = 0
    while place < len(text) or text.endswith(","):
        part = _PARTS.match(text, place)
        if part is None:
            _wrong(name, text[place:].strip())
        items = part[1].strip().removeprefix("{").removesuffix("}").split(",")
        wrong = next((each.strip() for each in items if not _ITEM.fullmatch(each.strip())), None)
        if wrong is not None:
            _wrong(name, wrong)
        written = ", ".join(each.strip() for each in items)
        yield f"{{{written}}}" if part[1].startswith("{") else written
        if part.end() == len(text) and not part[0].endswith(","):
            return
        place = part.end()


def _wrong(name: str, text: str) -> NoReturn:
    if not text:
        _fail(Code.TUM113, f"a value of {quoted(name)} is missing", "separate values by single commas")
    help_ = "a value is a word, a number, a range `1..3`, or a list of these in braces, such as `{a, b}`"
    _fail(Code.TUM113, f"{quoted(text)} is no value for {quoted(name)}", help_)


def defined(source: Source, definitions: Sequence[Definition]) -> tuple[Variant, ...]:
    """A variant for each combination of values, the first name changing slowest.

    Raises `UserError` where a name stands for nothing that can be varied, or a setting cannot have a value.
    """
    names = [each.name for each in definitions]
    twice = next((each for place, each in enumerate(names) if each in names[:place]), None)
    if twice is not None:
        _fail(Code.TUM203, f"{quoted(twice)} is given twice", f"give all its values at once: -D {twice}=VALUE,VALUE")
    if prod(len(each.values) for each in definitions) > MOST:
        _fail(Code.TUM311, f"there are more than {MOST:,} combinations of values", "give fewer values")
    text = _Text(source)
    choices = [[text.with_value(each.name, value) for value in each.values] for each in definitions]
    return numbered([(tuple(change for change, _ in each), text.edits(each)) for each in product(*choices)])


class _Text:
    """A specification in which values are given to names."""

    def __init__(self, source: Source) -> None:
        parsed, self._tokens, _ = read_terminals(source)
        assert parsed.tree is not None, "a specification without errors has a tree"
        self._source, self._tree, self._excerpts = source, parsed.tree, Excerpts(source)
        self._lists = {each.name.text: each for each in below(self._tree, ast.NamedList)}
        self._settings: dict[str, ast.Setting] = {
            name: each for kind, name in SETTINGS.items() for each in below(self._tree, kind)
        }

    def edits(self, chosen: Sequence[tuple[Change, Edit | None]]) -> tuple[Edit, ...]:
        """The edits of changes that are made together."""
        found = [edit for _, edit in chosen if edit is not None]
        missing = [f"{change.name}: {change.after}" for change, edit in chosen if edit is None]
        return (*found, self._added(missing)) if missing else tuple(found)

    def with_value(self, name: str, value: str) -> tuple[Change, Edit | None]:
        """What is changed, and how, where a name has this value; no edit where a setting is to be added."""
        if name in self._lists:
            return self._with_items(self._lists[name], value)
        if name in _SETTINGS:
            return self._with_setting(name, value)
        raise self._unknown(name)

    def _with_items(self, node: ast.NamedList, value: str) -> tuple[Change, Edit]:
        first, last = node.items[0].span, node.items[-1].span
        span = Span(first.line, first.column, last.end_line, last.end_column)
        value = value if value.startswith("{") else f"{{{value}}}"
        before = f"{{{self._excerpts.of(span)}}}"
        change = Change("list", before, value, node.span.line, node.span.column, node.name.text)
        return change, Edit(span, value[1:-1])

    def _with_setting(self, name: str, value: str) -> tuple[Change, Edit | None]:
        choices = _SETTINGS[name]
        if choices and value not in choices:
            guess = nearest(value, choices)
            did_you_mean = f"did you mean {quoted(guess)}? " if guess else ""
            help_ = f"{did_you_mean}it may be {listed(choices, 'or')}"
            _fail(Code.TUM202, f"{quoted(name)} cannot be {quoted(value)}", help_)
        if not choices and not re.fullmatch(r"[1-9][0-9]*", value):
            _fail(Code.TUM310, f"{quoted(name)} cannot be {quoted(value)}", "it is a whole number from 1 on")
        node = self._settings.get(name)
        if node is None:
            return Change("setting", None, value, None, None, name), None
        before = self._excerpts.of(node.span).partition(":")[2].strip()
        change = Change("setting", before, value, node.span.line, node.span.column, name)
        return change, Edit(node.span, f"{name}: {value}")

    def _added(self, settings: Sequence[str]) -> Edit:
        """Settings that CONFIG does not have come first in it, or in a CONFIG of their own at the end."""
        lines = "".join(f"\n{each}" for each in settings)
        block = next((each for each in self._tree.blocks if isinstance(each, ast.Config)), None)
        if block is None:
            end = self._tokens[-1].span
            return Edit(at(end.end_line, end.end_column), f"\n\nBEGIN CONFIG{lines}\nEND CONFIG\n")
        begin = places_of(self._tokens)[block.span.line, block.span.column]
        after = self._tokens[begin + 1].span
        return Edit(at(after.end_line, after.end_column), lines)

    def _unknown(self, name: str) -> UserError:
        known = [*self._lists, *_SETTINGS]
        other = self._what_else(name)
        lists = f"the named lists are {listed(list(self._lists))}" if self._lists else "ALIASES names no list"
        ways_out = f"the settings are {listed(list(_SETTINGS))}; {lists}"
        if other is not None:
            return _error(Code.TUM207, f"{quoted(name)} is {other}, and not a named list or a setting", ways_out)
        guess = nearest(name, known)
        did_you_mean = f"did you mean {quoted(guess)}? " if guess else ""
        return _error(Code.TUM201, f"there is no named list or setting {quoted(name)}", f"{did_you_mean}{ways_out}")

    def _what_else(self, name: str) -> str | None:
        """What a name stands for that is not varied; None where it stands for nothing."""
        for kind, what in _KINDS.items():
            if any(each.name.text == name for each in below(self._tree, kind)):
                return what
        return None


_Named: TypeAlias = (
    ast.VariableDeclaration | ast.AliasDefinition | ast.ActionDeclaration | ast.ResourceDeclaration | ast.Parameter
)

_KINDS: Final[dict[type[_Named], str]] = {
    ast.VariableDeclaration: "a state variable",
    ast.AliasDefinition: "an alias of a predicate",
    ast.ActionDeclaration: "an action",
    ast.ResourceDeclaration: "a resource",
    ast.Parameter: "a parameter of copies",
}


def _fail(code: Code, message: str, help_: str) -> NoReturn:
    raise _error(code, message, help_)


def _error(code: Code, message: str, help_: str) -> UserError:
    return UserError((Diagnostic(code, message, help=help_),))
