"""Giving something another name, everywhere: what may be renamed, and how."""

from __future__ import annotations

import re

from tumato_symbolic.diagnostics import Source, Span
from tumato_symbolic.diagnostics.wording import quoted
from tumato_symbolic.editor.mentions import Index, Symbol, index
from tumato_symbolic.spec import load
from tumato_symbolic.syntax.edits import Edit, edited
from tumato_symbolic.syntax.tokens import HARD

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class CannotRenameError(Exception):
    """A name that cannot be changed to another; the message says why."""


def renamable(known: Index, line: int, column: int) -> Span:
    """The name at a line and column that may be changed. Raises `CannotRenameError`."""
    symbol = _symbol(known, line, column)
    _edits(known, symbol, symbol.name)
    return next(each.span for each in known.at(line, column))


def rename(known: Index, line: int, column: int, name: str) -> list[Edit]:
    """The edits that give what is named at a line and column another name. Raises `CannotRenameError`."""
    symbol = _symbol(known, line, column)
    if not _NAME.fullmatch(name) or name in HARD:
        raise CannotRenameError(f"{quoted(name)} is not a name")
    if name in _taken(known, symbol) and name != symbol.name:
        raise CannotRenameError(f"{quoted(name)} is in use already")
    edits = _edits(known, symbol, name)
    if not _keeps_meaning(known, symbol, symbol._replace(name=name), edits):
        raise CannotRenameError(f"{quoted(name)} means something else in some places")
    return edits


def _keeps_meaning(known: Index, old: Symbol, new: Symbol, edits: list[Edit]) -> bool:
    """Whether a name that is a word of the language, say, is read as a name wherever the old one was."""
    text = Source(known.source.name, edited(known.source, edits))
    after = index(text)
    uses = [[each.use for each in some.of_symbol.get(symbol, ())] for some, symbol in ((known, old), (after, new))]
    if old.kind == "parameter" and _others(known) != _others(after):
        return False
    return uses[0] == uses[1] and _errors(text) <= _errors(known.source)


def _others(known: Index) -> list[Symbol]:
    """What names stand for that are not parameters."""
    return [each.symbol for each in known.mentions if each.symbol.kind != "parameter"]


def _errors(source: Source) -> int:
    return sum(each.severity == "error" for each in load(source).diagnostics)


def _taken(known: Index, symbol: Symbol) -> list[str]:
    """The names that would be confused with a new name of a symbol."""
    if symbol.kind == "value":
        return known.values(symbol.of)
    return [
        each.name for each in known.of_symbol if each.kind not in ("value", "parameter") and (known.declarations(each))
    ]


def _symbol(known: Index, line: int, column: int) -> Symbol:
    symbols = {each.symbol for each in known.at(line, column)}
    if not symbols:
        raise CannotRenameError("there is no name here")
    if len(symbols) > 1:
        raise CannotRenameError("this name is made of parameters, and stands for another one in each copy")
    return next(iter(symbols))


def _edits(known: Index, symbol: Symbol, name: str) -> list[Edit]:
    """An edit at every mention; each of them has to be the name as it stands."""
    if known.parsed.diagnostics:
        raise CannotRenameError("first correct the mistakes in the syntax")
    if not known.declarations(symbol):
        raise CannotRenameError(f"{quoted(symbol.name)} is not declared here")
    lines = known.source.text.split("\n")
    spans = dict.fromkeys(each.span for each in known.of_symbol[symbol])
    for span in spans:
        if lines[span.line - 1][span.column - 1 : span.end_column - 1] != symbol.name:
            raise CannotRenameError(f"in line {span.line}, {quoted(symbol.name)} is made of parameters, or in a range")
    return [Edit(span, name) for span in spans]
